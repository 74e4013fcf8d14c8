"""LF77xx: the self-collision matrix."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E = Severity.ERROR

UNKNOWN_SHAPE = Code(
    "LF7701",
    _E,
    "the mesh '{file}' of a collision cannot be opened, so its link cannot be sampled: {reason}",
    subject="file",
    grouped_by=("reason",),
)
UNREADABLE_SHAPE = Code(
    "LF7702", _E, "the mesh '{file}' of a collision cannot be read, so its link cannot be sampled: {reason}"
)
HIDDEN_COLLISIONS = Code(
    "LF7703",
    Severity.NOTE,
    "{pair} collide in the default pose, but rarely in other poses; list them in "
    "'enabled_collisions' to keep checking them",
    subject="pair",
)
ADJACENT_CHECKED = Code(
    "LF7704",
    Severity.WARNING,
    "MoveIt checks '{pair}' for collisions, although a joint connects them; list adjacent links in "
    "`disabled_collisions`, as 'linkforge collisions SPEC --write' does",
    subject="pair",
)
