"""LF30xx and LF32xx to LF34xx: files, modules, parameters, `for`, `when`, `defaults`, `override` and limits."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.source.provenance import Location

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE
_DATA, _VALUE = Location.DATA, Location.VALUE

# LF300x: finding and reading files
NO_SUCH_FILE = Code("LF3001", _E, "there is no file '{path}'", _VALUE)
UNREADABLE_FILE = Code("LF3002", _E, "'{path}' cannot be read: {reason}")
NOT_A_SPEC = Code("LF3003", _E, "a module is a .robot.yaml, .urdf or .xacro file, found '{path}'{hint}", _VALUE)
UNKNOWN_PACKAGE = Code(
    "LF3005",
    _E,
    "no package named '{name}'; specify its folder with {way}",
    _VALUE,
    in_xml="no package named '{name}'; specify its folder with --package {name}=FOLDER",
)
USE_OF_NOWHERE = Code("LF3006", _E, "'{path}' cannot be found: {reason}", _VALUE)
NO_SPEC_BELOW = Code("LF3067", _E, "there is no spec, NAME.robot.yaml, in the folder '{path}' or below it")
PACKAGE_NOWHERE = Code(
    "LF3055", _W, "the folder '{path}' of package '{name}' does not exist; relative paths start at this file's folder"
)

# LF301x: modules
MODULE_WITHOUT_FILE = Code("LF3010", _E, "module '{name}' has no 'use'; write one, such as 'use: FILE.robot.yaml'")
MODULE_FIELD = Code("LF3011", _E, "'{field}' of module '{name}' takes {expected}, found {found}")
NOT_A_MODULE = Code("LF3015", _E, "module '{name}' is a map with 'use', found {found}")
MODULES_NOT_MAP = Code("LF3016", _E, "'modules' is a map of modules by name, found {found}")
SRDF_BESIDE_SPEC = Code("LF3017", _E, "'srdf' is for a URDF or a xacro; '{path}' has 'semantic' instead")
MACRO_OF_NO_XACRO = Code("LF3018", _E, "'macro' applies only to a xacro file; '{path}' is not one")
USE_CYCLE = Code("LF3012", _E, "modules use each other in a cycle: {path}")
USE_TOO_DEEP = Code("LF3013", _E, "modules are used inside modules more than {limit} deep")

# LF302x: parameters and what sets them
UNKNOWN_PARAMETER = Code("LF3020", _E, "no parameter named '{name}'")
PARAMETER_NOT_SET = Code("LF3021", _E, "{what} no default and must be set; write {remedy}")
NOT_CHECKED = Code("LF3022", _N, "nothing sets {names} here, so parts that depend on {pronoun} are not checked")
PARAMETER_KIND = Code("LF3023", _E, "parameter '{parameter}' takes {expected}, found {found}", _DATA)
PARAMETER_TOO_SMALL = Code("LF3024", _E, "parameter '{parameter}' must be at least {bound}, found {found}", _VALUE)
PARAMETER_TOO_LARGE = Code("LF3025", _E, "parameter '{parameter}' must be at most {bound}, found {found}", _VALUE)
PARAMETER_CHOICE = Code("LF3026", _E, "parameter '{parameter}' must be one of {choices}, found '{name}'", _VALUE)
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
NO_CHOICE = Code("LF3034", _E, "parameter '{parameter}' can have no value: 'enum' is empty; list the allowed values")

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

# LF306x: include
INCLUDE_NOT_PLAIN = Code("LF3060", _E, "an include is a path of a file, {reason}; found '{path}'")
ENTRY_IN_TWO_FILES = Code("LF3061", _E, "{entry} is in two files that are joined by 'include'; keep it in one of them")
SET_BY_MAIN_FILE = Code(
    "LF3062", _E, "an included file must not set '{key}'; set it in the file that includes this one"
)
INCLUDE_CYCLE = Code("LF3063", _E, "files include each other in a cycle: {path}")
INCLUDED_TWICE = Code("LF3064", _E, "'{path}' is already included")
INCLUDE_TOO_DEEP = Code("LF3065", _E, "files are included inside files more than {limit} deep")
TOO_MANY_INCLUDES = Code("LF3066", _E, "more than {limit} files are included")

# LF307x: data
DATA_NOT_PATH = Code("LF3070", _E, "'{name}' of 'data' takes the path of a YAML file, found {found}")
TAG_NOT_NUMBER = Code("LF3071", _E, "'{tag}' must be followed by a number, found '{text}'")

# LF308x: variants
UNKNOWN_VARIANT = Code("LF3080", _E, "{spec} has no variant named '{name}'{hint}")
VARIANTS_DISAGREE = Code(
    "LF3081", _W, "parameter '{name}' is set by variant '{by}', which replaces what variant '{other}' sets"
)

# LF309x: what depends on how the file is used
PREFIX_TWICE = Code("LF3090", _E, "{place} gets the prefix automatically; remove $(prefix)")
NAME_OUTSIDE_TEXT = Code("LF3091", _E, "{function} is allowed only in free parts and 'extra'; elsewhere write the name")
PATH_OF_THIS_MACHINE = Code(
    "LF3092", _W, "path() ties the output to this machine; write 'package://NAME/PATH', or pass it with 'with'"
)
FILE_OUTSIDE_PACKAGE = Code(
    "LF3093",
    _W,
    "'{path}' is outside the module's package, so its absolute path ties the output to this machine; "
    "write 'package://NAME/PATH'",
)

# LF320x: `when` and `for`
CONDITION_KIND = Code("LF3201", _E, "'when' takes true or false, found {found}", _DATA)
FOR_KIND = Code("LF3202", _E, "'{name}' in 'for' takes a list or a whole number, found {found}", _DATA)
FOR_NAME_TAKEN = Code("LF3203", _E, "'{name}' is already defined here; choose another name for 'for'")
KEY_WITHOUT_NAME = Code(
    "LF3204",
    _E,
    "the key must mention '{name}' of its 'for', such as '{example}', so that each copy gets its own name",
    fix=Replacement("{key}", "{example}", is_whole=True),
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
CHANGE_OF_DELETED = Code(
    "LF3228", _W, "joint '{name}' is deleted with link '{link}', so this change has no effect{way_out}"
)
DELETED_POSE = Code(
    "LF3229",
    _W,
    "this also deletes joint '{name}' and its pose; to keep the pose, write it as 'origin' where the module is used; "
    "write 'joints: {{{name}: null}}' as well to delete it without this warning",
)
MOUNT_IS_NO_JOINT = Code(
    "LF3265", _E, "'{name}' is the module's mount, not among its joints; write 'mount: {{{name}: …}}' to override it"
)

# LF33xx: the limits that all files of one compile share
BEYOND_LIMIT = Code(
    "LF3301",
    _E,
    "the robot takes more than {most} {counted}; {way_out} (LINKFORGE_LIMITS=10 in the environment allows ten times "
    "as much)",
    in_xml="a spec of this robot takes more than {most} {counted}; for one of your own, LINKFORGE_LIMITS=10 in the "
    "environment allows ten times as much",
    ends_report=True,
)
TOO_MANY_ERRORS = Code("LF3302", _E, "too many {what}; stopping here", ends_report=True)
MORE_WARNINGS = Code("LF3303", _W, "{count} more warnings and notes are not shown", ends_report=True)
VARIANTS_BEYOND_LIMIT = Code(
    "LF3304",
    _E,
    "the spec with all its variants takes more than {most} {counted}; check them one at a time with "
    "'--variant' (LINKFORGE_LIMITS=10 in the environment allows ten times as much)",
    ends_report=True,
)

# LF34xx: which files a spec may make the compiler read
OUTSIDE_ROOTS = Code(
    "LF3401",
    _E,
    "'{path}' is outside of the folders that may be read; add its folder with --package "
    "{name}=FOLDER, or allow all with --allow-outside",
    _VALUE,
)
UNSEEN_MESHES = Code(
    "LF3402", _N, "the meshes of {links} are outside of the folders that may be read and were not checked"
)
UNSOUGHT_MESHES = Code(
    "LF3403", _N, "the meshes of {links} are in {packages} that were not searched for: too many others were not found"
)
