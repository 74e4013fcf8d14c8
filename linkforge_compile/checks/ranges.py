"""How far a joint goes by its limits, for those who want it somewhere."""

from __future__ import annotations

import math
import re

from linkforge_compile.core.constants import UNKNOWN
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.source import Key

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


def is_known(*numbers: float | None) -> bool:
    """Whether none of these stands in for a number whose fault was told."""
    return all(number is None or abs(number) < UNKNOWN for number in numbers)


def unit_at(joint: Joint, *paths: tuple[str | Key, ...]) -> str | None:
    """Return the unit in which the first of some positions that says one is written."""
    places = (joint.source.at(*path) for path in paths) if joint.source else ()
    return next((unit for place in places if (unit := unit_in(place.text))), None)


def measured(joint: Joint, position: float, unit: str | None) -> str:
    """Return a position [rad] or [m] with its unit, the SI one for None."""
    return in_unit(position, unit) if unit else f"{in_unit(position, None)} {WITHIN_LIMITS[joint.type]}"


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
    unit = unit_at(joint, ("limits", "lower"), ("limits", "upper"))
    return _range(joint, limits.lower, limits.upper, unit), _range(joint, lowest, highest, unit)


def _range(joint: Joint, lower: float | None, upper: float | None, unit: str | None) -> str:
    ends = (("from", lower), ("to", upper))
    bounds = [f"{way} {in_unit(end, unit)}" for way, end in ends if end is not None and is_known(end)]
    return " ".join((*bounds, *(() if unit else (WITHIN_LIMITS[joint.type],))))
