"""Numbers of the tree: what a scalar says in SI units, or why it does not say what its field takes."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import dataclass, field
from functools import cache

from linkforge_compile.core.fields import ABOVE_ZERO, NOT_NEGATIVE, ZERO_TO_ONE, Bound
from linkforge_compile.diagnostics import Code
from linkforge_compile.diagnostics.codes.model import (
    LONG_LENGTH,
    NOT_FINITE,
    OUT_OF_RANGE,
    UNKNOWN_UNIT,
    WIDE_ANGLE,
    WRONG_DIMENSION,
    WRONG_KIND,
)
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import scalar_value
from linkforge_compile.units import (
    WIDEST_ANGLE,
    Dimension,
    FieldUnit,
    Motion,
    Quantity,
    number_text,
    parse_quantity,
    suggested_unit,
    unit_text,
    units_of,
)

_WORDS = {
    Dimension.LENGTH: ("a length", "25 mm"),
    Dimension.ANGLE: ("an angle", "90 deg"),
    Dimension.MASS: ("a mass", "3 kg"),
    Dimension.TIME: ("a time", "10 ms"),
    Dimension.FREQUENCY: ("a frequency", "20 Hz"),
    Dimension.FORCE: ("a force", "30 N"),
    Dimension.TORQUE: ("a torque", "5 N*m"),
    Dimension.VELOCITY: ("a velocity", "0.5 m/s"),
    Dimension.ANGULAR_VELOCITY: ("an angular velocity", "90 deg/s"),
    Dimension.DENSITY: ("a density", "2700 kg/m^3"),
    Dimension.INERTIA: ("a moment of inertia", "0.01 kg*m^2"),
}
"""Each dimension as a person says it, and a value that shows how it is written."""

_MOST_TURNED, _UNBOUNDED = 8 * math.pi, 1e4
"""A URDF has no unit to say that an angle is meant so [rad]: vendors write limits of 10, and of 1e16 for none."""
_LARGEST = sys.float_info.max


_ANGLE, _LENGTH = (Dimension.ANGLE,), (Dimension.LENGTH,)
_DOUBTED_BEYOND: dict[tuple[Dimension, ...], float] = {_ANGLE: WIDEST_ANGLE, _LENGTH: 100.0}
"""How far from 0 those numbers lie, by what is measured, that are likely meant in degrees or millimetres."""


class Measure:
    """What a number field takes: a bare number or a quantity of one of `dimensions`, none for bare numbers only.

    A length of more than 100 m is doubted, unless it is how far something sees. Bare numbers from `least` to `most`
    are neither refused nor doubted, so that nearly all are taken without another look.
    """

    # No frozen class: its two ends are worked out as it is made, and read for each number.
    __slots__ = ("bound", "dimensions", "least", "may_be_far", "most")

    def __init__(
        self, dimensions: tuple[Dimension, ...] = (), bound: Bound | None = None, *, may_be_far: bool = False
    ) -> None:
        self.dimensions, self.bound, self.may_be_far = dimensions, bound, may_be_far
        reach = _LARGEST if may_be_far else _DOUBTED_BEYOND.get(dimensions, _LARGEST)
        self.least = max(-reach, bound.least) if bound else -reach
        self.most = min(reach, bound.most) if bound else reach

    @property
    def words(self) -> str:
        """What to write, as in "mass takes a mass such as '3 kg'"."""
        if not self.dimensions:
            return "a bare number"
        return " or ".join("{} such as '{}'".format(*_WORDS[dimension]) for dimension in self.dimensions)

    @property
    def si_unit(self) -> str:
        """The unit of a bare number in brackets behind a space; nothing where it has none, or one of several."""
        return f" [{self.dimensions[0].si_unit}]" if len(self.dimensions) == 1 else ""


@cache
def measure_of(unit: FieldUnit, bound: Bound | None, motion: Motion, may_be_far: bool = False) -> Measure:
    """Return what a number field of a model class takes, on a joint that moves in a way."""
    return Measure(unit.dimensions(motion), bound, may_be_far=may_be_far)


BARE = Measure()
"""Any number without a unit."""
AMOUNT = Measure(bound=NOT_NEGATIVE)
SHARE = Measure(bound=ZERO_TO_ONE)
LENGTH = Measure(_LENGTH)
EXTENT = Measure(_LENGTH, ABOVE_ZERO)
"""How long something is [m]."""
ANGLE = Measure(_ANGLE)
ANGLE_OR_LENGTH = Measure((*_ANGLE, *_LENGTH))
"""A joint's position, of which nobody says yet whether it turns [rad] or slides [m]."""


@dataclass(frozen=True)
class Refusal:
    """Why a node is not the number that its field takes; the field's name is the one fact that is missing."""

    code: Code
    facts: dict[str, str] = field(default_factory=dict)
    near: tuple[str, ...] = ()


def plain_number(node: YamlNode, measure: Measure) -> float | None:
    """Return the number that a node says bare, where the measure neither refuses nor doubts it.

    That is nine of ten; None for one that has to be looked at.
    """
    if node.__class__ is YamlScalar:
        value = node.value
        if value.__class__ is float:
            return value if measure.least <= value <= measure.most else None
        if value.__class__ is int and measure.least <= value <= measure.most:
            return float(value)
    return None


def plain_numbers(node: YamlNode, measure: Measure) -> tuple[float, ...]:
    """Return the numbers that a list says where each is one for `plain_number`; none for anything else."""
    if node.__class__ is not YamlList:
        return ()
    least, most = measure.least, measure.most
    numbers: list[float] = []
    # There are so many vectors that what `plain_number` asks is asked here.
    for item in node.items:
        value = item.value if item.__class__ is YamlScalar else None
        if not (value.__class__ is float or value.__class__ is int) or not least <= value <= most:
            return ()
        numbers.append(float(value))
    return tuple(numbers)


