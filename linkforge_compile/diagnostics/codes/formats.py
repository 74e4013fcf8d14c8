"""LF70xx, LF71xx: what an output cannot express, outdated outputs; LF72xx: user templates; LF76xx: controllers."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E, _W = Severity.ERROR, Severity.WARNING

UNWRITABLE = Code("LF7001", _E, "this cannot be written as XML: {reason}")
NEW_GEOMETRY = Code(
    "LF7002", _W, "a capsule needs a reader of URDF 1.1, such as urdfdom 6 or MuJoCo; older ones refuse the whole file"
)
OLD_VERSION = Code(
    "LF7003",
    _W,
    "a robot with a capsule is URDF 1.1 or later, found version '{version}'; omit `version` to get the right one",
)
UNKNOWN_VERSION = Code(
    "LF7004", _W, "urdfdom reads the versions 1.0, 1.1 and 1.2 of URDF and refuses any other, found '{version}'"
)
TWO_MATERIALS = Code(
    "LF7005",
    _W,
    "there are different materials named '{name}', and most viewers show all of them like the first; give each its "
    "own name",
)
MESH_BESIDE_THE_SPEC = Code(
    "LF7006",
    _W,
    "mesh path '{path}' is relative to this file and cannot be found from '{folder}', the {document}'s "
    "folder; write 'package://NAME/PATH'{elsewhere}",
)
UNDECLARED_PREFIX = Code(
    "LF7007",
    _W,
    "no 'xmlns:{prefix}' around this declares the prefix '{prefix}'; add it to the robot's 'extra_attributes'",
    in_xml="no 'xmlns:{prefix}' around this declares the prefix '{prefix}'; add it to <robot>",
)

# LF714x: duplicates in the output
SECOND_OF_ONE = Code(
    "LF7145",
    _W,
    "this is a second <{tag}>, and readers use only one of the two, mostly the first, or refuse the file; remove one",
)

RAW_NAME_IS_TAKEN = Code(
    "LF7160",
    _E,
    "there is already a {tag} '{name}', and URDF readers refuse a robot with two; remove or rename this one",
)

# LF708x, LF709x: what a command asks of an output
NO_SEMANTIC_PART = Code(
    "LF7085",
    _E,
    "robot '{robot}' has no 'semantic' part, so there is no SRDF to write; add one, or compile to URDF",
    in_xml="a URDF has no planning groups, so there is no SRDF to write of robot '{robot}'; compile to URDF, or a spec "
    "with 'use' of it and 'srdf'",
)
CHANGED_SINCE = Code("LF7086", _W, "the source map is out of date, as this file changed since {when}; compile it again")
SOURCE_NOT_SHOWN = Code("LF7087", _W, "the source cannot be shown: {reason}")
STALE_OUTPUT = Code(
    "LF7095",
    _E,
    "out of date: '{spec}' now compiles to {expected}; compile it again, and edit it instead of this file",
)
MISSING_OUTPUT = Code("LF7096", _E, "there is no '{path}', which '{spec}' compiles to; compile it again")

# LF715x: what readers of newer URDF make of it
OTHER_QUATERNION = Code(
    "LF7154",
    _E,
    "quat_xyzw differs from rpy, which is {rpy}; readers of URDF 1.1 use the first, others the second: remove it",
)

# LF710x: sensors in Gazebo
NO_JOINT_TO_SENSE = Code(
    "LF7101", _W, "Gazebo measures forces in the joint above a link, and there is none above '{link}'"
)
SENSOR_ON_MERGED_JOINT = Code(
    "LF7102",
    _W,
    "Gazebo merges the links of the fixed joint '{joint}' and drops its sensor; set "
    "`preserveFixedJoint: true` in the joint's `gazebo`",
)
NOISELESS_CONTACT = Code("LF7103", _W, "Gazebo's contact sensors have no noise; it is omitted")
FRAME_OF_PLUGIN = Code("LF7104", _W, "in Gazebo Classic the plugin sets the frame of a sensor; '{frame}' is omitted")
FOREIGN_INFO = Code("LF7105", _W, "a sensor of type {type} has no '{info}'; it is omitted")

# LF72xx: templates of users
TEMPLATE_SYNTAX = Code("LF7201", _E, "Jinja2 cannot read this template: {reason}")
UNDEFINED_IN_TEMPLATE = Code("LF7202", _E, "this template uses an undefined name: {reason}")
NO_SUCH_TEMPLATE = Code("LF7203", _E, "no template '{name}' in '{folder}'")
REFUSED_IN_TEMPLATE = Code("LF7204", _E, "a template may only read the robot: {reason}")
TEMPLATE_FAILS = Code("LF7205", _E, "this template fails here: {reason}")
NOT_XML_FROM_TEMPLATE = Code("LF7206", _E, "this template writes XML that is not well-formed: {problem}")
UNREADABLE_TEMPLATE = Code("LF7207", _E, "template '{path}' cannot be read: {reason}")
UNUSED_TEMPLATE = Code(
    "LF7208", _W, "'{name}' is unused: linkforge has no template of that name to replace, and no template includes it"
)

# LF76xx: control and planning
NO_LIMIT_FOR_MOVEIT = Code(
    "LF7601",
    _W,
    "MoveIt cannot plan motions of '{joint}' without a maximum {limit}; write `{limit}` in its `limits`",
    subject="joint",
    grouped_by=("limit",),
)
NO_MOVING_JOINT = Code("LF7602", _E, "robot '{robot}' has no joint with limits: no joint turns or slides independently")

NO_HARDWARE = Code("LF7603", _E, "robot '{robot}' has no `ros2_control`, so there is nothing to control")
CONTROLLER_LACKS = Code("LF7604", _W, "controller '{controller}' of type {type} does not start without {parameter}")
NOT_OF_CONTROLLER = Code(
    "LF7605",
    _W,
    "a {type} has no '{field}'; omitted for '{controller}'",
    subject="controller",
    grouped_by=("type", "field"),
)
NOT_OF_HARDWARE = Code(
    "LF7606",
    _W,
    "controller '{controller}' does not start: joint '{joint}' has no {what} in `ros2_control`",
    subject="joint",
    grouped_by=("controller", "what"),
)
NO_CONTROLLER_FOR_JOINT = Code("LF7607", _W, "no controller commands joint '{joint}'", subject="joint")
NO_GROUP_TO_PLAN = Code("LF7608", _E, "robot '{robot}' has no planning group that MoveIt can plan for")
NOTHING_EXECUTES = Code(
    "LF7609",
    _W,
    "MoveIt cannot execute motions of group '{group}': {reason}",
    subject="group",
    grouped_by=("reason",),
)
UNKNOWN_PARAMETER = Code("LF7611", _W, "{owner} has no parameter '{name}'{inside}")
WRONG_PARAMETER = Code("LF7612", _W, "'{name}' of {owner} accepts {expected}, found {found}")
MISSPELLED_CLASS = Code("LF7613", _W, "there is no controller class '{type}'; did you mean '{intended}'?")
NO_GAINS = Code(
    "LF7614",
    _W,
    "controller '{controller}' does not move joint '{joint}': it commands only {interface}, and its `gains` are 0; "
    "write `{joint}: {{p: …}}` in `gains` of its `parameters`",
    subject="joint",
    grouped_by=("controller",),
)
NO_JOINT_STATES = Code(
    "LF7615",
    _W,
    "no controller publishes the states of the joints, which MoveIt needs; write `joint_state_broadcaster: "
    "{{type: joint_state_broadcaster/JointStateBroadcaster}}` in `controllers`",
)
UNKNOWN_OF_SOLVER = Code("LF7616", _W, "MoveIt does not read '{name}' in the `kinematics` of a group")
NO_SOLVER = Code(
    "LF7617",
    _W,
    "group '{group}' has no solver, because it is that of an end effector; write its `kinematics`",
    subject="group",
)
STATED_TWICE = Code(
    "LF7621",
    _E,
    "controller '{controller}' has '{parameter}' in `parameters`{owner}, {conflict}",
)
ONE_OF_SEVERAL = Code(
    "LF7622",
    _W,
    "a {type} accepts one name in '{field}'; '{item}' of '{controller}' is omitted",
    subject="item",
    grouped_by=("type", "field", "controller"),
)
LIST_OF_SEVERAL_TYPES = Code(
    "LF7623",
    _E,
    "ROS 2 refuses a parameter file with this list, '{parameter}' of '{controller}': items must be "
    "all numbers, all strings or all booleans",
)
NO_NAME_OF_A_NODE = Code(
    "LF7624",
    _W,
    "controller '{controller}' does not start: the name of a node has only ASCII letters, digits and '_', "
    "and does not begin with a digit",
)
