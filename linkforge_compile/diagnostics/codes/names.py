"""LF4xxx: names and references."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

_VALUE = Location.VALUE

INVALID_NAME = Code("LF4001", Severity.ERROR, "'{name}' is not a valid name for a {kind}: {reason}", _VALUE)
RESERVED_NAME = Code(
    "LF4002", Severity.WARNING, "Gazebo refuses a {kind} named '{name}', which it reserves; choose another name"
)
FRAME_WITH_SLASH = Code("LF4003", Severity.WARNING, "tf2 refuses frame '{name}', which begins with '/'; leave it out")
REFUSED_TOPIC = Code("LF4004", Severity.WARNING, "ROS 2 refuses topic '{topic}': {reason}")

DUPLICATE_NAME = Code("LF4101", Severity.ERROR, "there are two {kind}s named '{name}'")
UNKNOWN_LINK = Code("LF4102", Severity.ERROR, "no link named '{name}'", _VALUE, is_unknown_name=True)
UNKNOWN_JOINT = Code("LF4103", Severity.ERROR, "no joint named '{name}'", _VALUE, is_unknown_name=True)
UNKNOWN_GROUP = Code("LF4104", Severity.ERROR, "no planning group named '{name}'{hint}", _VALUE, is_unknown_name=True)
UNKNOWN_MATERIAL = Code("LF4105", Severity.ERROR, "no material named '{name}'{hint}", _VALUE, is_unknown_name=True)
MODULES_SHARE_NAMES = Code(
    "LF4106", Severity.ERROR, "modules '{first}' and '{second}' both have {parts}; give one of them another prefix"
)
NAMES_OF_THIS_FILE = Code(
    "LF4107", Severity.ERROR, "module '{module}' and this file both have {parts}; give the module another prefix"
)
LINK_AND_JOINT = Code(
    "LF4108", Severity.WARNING, "a link and a joint are both named '{name}', which Gazebo refuses; rename one of them"
)
SHARED_TOPIC = Code("LF4109", Severity.WARNING, "sensors '{first}' and '{second}' both publish on topic '{topic}'")
NAME_TWICE = Code("LF4160", Severity.WARNING, "'{name}' is listed twice in '{field}' of {owner}; remove one")
OWN_ATTRIBUTE_STAYS = Code(
    "LF4161", Severity.WARNING, "{what} is '{theirs}' in module '{module}' and '{ours}' here; this file's value is kept"
)

# LF42xx: references across the layers
UNKNOWN_GAZEBO_REFERENCE = Code("LF4201", Severity.WARNING, "no link or joint named '{name}'")
UNKNOWN_FRAME = Code("LF4202", Severity.WARNING, "no link named '{name}', so tf2 cannot tell where this frame is")
UNKNOWN_PLUGIN_JOINT = Code("LF4203", Severity.NOTE, "no joint named '{name}' for plugin '{plugin}'")
UNKNOWN_COLLISION = Code("LF4204", Severity.WARNING, "no collision named '{name}', so this sensor will touch nothing")
