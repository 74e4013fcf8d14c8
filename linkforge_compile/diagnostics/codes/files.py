"""LF306x to LF309x: included files, data, variants, and what is told about the file that an expression stands in."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E, _W = Severity.ERROR, Severity.WARNING

# LF306x: include
INCLUDE_NOT_PLAIN = Code("LF3060", _E, "an include is a path of a file, {reason}; found '{path}'")
ENTRY_IN_TWO_FILES = Code("LF3061", _E, "{entry} is in two files that 'include' joins; keep it in one of them")
SAID_BY_MAIN_FILE = Code(
    "LF3062", _E, "an included file must not set '{key}'; set it in the file that includes this one"
)
INCLUDE_CIRCLE = Code("LF3063", _E, "files include each other in a circle: {path}")
INCLUDED_TWICE = Code("LF3064", _E, "'{path}' is included already")
INCLUDE_TOO_DEEP = Code("LF3065", _E, "files are included inside files more than {limit} deep")
TOO_MANY_INCLUDES = Code("LF3066", _E, "more than {limit} files are included")

# LF307x: data
DATA_NOT_PATH = Code("LF3070", _E, "'{name}' of 'data' takes the path of a YAML file, found {found}")
TAG_NOT_NUMBER = Code("LF3071", _E, "'{tag}' must be followed by a number, found '{text}'")

# LF308x: variants
UNKNOWN_VARIANT = Code("LF3080", _E, "{spec} has no variant named '{name}'{hint}")

# LF309x: what depends on how the file is used
PREFIX_TWICE = Code("LF3090", _E, "{place} gets the prefix automatically; leave $(prefix) out")
NAME_OUTSIDE_TEXT = Code("LF3091", _E, "{function} is allowed only in free parts and 'extra'; elsewhere write the name")
PATH_OF_THIS_MACHINE = Code("LF3092", _W, "path() ties the output to this machine; pass it in by 'with' instead")
FILE_OUTSIDE_PACKAGE = Code(
    "LF3093",
    _W,
    "'{path}' lies outside the module's package, so its absolute path ties the output to this machine; "
    "write 'package://NAME/PATH'",
)
