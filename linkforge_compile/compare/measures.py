"""What the numbers of a robot measure, when two are taken for the same, and how a change of one is told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.core.fields import Number, Vector, field_specs
from linkforge_compile.core.part import Part
from linkforge_compile.units import Dimension, Motion


class Measure(NamedTuple):
    """The unit in which a number is shown, how much of it an SI unit is, and whether a change is told as a share."""

    unit: str = ""
    shown: float = 1.0
    as_share: bool = True


BARE = Measure()
LENGTH = Measure("m", as_share=False)
ANGLE = Measure("deg", 180 / math.pi, as_share=False)

_BY_DIMENSION: Mapping[Dimension | None, Measure] = {Dimension.LENGTH: LENGTH, Dimension.ANGLE: ANGLE}
_POSITION = (ANGLE, LENGTH)
"""Of a joint that turns, and of one that slides."""


def measure_of(kind: type, field: str, *, slides: bool) -> Measure:
    """Return what a field measures; `slides` says that it is about a prismatic joint."""
    spec = field_specs(kind).get(field) if issubclass(kind, Part) else None
    if not isinstance(spec, Number | Vector):
        return BARE
    motion = Motion.SLIDING if slides else Motion.TURNING
    return _BY_DIMENSION.get(spec.unit.dimension(motion)) or Measure(spec.unit.text(motion))


def position_measure(*, slides: bool) -> Measure:
    """Return what the position of a joint measures."""
    return _POSITION[slides]


_FLOOR = 1e-6
"""Of the tolerance: what a number next to 0 may differ by, where a share means nothing."""


def is_near(before: float, after: float, tolerance: float) -> bool:
    """Whether two numbers differ by no more than the tolerance, as a share of the larger one."""
    return math.isclose(before, after, rel_tol=tolerance, abs_tol=tolerance * _FLOOR)


def number_told(value: float, measure: Measure = BARE, digits: int = 6) -> str:
    """Return a number for people to read, rounded and with its unit."""
    return f"{_digits(value * measure.shown, digits)} {measure.unit}".rstrip()


def change_told(before: float, after: float, measure: Measure) -> str:
    """Return `90 deg → 120 deg (+30 deg)`, with as many digits as it takes to see that they differ."""
    digits = _digits_to_tell(before, after, measure)
    told = f"{number_told(before, measure, digits)} → {number_told(after, measure, digits)}"
    by = _by_how_much(before, after, measure)
    return f"{told} ({by})" if by else told


def share_told(before: float, after: float) -> str:
    """Return by which part of itself a number changed, "" where it was 0 or turned its sign."""
    if before == 0 or (before < 0) != (after < 0):
        return ""
    share = abs(after / before) - 1
    return f"x{_digits(after / before, 3)}" if share > 9 else f"{share * 100:+.3g} %"


def distance_told(metres: float) -> str:
    """Return a small distance in millimetres."""
    return f"{_digits(metres * 1000, 4)} mm"


def _by_how_much(before: float, after: float, measure: Measure) -> str:
    if measure.as_share:
        return share_told(before, after)
    change = after - before
    sign = "+" if change > 0 else "-"
    if measure is LENGTH and abs(change) < 1:
        return f"{sign}{distance_told(abs(change))}"
    return f"{sign}{_digits(abs(change) * measure.shown, 4)} {measure.unit}"


def _digits_to_tell(before: float, after: float, measure: Measure) -> int:
    for digits in range(6, 17):
        if number_told(before, measure, digits) != number_told(after, measure, digits):
            return digits
    return 17


def _digits(value: float, digits: int) -> str:
    return f"{value + 0.0:.{digits}g}"
