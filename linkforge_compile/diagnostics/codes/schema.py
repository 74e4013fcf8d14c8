"""LF2xxx: the tree does not have the shape that the schema of the language describes."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_E = Severity.ERROR
_DATA, _VALUE = Location.DATA, Location.VALUE

MISSING_VERSION = Code(
    "LF2001", _E, "write 'linkforge: 1' first: it states which version of the language the file uses"
)
OTHER_VERSION = Code("LF2002", _E, "'linkforge' takes 1, the version of the language, found {found}")
MISSING_NAME = Code(
    "LF2003", _E, "a robot needs a 'name'; a file for 'include' is checked with the file that includes it"
)
UNKNOWN_KEY = Code("LF2101", _E, "'{name}' is not a key of {owner}{hint}", _VALUE)
SECTION_LINE_LOST = Code(
    "LF2155",
    _E,
    "'{name}' is in '{around}' but looks like an entry of '{section}'; write the line '{section}:' above it",
)
SECTION_LINE_INDENTED = Code(
    "LF2156", _E, "'{name}' is inside '{around}', with all below it; indent it like '{around}'"
)
WRONG_KIND = Code("LF2201", _E, "{field} takes {expected}, found {found}", _DATA)
UNKNOWN_WORD = Code("LF2202", _E, "{field} takes {expected}, found '{name}'{hint}", _VALUE)
WRONG_LENGTH = Code("LF2203", _E, "{field} takes {expected}, found {found}", _DATA)
