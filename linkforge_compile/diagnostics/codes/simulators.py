"""LF74xx and LF75xx: what MJCF and SDF, the formats of simulators, cannot hold of a robot."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E, _W = Severity.ERROR, Severity.WARNING

# LF74xx: MJCF
NESTED_TOO_DEEP = Code(
    "LF7401",
    _E,
    "MuJoCo cannot read bodies nested deeper than {most}, found a chain of {depth} links",
)
MASSLESS_IN_MUJOCO = Code(
    "LF7402",
    _W,
    "MuJoCo refuses a moving body without mass, so '{link}' has 1e-9 kg in the MJCF; give it an inertial",
    subject="link",
    is_loss=True,
)
IMPOSSIBLE_FOR_MUJOCO = Code(
    "LF7403",
    _W,
    "MuJoCo refuses the inertia of '{link}', so all its moments are larger in the MJCF; correct the tensor",
    subject="link",
    is_loss=True,
)
MESH_FOR_MUJOCO = Code(
    "LF7404",
    _W,
    "mesh '{file}' is omitted from the MJCF: {reason}",
    subject="file",
    grouped_by=("reason",),
    is_loss=True,
)
NOT_IN_MJCF = Code(
    "LF7405",
    _W,
    "MJCF has no {parts}; omitted for '{name}'",
    subject="name",
    grouped_by=("parts",),
    is_loss=True,
)

WORLD_BELOW_JOINT = Code(
    "LF7406",
    _E,
    "MuJoCo reserves the name '{name}' for the ground, so no link below a joint can have it; rename this one",
)

ONE_ACTUATOR = Code(
    "LF7407",
    Severity.NOTE,
    "joint '{joint}' has an actuator for its command interface '{interface}' only, not for {others} in the MJCF",
    subject="joint",
    grouped_by=("interface", "others"),
    is_loss=True,
)
NO_GAIN = Code(
    "LF7408",
    _W,
    "the {interface} actuator of joint '{joint}' has MuJoCo's gain of 1; write `{gain}` in its parameters",
    subject="joint",
    grouped_by=("interface",),
)

OPPOSITE_SIGN = Code(
    "LF7409",
    Severity.NOTE,
    "MuJoCo measures the force of the parent on the child, so the signs of '{sensor}' are opposite",
    subject="sensor",
    is_loss=True,
)
TAKEN_IN_MUJOCO = Code(
    "LF7410",
    _E,
    "MuJoCo refuses two {parts} with the same name, and '{name}' is also the name of {owner}; rename this one",
)
NO_VELOCITY_LIMIT = Code(
    "LF7411",
    _W,
    "MuJoCo does not limit velocities; the limit of joint '{joint}' is omitted",
    subject="joint",
    is_loss=True,
)
NO_MESSAGES = Code(
    "LF7412",
    _W,
    "MuJoCo measures at every step and sends no messages; rate, topic and frame of '{sensor}' are omitted",
    subject="sensor",
    is_loss=True,
)

FOR_OTHER_PROGRAMS = Code(
    "LF7413",
    _W,
    "MuJoCo does not read {parts}; omitted for '{name}'",
    subject="name",
    grouped_by=("parts",),
    is_loss=True,
)
NO_ACTUATOR = Code(
    "LF7414",
    Severity.NOTE,
    "no joint of '{robot}' has an actuator in the MJCF: `ros2_control` commands none of them",
    is_loss=True,
)
BASE_STAYS_FIXED = Code(
    "LF7415",
    Severity.NOTE,
    "virtual joint '{joint}' is {type}, but the robot is fixed to the world in the MJCF; `--base free` lets it move",
    is_loss=True,
)

# LF75xx: SDF
NOT_IN_SDF = Code(
    "LF7501",
    _W,
    "SDF has no {parts}; omitted for '{name}'",
    subject="name",
    grouped_by=("parts",),
    is_loss=True,
)
WEIGHTLESS_IN_SDF = Code(
    "LF7502",
    _W,
    "Gazebo needs a mass for each body, so '{link}' has 1e-9 kg in the SDF; give it an inertial",
    subject="link",
    is_loss=True,
)
IMPOSSIBLE_FOR_GAZEBO = Code(
    "LF7503",
    _W,
    "Gazebo refuses the inertia of '{link}', so all its moments are larger in the SDF; correct the tensor",
    subject="link",
    is_loss=True,
)
RENAMED_IN_SDF = Code(
    "LF7504",
    _W,
    "links and joints share their names in SDF, so joint '{joint}' is '{name}' there; rename the joint or the link",
    subject="joint",
    is_loss=True,
)
RESERVED_IN_SDF = Code("LF7505", _E, "'{name}' is reserved in SDF; rename this one")
NO_MIMIC_IN_SDF = Code(
    "LF7506",
    _W,
    "SDF 1.9 has no mimic joints, so '{joint}' moves freely; remove `--sdf 1.9`, or set it to 1.11",
    subject="joint",
    is_loss=True,
)
FREE_IN_SDF = Code(
    "LF7507",
    _W,
    "SDF has no planar joints, so '{joint}' is omitted and link '{link}' moves freely",
    subject="joint",
    is_loss=True,
)
STAYS_A_URI = Code(
    "LF7508",
    _W,
    "the URI of {what} '{file}' stays in the SDF: {reason}",
    subject="file",
    grouped_by=("what", "reason"),
    is_loss=True,
)
RENAMED_SHAPE_IN_SDF = Code(
    "LF7509",
    Severity.NOTE,
    "the shapes and sensors of a link share their names in SDF, so {shape} '{old}' of '{link}' is '{name}' there",
    subject="link",
    grouped_by=("shape", "old"),
    is_loss=True,
)
TAKEN_IN_SDF = Code("LF7510", _E, "Gazebo refuses two parts of '{owner}' with the name '{name}'; rename one of them")
NO_COLLISION_IN_SDF = Code(
    "LF7511",
    _W,
    "contact sensor '{sensor}' detects nothing, because link '{link}' has no collision '{collision}' in the SDF{hint}",
)
NOT_IN_ITS_MODULE = Code(
    "LF7512",
    Severity.NOTE,
    "gz_ros2_control finds no joints in nested models, so '{joint}' is in the model of the robot, not in that of its "
    "module",
    subject="joint",
    is_loss=True,
)
NO_BODY_IN_SDF = Code(
    "LF7513", _E, "Gazebo refuses a model without links, such as '{robot}'; add a link that is not `world`"
)
MIMIC_OF_ENGINE = Code(
    "LF7514",
    Severity.NOTE,
    "DART, Gazebo's default engine, ignores mimic joints, so '{joint}' moves freely; choose bullet-featherstone, or "
    "have gz_ros2_control move it",
    subject="joint",
    is_loss=True,
)
CLASSIC_IN_SDF = Code(
    "LF7515",
    _W,
    "'{file}' is a plugin of Gazebo Classic, which Gazebo Sim does not load; write one of Gazebo Sim, such as "
    "gz_ros2_control-system",
    subject="file",
    is_loss=True,
)
