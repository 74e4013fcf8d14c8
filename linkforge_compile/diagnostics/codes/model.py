"""LF5xxx: values that the model refuses."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.source.provenance import Location

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE
_DATA, _VALUE = Location.DATA, Location.VALUE

# LF50xx: fields of any object
WRONG_KIND = Code("LF5001", _E, "{field} takes {expected}, found {found}", _DATA)
WRONG_DIMENSION = Code("LF5002", _E, "{field} takes {expected}, found {found}, which is {other}", _DATA)
UNKNOWN_UNIT = Code(
    "LF5003",
    _E,
    "{field} takes {expected}; there is no unit '{name}'{hint}",
    _DATA,
    fix=Replacement("{written}", "{instead}", is_safe=True, is_whole=True),
)
NOT_FINITE = Code("LF5004", _E, "{field} must be a finite number, found {found}", _VALUE)
MISSING_FIELD = Code(
    "LF5005",
    _E,
    "{owner} has no '{field}'; write one, such as '{key}: {example}'",
    _DATA,
    in_xml="{owner} needs {element}",
)
OUT_OF_RANGE = Code(
    "LF5006",
    _E,
    "{field} must be {bound}, found {found}",
    _VALUE,
    fix=Replacement("{written}", "{instead}", is_whole=True),
)
UNKNOWN_CHOICE = Code("LF5007", _E, "{field} is one of {choices}, found '{name}'", _VALUE)
WRONG_COUNT = Code("LF5008", _E, "{field} takes {expected}, found {count}", _DATA)
WIDE_ANGLE = Code(
    "LF5009",
    _W,
    "{field} is {found} radians, more than a whole turn; write '{found} deg' if you mean degrees",
    _VALUE,
    in_xml="{field} is {found} radians, {turns} turns; write '{of_degrees}' if you mean degrees",
    fix=Replacement("{found}", "{found} deg", is_whole=True),
)
LONG_LENGTH = Code(
    "LF5010",
    _W,
    "{field} is {found} metres; write '{found} mm' if you mean millimetres",
    _VALUE,
    in_xml="{field} is {found} metres; write '{thousandth}' if you mean millimetres",
    fix=Replacement("{found}", "{found} mm", is_whole=True),
)
REFUSED = Code("LF5011", _E, "{owner}: {reason}", _VALUE)

# LF51xx: shapes, materials and inertials
NO_GEOMETRY = Code("LF5101", _E, "{owner} has no shape; write one of box, cylinder, sphere, capsule or mesh")
SEVERAL_GEOMETRIES = Code("LF5102", _E, "{owner} has two shapes, '{first}' and '{second}'; write a list of two instead")
NO_MESH_FILE = Code("LF5103", _E, "{owner} names no mesh file")
COPY_OF_NOTHING = Code("LF5104", _E, "{owner} has no visual that its collision could copy")
EMPTY_MATERIAL = Code("LF5105", _E, "{owner} has neither 'color' nor 'texture'{hint}")
NO_MASS = Code("LF5106", _E, "{owner} needs {choices}")
MASS_AND_DENSITY = Code("LF5107", _E, "{owner} has 'mass' and 'density'; write one of them")
DENSITY_WITH_INERTIA = Code("LF5108", _E, "{owner} has 'inertia', which goes with 'mass', not with 'density'")
ORIGIN_WITHOUT_INERTIA = Code(
    "LF5109", _E, "{owner} has an 'origin' without 'inertia'; specify both, or omit both to have them computed"
)
SHAPE_ORDER_COUNT = Code(
    "LF5140",
    _E,
    "shape_order of {owner} must list each shape once, {expected}, found {found}; or write 'pairs', "
    "for any number of them",
)
INERTIA_OF_NOTHING = Code("LF5111", _E, "{owner} cannot be computed without a collision or visual; specify 'inertia'")

# LF52xx: joints
NOT_OF_THIS_TYPE = Code("LF5201", _E, "{owner} is {type} and cannot have '{field}'")
UNKNOWN_AXIS = Code("LF5202", _E, "axis is one of x, y, z, -x, -y, -z, or three numbers, found {found}", _VALUE)
ZERO_AXIS = Code("LF5203", _E, "axis has no direction: all three numbers are 0", _VALUE)
LIMITS_CROSSED = Code("LF5204", _E, "lower must not be above upper, found {lower} and {upper}", _VALUE)
JOINT_TO_ITSELF = Code("LF5205", _E, "{owner} joins link '{link}' to itself")

# LF53xx: modules and the semantic part
JOINT_WITHOUT_PARENT = Code(
    "LF5301", _E, "{owner} has '{field}' but no 'parent'; name its parent link, or remove '{field}'"
)
VIRTUAL_JOINT_LEFT_OUT = Code(
    "LF5302",
    _N,
    "virtual joint '{joint}' is omitted{others}: the file that uses this one attaches '{link}' to another link",
)
EMPTY_GROUP = Code("LF5303", _E, "planning group '{group}' has no chain, links, joints or subgroups")
PAIR_WITH_ITSELF = Code("LF5304", _E, "a collision pair takes two links, found '{link}' twice")
UNKNOWN_STATE = Code("LF5305", _E, "group '{group}' has no state '{name}'; it has {states}")
STATE_CYCLE = Code("LF5306", _E, "group states take their values from each other in a cycle: {path}")
STATE_VALUE_TWICE = Code("LF5307", _E, "joint '{joint}' has two values in state '{state}' of group '{group}'")
NOT_OF_MANAGER = Code("LF5308", _E, "'controller_manager' can only have `parameters`; remove '{field}'")

MOUNT_SAYS_ENDS = Code(
    "LF5321", _E, "{owner} is a mount and must not set '{field}'; the file that uses this one sets it"
)
MOUNT_NOT_AT_ROOT = Code(
    "LF5322", _E, "the child of mount '{joint}' is '{link}', but the root of this file is '{root}'"
)
TWO_MOUNTS = Code("LF5323", _E, "a robot has only one mount, and '{joint}' is a second one after '{first}'; remove one")
MOUNT_AND_JOINT = Code(
    "LF5324",
    _E,
    "{owner} has its own mount '{joint}'; remove 'joint', or write 'override: {{{section}: {{{joint}: …}}}}'",
)

# LF54xx: the tree of links
NO_LINKS = Code("LF5401", _E, "robot '{robot}' has no links; a robot has at least one")
SECOND_PARENT = Code("LF5402", _E, "link '{link}' is the child of two joints, '{first}' and '{joint}'; {way_out}")
LINK_CYCLE = Code("LF5403", _E, "links are each other's parents in a cycle: {path}")
SEVERAL_ROOTS = Code(
    "LF5404",
    _E,
    "the robot has {count} roots, {roots}; connect them, for example with a fixed joint from '{parent}' to '{child}'",
)

# LF55xx: how far joints go, and joints that follow others
MIMIC_CYCLE = Code("LF5501", _E, "joints mimic each other in a cycle: {path}")
MIMIC_FREEDOM = Code(
    "LF5502",
    _W,
    "{type} joint '{joint}' mimics {led} joint '{leader}', but both must have one axis",
    subject="joint",
    grouped_by=("type", "led"),
)
NO_RANGE = Code(
    "LF5503",
    _W,
    "joint '{joint}' cannot move: its limits do not set {missing}, which URDF reads as 0",
    subject="joint",
    grouped_by=("missing",),
)
EMPTY_RANGE = Code("LF5504", _W, "joint '{joint}' cannot move: its lower and upper limit are both {found}")
RANGE_OF_ENDLESS_JOINT = Code(
    "LF5505",
    _W,
    "joint '{joint}' is continuous and turns beyond its {limits}; make it revolute, or remove them",
    subject="joint",
    grouped_by=("limits",),
)
POWERLESS_JOINT = Code(
    "LF5506",
    _W,
    "joint '{joint}' cannot be driven: its limit of {fields} is 0",
    subject="joint",
    grouped_by=("fields",),
)
SOFT_LIMITS_CROSSED = Code(
    "LF5507", _W, "soft limits of joint '{joint}' are reversed, from {lower} to {upper}, so it cannot move"
)
IDLE_SOFT_LIMIT = Code(
    "LF5508", _W, "joint '{joint}' stops at its {side} limit {hard}, before soft_{side}_limit {soft}"
)
FAST_JOINT = Code(
    "LF5585",
    _N,
    "joint '{joint}' has a velocity limit of {found} {si}{also}; write '{found} {unit}' if you mean {units}",
    in_xml="joint '{joint}' has a velocity limit of {found} {si}{also}; write '{expected}' if you mean {units}",
    fix=Replacement("{found}", "{found} {unit}", is_whole=True),
)
MIMIC_STANDS_STILL = Code("LF5509", _W, "joint '{joint}' mimics '{leader}' with a multiplier of 0, so it stands still")
MIMIC_OUTSIDE_LIMITS = Code("LF5575", _W, "joint '{joint}' goes {range}, but its leader '{leader}' drives it {found}")

# LF56xx: groups, states and end effectors
GROUP_CYCLE = Code("LF5601", _E, "planning groups contain each other in a cycle: {path}")
CHAIN_UPWARD = Code(
    "LF5602", _E, "no chain leads from '{base}' down to '{tip}', because '{base}' is below '{tip}'; swap them"
)
CHAIN_ACROSS = Code("LF5603", _W, "'{tip}' is not below '{base}'; MoveIt goes up to '{meeting}' and down again")
STATE_OUTSIDE_GROUP = Code("LF5604", _W, "joint '{joint}' is not in group '{group}', so state '{state}' cannot set it")
STATE_VALUE_COUNT = Code("LF5605", _W, "state of {type} joint '{joint}' takes {expected}, found {found}")
STATE_OUTSIDE_LIMITS = Code("LF5606", _W, "joint '{joint}' goes {range}, found {found}")
OWN_PARENT_GROUP = Code("LF5607", _W, "group '{group}' of this end effector cannot be its own parent group")
PARENT_LINK_OUTSIDE_GROUP = Code("LF5608", _W, "parent link '{link}' is not in parent group '{group}'")
VIRTUAL_JOINT_NOT_AT_ROOT = Code(
    "LF5609", _W, "MoveIt skips a virtual joint to '{link}', which is not the root '{root}'"
)
PAIR_TWICE = Code("LF5610", _W, "the pair of '{link1}' and '{link2}' is listed twice")
PASSIVE_COMMANDED = Code("LF5611", _W, "passive joint '{joint}' is commanded by ros2_control '{control}'")
PAIR_BOTH_WAYS = Code(
    "LF5612", _W, "the pair of '{link1}' and '{link2}' is also disabled, which MoveIt keeps; remove one"
)
STATE_INCOMPLETE = Code("LF5613", _N, "state '{state}' of group '{group}' does not place {joints}")
STATE_AGAINST_MIMIC = Code(
    "LF5614", _W, "joint '{joint}' mimics '{leader}', which puts it at {expected} in this state, found {found}"
)
VIRTUAL_NAME_TAKEN = Code(
    "LF5615", _W, "virtual joint '{name}' has the name of another joint, and MoveIt confuses the two; rename it"
)
NO_ARM = Code("LF5616", _N, "no planning group contains parent link '{link}', so MoveIt finds no arm for it")
GROUP_WITHOUT_JOINT = Code("LF5617", _W, "planning group '{group}' has no joint, so MoveIt ignores it")
ENABLED_ANYWAY = Code(
    "LF5618",
    _N,
    "the pair of '{link1}' and '{link2}' is checked anyway: neither is in 'no_default_collision_links'",
    in_xml="the pair of '{link1}' and '{link2}' is checked anyway: neither has a <disable_default_collisions>",
)
STATE_TAKES_OTHERS_ALONG = Code(
    "LF5680", _W, "state '{state}' takes {joints} from another group, but '{group}' does not contain {them}"
)

# LF57xx: sensors, hardware, simulators and raw XML
ATTRIBUTE_OF_OWNER = Code(
    "LF5701", _E, "'{name}' is an attribute of the element around it; those of {owner} go into 'extra_attributes'"
)
LIST_IN_LIST = Code("LF5702", _E, "a list repeats the tag '{field}', so it cannot contain another list")
TAG_TWICE = Code("LF5703", _E, "Gazebo's tag '{tag}' of {owner} is set twice; remove one, in an override with 'null'")
TAG_OF_TWO_BLOCKS = Code(
    "LF5780",
    _W,
    "Gazebo's tag '{tag}' of '{owner}' is {found} here, {first} in another block; Gazebo uses the last one",
)
UNPREFIXED_NAME = Code(
    "LF5704",
    _W,
    "'{name}' is a {kind} of this file and gets the prefix, but not here; {remedy}",
    fix=Replacement("{name}", "$({kind}('{name}'))"),
    subject="name",
    grouped_by=("kind",),
)
ABSOLUTE_TOPIC = Code(
    "LF5705", _W, "'{topic}' is an absolute topic and gets no prefix, so every use of this file publishes there"
)
UNPREFIXED_HARDWARE = Code(
    "LF5706",
    _W,
    "'{key}' of hardware '{control}' stays {value}, but its {part} gets the prefix; {remedy}",
    fix=Replacement("{bare}", "$(prefix){bare}"),
)
SCANNER_WITHOUT_RAYS = Code(
    "LF5707",
    _W,
    "sensor '{name}' of type {type} has no rays and measures nothing; write `lidar: {{}}` for the defaults",
    subject="name",
    grouped_by=("type",),
)
UNPREFIXED_TOPICS = Code(
    "LF5754",
    _W,
    "plugins of this file name topics, frames or collisions, which get no prefix: {names}; where the file is "
    "used, change with 'override' those that two uses must not share",
)
