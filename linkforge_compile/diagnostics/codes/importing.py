"""LF8xxx: what an imported file lacks, and what the import changes or keeps as raw XML."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE

# LF800x: XML
MALFORMED_XML = Code("LF8001", _E, "this is not XML: {problem}")
DOCUMENT_TYPE = Code(
    "LF8002", _E, "a document type is not allowed, because its entities can read other files; delete it"
)
TOO_DEEP = Code("LF8003", _E, "elements are nested more than {limit} deep")
TOO_MANY_ELEMENTS = Code("LF8004", _E, "the file has more than {limit} elements and comments")
TOO_MUCH_INSIDE = Code("LF8098", _E, "{owner} has more than {limit} elements, comments and texts in it")
NO_CHARACTER_OF_A_SPEC = Code("LF8005", _E, "a spec cannot contain the character {character}")

# LF801x: URDF
NOT_A_ROBOT = Code("LF8011", _E, "expected <robot>, found <{tag}>")
ROBOT_WITHOUT_NAME = Code("LF8012", _E, "the robot has no name; write <robot name='...'>")
STILL_XACRO = Code("LF8013", _E, "<{tag}> is xacro syntax, which is expanded only in a file named '{name}'")

LEFT_BY_XACRO = Code(
    "LF8023", _W, "<{tag}> is left over from a xacro, and kept as raw XML; write what it stands for, or delete it"
)

# What no URDF reader takes
NO_NUMBERS = Code("LF8060", _E, "'{name}' of <{tag}> takes {expected}, found '{text}'{way_out}")
LACKS_PART = Code("LF8065", _E, "this <{tag}> has no {what}, so URDF readers refuse it")
NAME_IS_TAKEN = Code("LF8160", _E, "there is already a <{tag}> named '{name}'; give each its own name")
NO_TYPE_OF_JOINT = Code("LF8161", _E, "there is no joint type named '{name}'")

NOTHING_EXPANDED = Code("LF8066", _E, "the xacro expands to nothing; pass the file that creates the robot")

# LF802x: what comes in, but not as its own kind
KEPT_RAW = Code("LF8021", _W, "<{tag}> is kept as raw XML: {reason}")

MATERIAL_REPEATED = Code(
    "LF8022", _W, "material '{name}' is declared again with the same content; the spec has it once"
)

FOUND_PATH_OF_THIS_MACHINE = Code(
    "LF8025",
    _W,
    "$(find {package}) becomes a path of this machine, {reason}",
)

ENDS_IN_A_BLANK = Code(
    "LF8024", _W, "'{name}' of <{tag}> ends in white space, so urdfdom {effect}; delete the white space"
)

ENDS_KEPT_RAW = Code(
    "LF8090", _W, "lower must not be above upper, found {lower} and {upper}; they are kept as raw attributes"
)

# LF803x: xacro
XACRO_NOT_INSTALLED = Code(
    "LF8031", _E, "'{path}' needs the xacro package, which runs its expressions: pip install 'linkforge-compile[xacro]'"
)
XACRO_FAILED = Code("LF8032", _E, "xacro fails here: {problem}")
XACRO_ARGUMENT = Code("LF8033", _E, "'{name}' of a xacro file takes text, a number, true or false, or a list of them")
XACRO_FORBIDDEN = Code("LF8035", _E, "'{path}' is not expanded: the environment sets {variable}")
XACRO_WARNS = Code("LF8034", _W, "xacro reports: {text}")

MACRO_BLOCK = Code("LF8036", _E, "block '{name}' of a macro takes raw XML, {what} such as '<box …/>', found '{found}'")
MACRO_SETS_FIELD = Code(
    "LF8037",
    _E,
    "parameter '{parameter}' of the macro is '{field}' of module '{name}', which is set; remove one of them",
)
MACRO_PLACES_ITSELF = Code(
    "LF8038",
    _E,
    "macro '{macro}' sets its own position, so 'origin' has no effect; remove it, and set the parameters of the "
    "macro in 'with'",
)
MACRO_ADDS_TO_PARENT = Code(
    "LF8046",
    _E,
    "macro '{macro}' adds '{suffix}' to its '{parameter}', so 'parent' is a link whose name ends in that, "
    "found '{found}'",
)
MACRO_WITHOUT_LINKS = Code(
    "LF8047", _E, "macro '{macro}' creates no link, so it cannot be a module; use a macro that calls it"
)
MACROS_ONLY = Code(
    "LF8039", _E, "'{path}' only declares macros; use one of them in a spec: {{use: {path}, macro: {macro}}}"
)

XACRO_ARGUMENT_TOO_EARLY = Code("LF8062", _E, "xacro uses '{name}' here, before it reads its default; write '{remedy}'")
XACRO_UNKNOWN_NAME = Code("LF8063", _E, "xacro has no {kind} named '{name}' here")
XACRO_FILE_MISSING = Code("LF8064", _E, "xacro needs the file '{path}', which does not exist")
ARGUMENTS_NOT_LISTED = Code("LF8061", _N, "the arguments that '{path}' declares are not listed: {reason}")

# LF804x: the migration of a xacro
MIGRATION_DIFFERS = Code("LF8040", _E, "with {arguments}, the specs give a different robot: {text}")
MACRO_IN_PLACE = Code(
    "LF8041", _N, "macro '{name}' cannot be a module: {reason}; its content is written where it is called"
)
ARGUMENT_PINNED = Code(
    "LF8042",
    _W,
    "'{name}' is '{value}' in the specs, because something that depends on it cannot be translated for all its values; "
    "migrate again for another one",
)
XACRO_KEPT = Code("LF8043", _W, "this xacro is used unchanged, because this cannot be translated: {reason}")
MACRO_KEPT = Code(
    "LF8045", _W, "macro '{name}' remains a macro of its xacro, because this cannot be translated: {reason}"
)
MIGRATION_UNPROVED = Code(
    "LF8044", _W, "with {arguments}, nothing is compared, because xacro's robot is faulty: {reason}"
)

ELEMENT_LEFT_OUT = Code("LF8048", _N, "<{tag}> is omitted: URDF readers ignore it in {place}")

SPEC_NEEDS_OUTSIDE = Code("LF8049", _W, "'linkforge compile {spec}' will fail here: {reason}")
PARAMETER_GONE = Code(
    "LF8050",
    _E,
    "'{spec}' has no parameter '{name}', which is the argument '{argument}' of the xacro; write it, or migrate again",
)
ENVIRONMENT_READ = Code(
    "LF8052",
    _W,
    "the environment variable {name} is '{value}' in the specs, which do not read the environment; write an "
    "<xacro:arg> in its place to have a parameter",
)
MIGRATION_TOO_LONG = Code("LF8051", _E, "{what} was not finished in {seconds} s; --seconds gives it more time")

# LF813x: which file goes where
URDF_FOR_SRDF = Code(
    "LF8132", _E, "this is a URDF, not an SRDF, because it has a <{tag}> of its own; pass the robot's SRDF"
)
SRDF_FOR_URDF = Code(
    "LF8145",
    _E,
    "this is an SRDF, not a URDF, because it has a <{tag}> and no <link>; give the robot's URDF, and "
    "this file as its 'srdf', in a 'use' or to 'linkforge import'",
)
SRDF_OF_ANOTHER = Code(
    "LF8154",
    _W,
    "'{robot}' has none of the {count} links and joints in this SRDF, such as '{name}', so all of it "
    "is kept as raw XML; give the SRDF of this robot",
)
SRDF_OF_MORE = Code(
    "LF8155",
    _W,
    "'{robot}' has no {names}, so the elements that name them in this SRDF are kept as raw XML; read it with the "
    "URDF of the "
    "whole robot, such as an arm with its gripper, or remove them from it",
)
MESH_BESIDE_THE_URDF = Code(
    "LF8130",
    _W,
    "mesh path '{path}' is relative to the URDF and cannot be found from '{folder}', the spec's folder; "
    "write 'package://NAME/PATH'{elsewhere}",
)

# LF813x: additional information, without a loss
TAGS_GROUPED = Code(
    "LF8026",
    _N,
    "the elements of <{tag}> are grouped by tag in the spec; here, other elements stand between <{repeated}>",
)

VERSION_FOR_CAPSULE = Code(
    "LF8131",
    _N,
    '<capsule> came with URDF 1.1, and this file states no version, so what is compiled says version="1.1"; '
    'write <robot version="1.1" ...> here',
)

# LF81xx: losses
TEXT_LEFT_OUT = Code("LF8101", _W, "text is not allowed in <{tag}>; '{text}' is omitted")
INSTRUCTION_LEFT_OUT = Code("LF8102", _W, "the processing instruction '{target}' is omitted")
OTHER_ROBOT = Code(
    "LF8103",
    _W,
    "this SRDF names the robot '{name}', the URDF '{robot}', and a spec has one name; it becomes '{robot}'",
)
NEGATIVE_LIMIT = Code(
    "LF8104",
    _W,
    "{name} must be at least 0, found {value}; the spec has 0, so write the limit of the joint",
    subject="joint",
    grouped_by=("name", "value"),
)
NAME_REPLACED = Code(
    "LF8105",
    _W,
    "'{name}' has characters that names in TF, topics and specs cannot have, and becomes '{new}'; rename it in the "
    "programs that use it",
)
DOES_NOT_COME_OUT = Code("LF8190", _W, "the spec does not reproduce {what}")
BECOMES_OTHER = Code("LF8191", _W, "{what} is '{was}' here, but the spec compiles to '{now}'")
SHAPES_REORDERED = Code(
    "LF8140",
    _W,
    "visuals and collisions of link '{link}' have another order in the compiled output, so "
    "MuJoCo shows this one in the color of another visual",
)
COLORS_REORDERED = Code(
    "LF8141",
    _W,
    "MuJoCo shows this in another of the colors named '{name}' in the compiled output, because "
    "it uses the first one in a file",
)
COMES_IN_ADDITION = Code("LF8192", _W, "the spec adds {what}, which is not in this file")

LOSSES = frozenset(
    {
        TEXT_LEFT_OUT,
        INSTRUCTION_LEFT_OUT,
        OTHER_ROBOT,
        NEGATIVE_LIMIT,
        NAME_REPLACED,
        DOES_NOT_COME_OUT,
        BECOMES_OTHER,
        COMES_IN_ADDITION,
        SHAPES_REORDERED,
        COLORS_REORDERED,
    }
)
"""What `--strict` makes a failure of."""
