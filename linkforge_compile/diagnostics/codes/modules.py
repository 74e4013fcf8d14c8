"""LF30xx: files, parameters and modules."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_E, _N = Severity.ERROR, Severity.NOTE
_DATA, _VALUE = Location.DATA, Location.VALUE

# LF300x: finding and reading files
NO_SUCH_FILE = Code("LF3001", _E, "there is no file '{path}'", _VALUE)
UNREADABLE_FILE = Code("LF3002", _E, "'{path}' cannot be read: {reason}")
NOT_A_SPEC = Code("LF3003", _E, "a module is a .robot.yaml, .urdf or .xacro file, found '{path}'{hint}", _VALUE)
UNKNOWN_PACKAGE = Code(
    "LF3005",
    _E,
    "no package named '{name}'; say where it is with {way}",
    _VALUE,
    in_xml="no package named '{name}'; say where it is with --package {name}=FOLDER",
)
USE_OF_NOWHERE = Code("LF3006", _E, "'{path}' cannot be found: {reason}", _VALUE)
NO_SPEC_BELOW = Code("LF3067", _E, "there is no spec, NAME.robot.yaml, in the folder '{path}' or below it")
PACKAGE_NOWHERE = Code(
    "LF3055",
    Severity.WARNING,
    "the folder '{path}' of package '{name}' does not exist; relative paths start at this file's folder",
)

# LF301x: modules
MODULE_WITHOUT_FILE = Code("LF3010", _E, "module '{name}' has no 'use'; write 'use: FILE.robot.yaml'")
MODULE_FIELD = Code("LF3011", _E, "'{field}' of module '{name}' takes {expected}, found {found}")
NOT_A_MODULE = Code("LF3015", _E, "module '{name}' is a map with 'use', found {found}")
MODULES_NOT_MAP = Code("LF3016", _E, "'modules' is a map of modules by name, found {found}")
SRDF_BESIDE_SPEC = Code("LF3017", _E, "'srdf' is for a URDF or a xacro; '{path}' has 'semantic' instead")
USE_CIRCLE = Code("LF3012", _E, "modules use each other in a circle: {path}")
USE_TOO_DEEP = Code("LF3013", _E, "modules are used inside modules more than {limit} deep")

# LF302x: parameters and what sets them
UNKNOWN_PARAMETER = Code("LF3020", _E, "no parameter named '{name}'")
PARAMETER_NOT_SET = Code("LF3021", _E, "{what} no default and must be set; write {remedy}")
NOT_JUDGED = Code("LF3022", _N, "nothing sets {names} here, so what depends on {pronoun} is not checked")
PARAMETER_KIND = Code("LF3023", _E, "parameter '{parameter}' takes {expected}, found {found}", _DATA)
PARAMETER_TOO_SMALL = Code("LF3024", _E, "parameter '{parameter}' must be at least {bound}, found {found}", _VALUE)
PARAMETER_TOO_LARGE = Code("LF3025", _E, "parameter '{parameter}' must be at most {bound}, found {found}", _VALUE)
PARAMETER_CHOICE = Code("LF3026", _E, "parameter '{parameter}' is one of {choices}, found '{name}'", _VALUE)
PARAMETER_PATTERN = Code("LF3027", _E, "parameter '{parameter}' must match '{pattern}', found {found}", _VALUE)
NOT_AN_ASSIGNMENT = Code("LF3028", _E, "a parameter is set by NAME=VALUE, found '{text}'")
SET_TWICE = Code("LF3029", _E, "parameter '{name}' is set twice")

# LF303x: declarations of parameters
PARAMETER_WITHOUT_TYPE = Code("LF3030", _E, "parameter '{name}' has neither a type nor a default; write 'type: length'")
UNFIT_CONSTRAINT = Code("LF3031", _E, "'{constraint}' does not apply to a parameter of type {type}")
BAD_PATTERN = Code("LF3032", _E, "'{pattern}' cannot be a pattern: {reason}")
CROSSED_BOUNDS = Code(
    "LF3033", _E, "parameter '{parameter}' can have no value: 'minimum' is {minimum}, 'maximum' {maximum}"
)
NO_CHOICE = Code("LF3034", _E, "parameter '{parameter}' can have no value: 'enum' is empty; list what it may be")

# LF304x: names of parameters and variables
INVALID_VARIABLE_NAME = Code(
    "LF3040", _E, "'{name}' cannot name a {kind}; use letters, digits and '_', not beginning with a digit"
)
RESERVED_NAME = Code("LF3041", _E, "'{name}' is reserved in expressions and cannot name a {kind}; choose another name")
NAME_OF_TWO_KINDS = Code("LF3042", _E, "'{name}' is both {kinds}")

# LF305x: what expressions make of the tree
COMPUTED_KEY = Code("LF3050", _E, "a key must be text, found {found}")
SAME_KEY = Code("LF3051", _E, "the expressions give the key '{name}' twice")
TREE_TOO_LARGE = Code("LF3052", _E, "the expressions give more than {limit}")
TEXT_NOT_NUMBER = Code("LF3053", _E, "text with an expression inside is never a number, found '{text}'; {remedy}")
