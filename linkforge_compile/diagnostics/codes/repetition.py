"""LF32xx: `for`, `when`, `defaults` and `override`."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_E, _W = Severity.ERROR, Severity.WARNING
_DATA = Location.DATA

# LF320x: `when` and `for`
CONDITION_KIND = Code("LF3201", _E, "'when' takes true or false, found {found}", _DATA)
FOR_KIND = Code("LF3202", _E, "'{name}' in 'for' takes a list or a whole number, found {found}", _DATA)
FOR_NAME_TAKEN = Code("LF3203", _E, "'{name}' means something here already, so 'for' cannot give it a value")
KEY_WITHOUT_NAME = Code(
    "LF3204", _E, "the key must mention '{name}' of its 'for', such as '{example}', to be another each time"
)
RESERVED_KEY = Code(
    "LF3206", _E, "'{name}' cannot be a name among the {owner}: the word is kept for repetition{way_out}"
)
LONG_FORM = Code("LF3207", _E, "beside 'for' and 'when' goes 'value' and nothing else here, found {found}")
COMPUTED_REPETITION = Code(
    "LF3208", _E, "'{name}' means nothing in what an expression makes; write it where the expression stands"
)

# LF321x: `defaults`
REPEATED_DEFAULT = Code("LF3211", _E, "a default is no entry and cannot have 'for'")

# LF322x: `override`
NOTHING_TO_OVERRIDE = Code("LF3221", _E, "there is no '{name}' among the {owner} to override{hint}")
NO_SUCH_POSITION = Code("LF3222", _E, "there is no item {name} in '{field}', which has {length}; the first is 0")
PATCH_OF_SEVERAL = Code(
    "LF3223", _E, "'{field}' is a list of {length}; say which item by its position, such as '{{0: …}}', or write a list"
)
POSITIONS_AND_KEYS = Code("LF3224", _E, "'{field}' is patched by positions, so '{name}' cannot stand beside them")
EMPTY_OVERRIDE = Code("LF3225", _E, "'{field}' is overridden with nothing; write what it is to be, or 'null' to delete")
SAME_AS_BEFORE = Code("LF3226", _W, "'{field}' is so already: this overrides nothing")
NOTHING_TO_DELETE = Code("LF3227", _W, "'{field}' says nothing that could be deleted")
MOUNT_IS_NO_JOINT = Code(
    "LF3265", _E, "'{name}' is the module's mount, not among its joints; write 'mount: {{{name}: …}}' to override it"
)
