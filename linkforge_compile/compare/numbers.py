"""Numbers of a robot: the unit each is shown in, when two count as equal, and how a change is described."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from decimal import Decimal
from typing import NamedTuple

from linkforge_compile.compare.fields import specs_of
from linkforge_compile.core.fields import Number, Vector
from linkforge_compile.units import POSITION, Dimension, FieldUnit, Motion

_FLOOR = 1e-6
"""Share of the tolerance by which a number close to 0 may differ; a relative tolerance fails there."""

_XML_NUMBER = re.compile(r"[+-]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?")
"""A number in XML text. One with leading zeros is a name: 007 is not 7."""


class Measure(NamedTuple):
    """The unit that a number is shown in, its factor from SI, and whether a change is described as a percentage."""

    unit: str = ""
    factor: float = 1.0
    as_share: bool = True


BARE = Measure()
LENGTH = Measure("m", as_share=False)
ANGLE = Measure("deg", 180 / math.pi, as_share=False)

_BY_DIMENSION: Mapping[Dimension | None, Measure] = {Dimension.LENGTH: LENGTH, Dimension.ANGLE: ANGLE}


def measure_of(kind: type, field: str, *, slides: bool) -> Measure:
    """Return the measure of a field of a class; `slides` is whether it is about a prismatic joint."""
    match specs_of(kind).get(field):
        case Number(unit=unit) | Vector(unit=unit):
            return _measure_in(unit, slides=slides)
    return BARE


def position_measure(*, slides: bool) -> Measure:
    """Return the measure of a joint's position."""
    return _measure_in(POSITION, slides=slides)


def _measure_in(unit: FieldUnit, *, slides: bool) -> Measure:
    motion = Motion.SLIDING if slides else Motion.TURNING
    return _BY_DIMENSION.get(unit.dimension(motion)) or Measure(unit.text(motion))


def is_near(before: float, after: float, tolerance: float) -> bool:
    """Whether two numbers differ by at most the tolerance, relative to the larger one."""
    return math.isclose(before, after, rel_tol=tolerance, abs_tol=tolerance * _FLOOR)


def describe_number(value: float, measure: Measure = BARE, digits: int = 6) -> str:
    """Return a number rounded to significant digits, with its unit."""
    return f"{_rounded(value * measure.factor, digits)} {measure.unit}".rstrip()


def describe_change(before: float, after: float, measure: Measure) -> str:
    """Return a change such as `90 deg → 120 deg (+30 deg)`, with enough digits to show the difference."""
    for digits in range(6, 18):
        was, now = describe_number(before, measure, digits), describe_number(after, measure, digits)
        if was != now:
            break
    difference = _describe_difference(before, after, measure)
    return f"{was} → {now} ({difference})" if difference else f"{was} → {now}"


def describe_distance(metres: float) -> str:
    """Return a short distance in millimetres."""
    return f"{_rounded(metres * 1000, 4)} mm"


def _describe_difference(before: float, after: float, measure: Measure) -> str:
    if measure.as_share:
        return _describe_share(before, after)
    change = after - before
    sign = "+" if change > 0 else "-"
    if measure is LENGTH and abs(change) < 1:
        return f"{sign}{describe_distance(abs(change))}"
    return f"{sign}{_rounded(abs(change) * measure.factor, 4)} {measure.unit}"


def _describe_share(before: float, after: float) -> str:
    """Return a relative change such as `+5 %`; empty where the number was 0 or changed its sign."""
    if before == 0 or (before < 0) != (after < 0):
        return ""
    share = abs(after / before) - 1
    return f"x{_rounded(after / before, 3)}" if share > 9 else f"{share * 100:+.3g} %"


def _rounded(value: float, digits: int) -> str:
    return f"{value + 0.0:.{digits}g}"  # + 0.0 turns -0 into 0


def xml_number(text: str) -> float | None:
    """Return the finite number that a text in XML spells, None for any other text."""
    number = float(text) if _XML_NUMBER.fullmatch(text.strip()) else math.inf
    return number if math.isfinite(number) else None


def spell_same_numbers(before: str, after: str, tolerance: float) -> bool:
    """Whether two texts in XML spell the same numbers, as `0.20 1e-3` and `0.2 0.001` do.

    Whole numbers must be equal: they may be counts or identifiers. Others may differ by the relative tolerance.
    """
    were, are = before.split(), after.split()
    if not 0 < len(were) == len(are):
        return False
    return all(_is_same_number(*pair, tolerance) for pair in zip(were, are, strict=True))


def _is_same_number(before: str, after: str, tolerance: float) -> bool:
    if not (_XML_NUMBER.fullmatch(before) and _XML_NUMBER.fullmatch(after)):
        return False
    was, now = Decimal(before), Decimal(after)
    if was == now or (was == was.to_integral_value() and now == now.to_integral_value()):
        return was == now
    return is_near(float(was), float(now), tolerance)