def si_number(node: YamlNode, measure: Measure) -> float | Refusal:
    """Return the number that a node says, in SI units, or why it says none that the measure admits."""
    value = node.value if isinstance(node, YamlScalar) else None
    if isinstance(value, float):
        return _in_bound(node, value, measure)
    if isinstance(value, str):
        value = parse_quantity(value)
    if isinstance(value, Quantity):
        return _of_quantity(node, value, measure)
    if isinstance(value, bool) or not isinstance(value, int):
        return _no_number(node, measure)
    return _in_bound(node, as_float(value), measure)


def as_float(value: float) -> float:
    """Return an integer's nearest double, infinite where it is beyond one."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


_LONGEST_ROW = 200
"""So many characters has a row of numbers that is written anew as a whole."""


def doubted(node: YamlNode, number: float) -> dict[str, str]:
    """Return the facts of what `doubt` returns; those but `found` are for a file that can say no unit.

    There a row such as `rpy="0 90 -90"` is one text, so all of it is told at once, by the number furthest from 0.
    """
    row = _row_at(node) or (number,)
    number = max(row, key=abs)
    return {
        "found": number_text(number),
        "thousandth": " ".join(number_text(each / 1000) for each in row),
        "turns": f"{abs(number) / math.tau:.3g}",
        "of_degrees": " ".join(f"{math.radians(each):.6g}" for each in row),
    }


def _row_at(node: YamlNode) -> tuple[float, ...]:
    """Return the numbers of the attribute in which a node stands; none where it is no XML, or holds anything else."""
    span = node.span
    # Each number of a row asks for the whole of it: a hostile one of thousands is not read as often.
    if not span.file.is_xml or span.end_column - span.column > _LONGEST_ROW:
        return ()
    words = (span.text or "").split()
    values = [scalar_value(word) for word in words]
    numbers = [as_float(value) for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    return tuple(numbers) if len(numbers) == len(words) and all(map(math.isfinite, numbers)) else ()


def doubt(node: YamlNode, number: float, measure: Measure) -> Code | None:
    """Return the warning for a number that is likely meant in degrees or millimetres, None for every other."""
    size = abs(number)
    if measure.may_be_far or not size > _DOUBTED_BEYOND.get(measure.dimensions, math.inf):
        return None
    if measure.dimensions == _ANGLE:
        if node.span.file.is_xml:
            return WIDE_ANGLE if _MOST_TURNED < size < _UNBOUNDED else None
        return WIDE_ANGLE if isinstance(node, YamlScalar) and isinstance(node.value, int | float) else None
    return LONG_LENGTH


def found(node: YamlNode) -> str:
    """Return what stands at a node as messages show it: numbers as they are, text in quotes."""
    match node:
        case YamlScalar(value=Quantity() as quantity):
            return f"'{quantity}'"
        case YamlScalar(text=text, value=int() | float() as value) if not isinstance(value, bool):
            return text
        case YamlScalar(text=text, value=str()) if isinstance(scalar_value(text), int | float):
            return f"the text '{text}'"
        case YamlScalar(text=text):
            return f"'{text}'"
        case YamlList():
            return "a list"
        case YamlMap():
            return "a map"
        case _:
            return "nothing"


def _of_quantity(node: YamlNode, quantity: Quantity, measure: Measure) -> float | Refusal:
    if quantity.dimension not in measure.dimensions:
        other = _WORDS[quantity.dimension][0]
        return Refusal(WRONG_DIMENSION, {"expected": measure.words, "found": found(node), "other": other})
    return _in_bound(node, quantity.value, measure)


def _in_bound(node: YamlNode, number: float, measure: Measure) -> float | Refusal:
    if not math.isfinite(number):
        return Refusal(NOT_FINITE, {"found": found(node)})
    if measure.bound and not measure.bound.holds(number):
        meant = (
            f"; write '{found(node)} deg' if degrees are meant" if doubt(node, number, measure) is WIDE_ANGLE else ""
        )
        return Refusal(OUT_OF_RANGE, {"bound": measure.bound.words + measure.si_unit, "found": found(node) + meant})
    return number


def _no_number(node: YamlNode, measure: Measure) -> Refusal:
    unit = unit_text(node.text) if isinstance(node, YamlScalar) and isinstance(node.value, str) else None
    if unit is None or not isinstance(node, YamlScalar) or not measure.dimensions:
        return Refusal(WRONG_KIND, {"expected": measure.words, "found": found(node)})
    known = tuple(name for dimension in measure.dimensions for name in units_of(dimension))
    meant = suggested_unit(unit)
    if meant and meant.dimension in measure.dimensions:
        hint = f"; write '{node.text.strip().removesuffix(unit).rstrip()} {meant.name}'"
        return Refusal(UNKNOWN_UNIT, {"expected": measure.words, "name": unit, "hint": hint})
    return Refusal(UNKNOWN_UNIT, {"expected": measure.words, "name": unit, "hint": ""}, known)


_WORD = re.compile(r"(?:\$\([^()]*(?:\([^()]*\)[^()]*)*\)|[^\s$])+")
"""One of the numbers of a row that was written as one text: what holds no space, or an expression."""


def list_meant(node: YamlNode, counts: tuple[int, ...]) -> str | None:
    """Return the list that a row of numbers in one text was meant for, to be put behind "takes"; None for no row."""
    words = _WORD.findall((node.span.text or "").strip("'\"")) if isinstance(node, YamlScalar) else []
    if len(words) not in counts or len(words) < 2:
        return None
    # A comma or bracket in an expression would end the item of the list.
    items = [f'"{word}"' if any(mark in word for mark in ",[]{}") else word for word in words]
    return f"a list such as [{', '.join(items)}]"
