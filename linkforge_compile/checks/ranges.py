"""How far a joint goes by its limits, for those who want it somewhere."""

from __future__ import annotations

from linkforge_compile.core.models.joint import Joint, JointType

WITHIN_LIMITS: dict[str, str] = {JointType.REVOLUTE: "rad", JointType.PRISMATIC: "m"}
"""The joints whose limits bound their position, and its unit."""

ROUNDING = 1e-4
"""How far a position may pass a limit [rad] or [m]: 1.5708 for a quarter turn is no mistake."""


def missed_range(joint: Joint, lowest: float, highest: float) -> str | None:
    """Return "from -1 to 1 rad" if the joint can be nowhere between two positions [rad] or [m]; None if it can."""
    limits = joint.limits
    if limits is None or joint.type not in WITHIN_LIMITS:
        return None
    lower, upper = limits.lower, limits.upper
    below = lower is not None and highest < lower - ROUNDING
    above = upper is not None and lowest > upper + ROUNDING
    if not (below or above):
        return None
    bounds = [f"{way} {bound:.6g}" for way, bound in (("from", lower), ("to", upper)) if bound is not None]
    return " ".join((*bounds, WITHIN_LIMITS[joint.type]))
