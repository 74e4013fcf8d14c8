"""How far a joint goes by its limits, for those who want it somewhere."""

from __future__ import annotations

import math
import re

from linkforge_compile.core.models.joint import Joint, JointType

WITHIN_LIMITS: dict[str, str] = {JointType.REVOLUTE: "rad", JointType.PRISMATIC: "m"}
"""The joints whose limits bound their position, and its unit."""

ROUNDING = 1e-4
"""How far a position may pass a limit [rad] or [m]: 1.5708 for a quarter turn is no mistake."""


_SIZES = {"deg": math.pi / 180, "°": math.pi / 180, "mm": 0.001, "cm": 0.01}
"""What a unit in which positions are often written is in [rad] or [m]."""

_UNIT = re.compile(r"[0-9.]\s*(?P<unit>deg|°|mm|cm)['\"]?")

_SAYS_UNIT = re.compile(r"[0-9]\.?\s*(?![eE][-+]?[0-9])[^\W\d_]|°|\$\(")


def says_unit(text: str | None) -> bool:
    """Whether a number is written with a unit, or computed, which may have one; False for no text."""
    return bool(text and _SAYS_UNIT.search(text))


def unit_in(text: str | None) -> str | None:
    """Return the unit in which a position is written; None for one in SI units, for an expression, and for no text."""
    found = _UNIT.search(text) if text and "$(" not in text else None
    return found["unit"] if found else None


def in_unit(position: float, unit: str | None) -> str:
    """Return a position [rad] or [m] as a person who uses that unit reads it; None is SI, without the unit's name."""
    return f"{position:.6g}" if unit is None else f"{position / _SIZES[unit]:.6g} {unit}"


def missed_range(joint: Joint, lowest: float, highest: float, unit: str | None = None) -> str | None:
    """Return "from -1 to 1 rad" if the joint can be nowhere between two positions [rad] or [m]; None if it can.

    In another `unit` it says "from -90 deg to 90 deg".
    """
    limits = joint.limits
    if limits is None or joint.type not in WITHIN_LIMITS:
        return None
    lower, upper = limits.lower, limits.upper
    below = lower is not None and highest < lower - ROUNDING
    above = upper is not None and lowest > upper + ROUNDING
    return _range(joint, lower, upper, unit) if below or above else None


def passed_range(joint: Joint, lowest: float, highest: float) -> tuple[str, str] | None:
    """Return the range of a joint and the one in which it is driven [rad] or [m], in words, if that is not within.

    Both are in the unit in which the joint's limits are written.
    """
    limits = joint.limits
    if limits is None or joint.type not in WITHIN_LIMITS:
        return None
    below = limits.lower is not None and lowest < limits.lower - ROUNDING
    above = limits.upper is not None and highest > limits.upper + ROUNDING
    if not (below or above):
        return None
    ends = (joint.source.at("limits", side) for side in ("lower", "upper")) if joint.source else ()
    unit = next((unit for end in ends if (unit := unit_in(end.text))), None)
    return _range(joint, limits.lower, limits.upper, unit), _range(joint, lowest, highest, unit)


def _range(joint: Joint, lower: float | None, upper: float | None, unit: str | None) -> str:
    bounds = [f"{way} {in_unit(bound, unit)}" for way, bound in (("from", lower), ("to", upper)) if bound is not None]
    return " ".join((*bounds, *(() if unit else (WITHIN_LIMITS[joint.type],))))
