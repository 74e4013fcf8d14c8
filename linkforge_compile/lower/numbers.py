"""Convert YAML scalars to numbers in SI units, or say why they are not what their field accepts."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import dataclass, field
from functools import cache

from linkforge_compile.core.fields import ABOVE_ZERO, ZERO_TO_ONE, Bound
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
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar, scalar_value
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
    Dimension.ACCELERATION: ("an acceleration", "0.5 m/s^2"),
    Dimension.ANGULAR_ACCELERATION: ("an angular acceleration", "180 deg/s^2"),
    Dimension.JERK: ("a jerk", "5 m/s^3"),
    Dimension.ANGULAR_JERK: ("an angular jerk", "1000 deg/s^3"),
}
"""The name of each dimension in messages, and an example of a value."""

_WIDEST_URDF_ANGLE, _UNLIMITED_URDF_ANGLE = 8 * math.pi, 1e4
"""Angles of URDF files [rad] between these are suspicious; vendors write limits of 10, and of 1e16 for none."""

_ANGLE, _LENGTH = (Dimension.ANGLE,), (Dimension.LENGTH,)
_LARGEST_PLAUSIBLE: dict[tuple[Dimension, ...], float] = {_ANGLE: WIDEST_ANGLE, _LENGTH: 30.0}
"""Larger numbers [rad], [m] are probably degrees or millimetres; the track of a published cart is 30 m long."""

_UNLIMITED_LENGTH, _NO_LIMIT = 1e5, (9_999.0, 99_999.0)
"""A length [m] that even in millimetres is none of a robot's, and others that vendors write where there is no limit."""


class NumberType:
    """The numbers that a field accepts: bare ones, and quantities of one of `dimensions`.

    A length of more than 30 m is suspicious, unless it `may_be_far`. Bare numbers from `least` to `most` are in the
    bound and not suspicious.
    """

    def __init__(
        self, dimensions: tuple[Dimension, ...] = (), bound: Bound | None = None, *, may_be_far: bool = False
    ) -> None:
        self.dimensions, self.bound, self.may_be_far = dimensions, bound, may_be_far
        largest = sys.float_info.max if may_be_far else _LARGEST_PLAUSIBLE.get(dimensions, sys.float_info.max)
        self.least = max(-largest, bound.least) if bound else -largest
        self.most = min(largest, bound.most) if bound else largest

    @property
    def words(self) -> str:
        """What to write, as in "mass takes a mass such as '3 kg'"."""
        if not self.dimensions:
            return "a bare number"
        return " or ".join("{} such as '{}'".format(*_WORDS[dimension]) for dimension in self.dimensions)

    @property
    def si_unit(self) -> str:
        """The unit of a bare number as " m"; empty where it has none, or one of several."""
        return f" {self.dimensions[0].si_unit}" if len(self.dimensions) == 1 else ""


@cache
def number_type(unit: FieldUnit, bound: Bound | None, motion: Motion, may_be_far: bool = False) -> NumberType:
    """Return the numbers that a field of a model class accepts, on a joint of this motion."""
    return NumberType(unit.dimensions(motion), bound, may_be_far=may_be_far)


BARE = NumberType()
FRACTION = NumberType(bound=ZERO_TO_ONE)
LENGTH = NumberType(_LENGTH)
EXTENT = NumberType(_LENGTH, ABOVE_ZERO)
EXTENT_OF_GROUND = NumberType(_LENGTH, ABOVE_ZERO, may_be_far=True)
ANGLE = NumberType(_ANGLE)
ANGLE_OR_LENGTH = NumberType((*_ANGLE, *_LENGTH))
"""The position of a joint of unknown type: it turns [rad] or slides [m]."""


@dataclass(frozen=True)
class Refusal:
    """Why a node is not a number that its field accepts; `facts` lack the name of the field."""

    code: Code
    facts: dict[str, str] = field(default_factory=dict)
    near: tuple[str, ...] = ()


def si_number(node: YamlNode, accepted: NumberType) -> float | Refusal:
    """Return the number at a node in SI units, or why it is not accepted."""
    value = node.value if isinstance(node, YamlScalar) else None
    if isinstance(value, str):
        value = parse_quantity(value)
    if isinstance(value, Quantity):
        if value.dimension in accepted.dimensions:
            return _in_bound(node, value.value, accepted)
        other = _WORDS[value.dimension][0]
        return Refusal(WRONG_DIMENSION, {"expected": accepted.words, "found": describe_node(node), "other": other})
    if isinstance(value, bool) or not isinstance(value, int | float):
        return _no_number(node, accepted)
    return _in_bound(node, as_float(value), accepted)


