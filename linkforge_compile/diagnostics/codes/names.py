"""LF4xxx: names and references."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

INVALID_NAME = Code("LF4001", Severity.ERROR, "'{name}' is no name for a {kind}: {reason}")
DUPLICATE_NAME = Code("LF4101", Severity.ERROR, "there are two {kind}s named '{name}'")
UNKNOWN_LINK = Code("LF4102", Severity.ERROR, "no link named '{name}'")
UNKNOWN_JOINT = Code("LF4103", Severity.ERROR, "no joint named '{name}'")
UNKNOWN_GROUP = Code("LF4104", Severity.ERROR, "no planning group named '{name}'")
UNKNOWN_MATERIAL = Code("LF4105", Severity.ERROR, "no material named '{name}'")
MODULES_SHARE_NAMES = Code(
    "LF4106", Severity.ERROR, "modules '{first}' and '{second}' both have {parts}; give one of them another prefix"
)
NAMES_OF_THIS_FILE = Code(
    "LF4107", Severity.ERROR, "module '{module}' and this file both have {parts}; give the module another prefix"
)

# LF42xx: references across the layers
UNKNOWN_GAZEBO_REFERENCE = Code("LF4201", Severity.WARNING, "no link or joint named '{name}'")
