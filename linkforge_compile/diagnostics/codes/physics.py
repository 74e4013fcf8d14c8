"""LF6xxx: masses and inertias that no body has, and interfaces that no hardware can serve."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE

# LF60xx: mass and inertia
ZERO_INERTIA = Code("LF6001", _W, "link '{link}' has a mass of {mass} kg and an inertia of zero")
INDEFINITE_INERTIA = Code(
    "LF6002", _W, "principal moments of inertia of link '{link}' must be above 0, found {moments}"
)
IMPOSSIBLE_INERTIA = Code(
    "LF6003", _W, "no principal moment of inertia of link '{link}' may be above the sum of the others, found {moments}"
)
MASSLESS_BODY = Code(
    "LF6004", _N, "joint '{joint}' moves link '{link}', which has no mass: Gazebo leaves it out with all below it"
)

# LF61xx: ros2_control
COMMANDED_TWICE = Code("LF6101", _E, "interface '{interface}' is commanded by {first} already")
READ_TWICE = Code("LF6102", _W, "interface '{interface}' is read by {first} already")
FIXED_JOINT_CONTROLLED = Code("LF6103", _W, "joint '{joint}' is fixed, so ros2_control has nothing to read or command")