def as_float(value: float) -> float:
    """Return the nearest double, infinite for an integer that exceeds all of them."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


_LONGEST_ROW = 200  # characters of an attribute that a message shows converted


def suspicion_facts(node: YamlNode, number: float) -> dict[str, str]:
    """Return the facts for a diagnostic about a `suspicious_unit`; all but `found` are for XML, which has no units.

    An attribute such as `rpy="0 90 -90"` is reported as a whole, with its number furthest from 0.
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
    """Return the numbers of the XML attribute that a node is part of; none in YAML, or with other words in it."""
    span = node.span
    # Each number of the attribute leads here, so a long attribute would take quadratic time.
    if not span.file.is_xml or span.end_column - span.column > _LONGEST_ROW:
        return ()
    words = (span.text or "").split()
    values = [scalar_value(word) for word in words]
    numbers = [as_float(value) for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    return tuple(numbers) if len(numbers) == len(words) and all(map(math.isfinite, numbers)) else ()


def suspicious_unit(node: YamlNode, number: float, accepted: NumberType) -> Code | None:
    """Return the warning for a number that is probably in degrees or millimetres, None for any other."""
    size = abs(number)
    if accepted.may_be_far or not size > _LARGEST_PLAUSIBLE.get(accepted.dimensions, math.inf):
        return None
    if accepted.dimensions != _ANGLE:
        return LONG_LENGTH if size < _UNLIMITED_LENGTH and size not in _NO_LIMIT else None
    if node.span.file.is_xml:
        return WIDE_ANGLE if _WIDEST_URDF_ANGLE < size < _UNLIMITED_URDF_ANGLE else None
    return WIDE_ANGLE if isinstance(node, YamlScalar) and isinstance(node.value, int | float) else None


def describe_node(node: YamlNode) -> str:
    """Return a node as messages show it: a number as written, text in quotes, the kind of a collection."""
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


def _in_bound(node: YamlNode, number: float, accepted: NumberType) -> float | Refusal:
    if not math.isfinite(number):
        return Refusal(NOT_FINITE, {"found": describe_node(node)})
    if accepted.bound and not accepted.bound.holds(number):
        found = describe_node(node)
        facts = {"bound": accepted.bound.words + accepted.si_unit, "found": found}
        if suspicious_unit(node, number, accepted) is WIDE_ANGLE:
            facts |= {"written": found, "instead": f"{found} deg"}
            facts["found"] = f"{found}; write '{found} deg' if you mean degrees"
        return Refusal(OUT_OF_RANGE, facts)
    return number


def _no_number(node: YamlNode, accepted: NumberType) -> Refusal:
    unit = unit_text(node.text) if isinstance(node, YamlScalar) and isinstance(node.value, str) else None
    if unit is None or not isinstance(node, YamlScalar) or not accepted.dimensions:
        return Refusal(WRONG_KIND, {"expected": accepted.words, "found": describe_node(node)})
    known = tuple(name for dimension in accepted.dimensions for name in units_of(dimension))
    similar = suggested_unit(unit)
    if similar and similar.dimension in accepted.dimensions:
        instead = f"{node.text.strip().removesuffix(unit).rstrip()} {similar.name}"
        facts = {"expected": accepted.words, "name": unit, "hint": f"; write '{instead}'"}
        return Refusal(UNKNOWN_UNIT, {**facts, "written": node.text, "instead": instead})
    return Refusal(UNKNOWN_UNIT, {"expected": accepted.words, "name": unit, "hint": ""}, known)


_WORD = re.compile(r"(?:\$\([^()]*(?:\([^()]*\)[^()]*)*\)|[^\s$])+")
"""A word of a text without spaces, or with them in an expression."""


def suggested_list(node: YamlNode, counts: tuple[int, ...]) -> str | None:
    """Return the list to write in place of a text such as "0 0 1", for a message; None for any other node."""
    words = _WORD.findall((node.span.text or "").strip("'\"")) if isinstance(node, YamlScalar) else []
    if len(words) not in counts or len(words) < 2:
        return None
    # A comma or bracket in an expression would end the item of the list.
    items = [f'"{word}"' if any(mark in word for mark in ",[]{}") else word for word in words]
    return f"a list such as [{', '.join(items)}]"
