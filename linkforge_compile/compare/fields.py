"""Which fields of a part are compared, under which key, in which form and in which unit."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from decimal import Decimal
from typing import NamedTuple

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.fields import Number, Spec, Vector, field_specs
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Part
from linkforge_compile.formats.raw import elements_of, plain_text
from linkforge_compile.formats.xml_text import XML_BLANKS
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.units import POSITION, Dimension, FieldUnit, Motion

_KEYS = {
    "chains": "chain",
    "ros2_controls": "ros2_control",
    "gazebo_elements": "gazebo",
    "extra_elements": "extra",
}
"""Keys in paths of fields whose spec has no key, or a different one."""
_STATED_FIELDS = frozenset({"stated", "interfaces_stated", "version_stated"})
"""Fields that name the fields written with their default; `stated_differences` compares them."""

_NO_FIELDS: Mapping[type, Collection[str]] = {}


@dataclass(frozen=True)
class RawElement:
    """An element of raw XML; `written` is all of it as text.

    `texts` are the texts before, between and after its child elements: at least one, without blank ones at the end.
    """

    tag: str
    attributes: Mapping[str, str]
    texts: tuple[str, ...]
    children: tuple[RawElement, ...]
    written: str = field(compare=False)

    @property
    def name(self) -> str | None:
        return self.attributes.get("name")


def raw_parts(texts: Iterable[str]) -> tuple[RawElement | str, ...]:
    """Parse texts of raw XML into elements; keep a text that is not well-formed as it is."""
    return tuple(part for text in texts for part in _parsed(text))


def _parsed(text: str) -> tuple[RawElement | str, ...]:
    try:
        return tuple(map(_raw_element, elements_of(text)))
    except RobotGeneratorError:
        return (text,)


def _raw_element(element: XmlElement) -> RawElement:
    children = tuple(map(_raw_element, element.children))
    return RawElement(element.tag, dict(element.values), _texts(element), children, plain_text(element))


def _texts(element: XmlElement) -> tuple[str, ...]:
    runs: list[list[str]] = [[]]
    for item in element.content:
        if isinstance(item, XmlElement):
            runs.append([])
        elif isinstance(item, str):
            runs[-1].append(item)
    texts = ["".join(run).strip(XML_BLANKS) for run in runs]
    while len(texts) > 1 and not texts[-1]:
        texts.pop()
    return tuple(texts)


def specs_of(kind: type) -> Mapping[str, Spec]:
    """Return the specs of the class of an element or link; none for other classes."""
    return field_specs(kind) if issubclass(kind, Part | Link) else {}


def key_of_field(kind: type, name: str) -> str:
    """Return the key of the language for a field of a class."""
    spec = specs_of(kind).get(name)
    return _KEYS.get(name) or (spec.key if spec else "") or name


def is_part(value: object) -> bool:
    """Whether a value has fields to compare."""
    return isinstance(value, Interface) or (is_dataclass(value) and not isinstance(value, type))


def compared_fields(part: object) -> tuple[str, ...]:
    """Return the names of the fields of a part that are compared."""
    if isinstance(part, Interface):
        return "parameters", "extra_attributes", "extra_elements", "extra_inside"
    assert is_dataclass(part)
    own = (one.name for one in fields(part) if one.compare and not one.name.startswith("_"))
    return tuple(name for name in own if name not in _STATED_FIELDS)


def compared_value(part: object, name: str) -> object:
    """Return the value of a field in the form that is compared: raw XML parsed, attributes as a mapping."""
    value = getattr(part, name)
    match name:
        case "command_interfaces" | "state_interfaces":
            return tuple(map(Interface.of, value))
        case "extra_attributes":
            return dict(value)
        case "extra_elements":
            return raw_parts(value)
    return value


def match_key(value: object, without: Mapping[type, Collection[str]] = _NO_FIELDS) -> Hashable:
    """Return a hashable key that equal values share, ignoring the fields `without`, by class."""
    if isinstance(value, Mapping):
        return frozenset((name, match_key(item, without)) for name, item in value.items())
    if is_part(value):
        ignored = without.get(type(value), ())
        keys = (
            match_key(compared_value(value, name), without) for name in compared_fields(value) if name not in ignored
        )
        return type(value).__name__, str(value) if isinstance(value, Interface) else "", *keys
    if isinstance(value, Sequence) and not isinstance(value, str):
        return tuple(match_key(item, without) for item in value)
    if isinstance(value, bool):
        return "bool", value  # True == 1 in Python
    return value if isinstance(value, str | int | float | None) else repr(value)


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
    number = float(text) if _XML_NUMBER.fullmatch(text.strip(XML_BLANKS)) else math.inf
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
