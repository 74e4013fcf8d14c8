"""LF32xx: `for`, `when`, `defaults` and `override`."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_E, _W = Severity.ERROR, Severity.WARNING
_DATA = Location.DATA

# LF320x: `when` and `for`
CONDITION_KIND = Code("LF3201", _E, "'when' takes true or false, found {found}", _DATA)
FOR_KIND = Code("LF3202", _E, "'{name}' in 'for' takes a list or a whole number, found {found}", _DATA)
FOR_NAME_TAKEN = Code("LF3203", _E, "'{name}' is already defined here; choose another name for 'for'")
KEY_WITHOUT_NAME = Code(
    "LF3204", _E, "the key must contain '{name}' of its 'for', such as '{example}', to be unique in each round"
)
RESERVED_KEY = Code("LF3206", _E, "'{name}' is reserved for repetition and cannot be a name among the {owner}{way_out}")
LONG_FORM = Code("LF3207", _E, "with 'for' or 'when', only 'value' is allowed here, found {found}")
COMPUTED_REPETITION = Code(
    "LF3208", _E, "'{name}' has no effect in the value of an expression; write it where the expression is"
)

# LF321x: `defaults`
REPEATED_DEFAULT = Code("LF3211", _E, "a default cannot have 'for'; write it in the entries")

# LF322x: `override`
NOTHING_TO_OVERRIDE = Code("LF3221", _E, "there is no '{name}' among the {owner} to override{hint}")
NO_SUCH_POSITION = Code("LF3222", _E, "there is no item {name} in '{field}', which has {length}; the first is 0")
PATCH_OF_SEVERAL = Code(
    "LF3223", _E, "'{field}' is a list of {length}; name an item by its position, such as '{{0: …}}', or write a list"
)
POSITIONS_AND_KEYS = Code("LF3224", _E, "'{field}' is overridden by position, and '{name}' is not a position")
EMPTY_OVERRIDE = Code("LF3225", _E, "the override of '{field}' is empty; write a value, or 'null' to delete it")
SAME_AS_BEFORE = Code("LF3226", _W, "'{field}' already has this value, so the override changes nothing")
NOTHING_TO_DELETE = Code("LF3227", _W, "'{field}' is not set, so there is nothing to delete")
MOUNT_IS_NO_JOINT = Code(
    "LF3265", _E, "'{name}' is the module's mount, not among its joints; write 'mount: {{{name}: …}}' to override it"
)
