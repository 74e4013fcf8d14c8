"""LF4xxx: names and references."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE
_VALUE = Location.VALUE

INVALID_NAME = Code("LF4001", _E, "'{name}' is not a valid {kind}: {reason}", _VALUE)
RESERVED_NAME = Code("LF4002", _W, "Gazebo refuses a {kind} named '{name}', which it reserves; choose another name")
FRAME_WITH_SLASH = Code("LF4003", _W, "tf2 refuses frame '{name}', which begins with '/'; remove the '/'")
REFUSED_TOPIC = Code("LF4004", _W, "ROS 2 refuses topic '{topic}': {reason}")

DUPLICATE_NAME = Code("LF4101", _E, "there are two {kind}s named '{name}'")
UNKNOWN_LINK = Code("LF4102", _E, "no link named '{name}'", _VALUE, is_unknown_name=True)
UNKNOWN_JOINT = Code("LF4103", _E, "no joint named '{name}'", _VALUE, is_unknown_name=True)
UNKNOWN_GROUP = Code("LF4104", _E, "no planning group named '{name}'{hint}", _VALUE, is_unknown_name=True)
UNKNOWN_MATERIAL = Code("LF4105", _E, "no material named '{name}'{hint}", _VALUE, is_unknown_name=True)
MODULES_SHARE_NAMES = Code(
    "LF4106", _E, "modules '{first}' and '{second}' both have {parts}; give one of them another prefix"
)
NAMES_OF_THIS_FILE = Code(
    "LF4107", _E, "module '{module}' and this file both have {parts}; give the module another prefix"
)
MATERIALS_DIFFER = Code(
    "LF4113",
    _E,
    "module '{module}' declares {parts} differently from {first}; make the declarations equal, or give the module "
    "another prefix",
)
LINK_AND_JOINT = Code(
    "LF4108", _W, "a link and a joint are both named '{name}', which Gazebo refuses; rename one of them"
)
SHARED_TOPIC = Code("LF4109", _W, "sensors '{first}' and '{second}' both publish on topic '{topic}'")
UNKNOWN_HARDWARE_SENSOR = Code("LF4110", _W, "no sensor named '{name}' in `ros2_control`", _VALUE)
MODULES_DISAGREE = Code(
    "LF4111",
    _E,
    "modules '{first}' and '{second}' have different values of '{parameter}' in 'controller_manager'; "
    "write the right one in `controllers` of this file",
)
UNKNOWN_OF_MANAGER = Code("LF4112", _W, "no {kind} named '{name}' for the controller manager", _VALUE)
NAME_TWICE = Code("LF4160", _W, "'{name}' is listed twice in '{field}' of {owner}; remove one")
OWN_ATTRIBUTE_STAYS = Code(
    "LF4161", _W, "{what} is '{theirs}' in module '{module}' and '{ours}' here; this file's value is kept"
)

# LF42xx: references across the layers
UNKNOWN_GAZEBO_REFERENCE = Code("LF4201", _W, "no link or joint named '{name}'")
UNKNOWN_FRAME = Code("LF4202", _W, "no link named '{name}', so tf2 cannot tell where this frame is")
UNKNOWN_PLUGIN_JOINT = Code("LF4203", _N, "no joint named '{name}' for plugin '{plugin}'")
UNKNOWN_COLLISION = Code("LF4204", _W, "no collision named '{name}', so this sensor reports no contacts")
