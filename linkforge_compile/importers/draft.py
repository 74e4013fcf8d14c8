"""The draft of a spec: nodes with the spans of the XML that they say, and of which element each of them was made."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import KEPT_RAW
from linkforge_compile.importers.prefixed import NO_SHAPES, Shapes
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import Bounds, XmlAttribute, XmlElement
from linkforge_compile.syntax import (
    ScalarValue,
    YamlEntry,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    scalar_value,
    word_value,
)
from linkforge_compile.units import UNITS, WIDEST_ANGLE, Dimension, number_text

_NUMBER = re.compile(r"[+-]?(?:[0-9]{1,400}(?:\.[0-9]{0,400})?|\.[0-9]{1,400})(?:[eE][+-]?[0-9]{1,4})?")
_TIDY = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
"""How a person spells a number; other spellings are spelled anew."""

_DEGREES = {Dimension.ANGLE: "deg", Dimension.ANGULAR_VELOCITY: "deg/s"}
_MOST_DECIMALS = 3
"""So many digits behind the point may an angle in degrees have: more is no round angle, but a coincidence."""

_TIMES_DRAFTED = 2
"""How often a value is counted, at most, of which the spec holds one.

An element that has been read counts for no more than its node holds. Counted a second time is what moves from one map
to another, which a value does once: a block of Gazebo to its link, the parts of a joint to a frame; and collisions
that are not written, for they are as the visuals, until their link has been read.
"""


Where: TypeAlias = Span | XmlAttribute | XmlElement | YamlNode
"""A span, or whatever the place of a node is that of."""


class DeclinedError(Exception):
    """The language has no form in which an element would come back as it is, so it stays raw; says why, and where."""

    def __init__(self, reason: str, span: Span) -> None:
        self.reason, self.span = reason, span
        super().__init__(reason)


class Draft:
    """Makes the nodes of one spec.

    `keys` has the node that stands for an element in the text, a key or an item of a list; `bodies` what is under
    it; `raw` the elements that are kept as they stand, and `told` what is to be told of the import. `refused` are
    elements, by their spans, that are known to be no use to the language, and why. `has_quaternions` says whether
    the document is of a version of URDF whose readers take them; the others ignore them. `shapes` are the robot's.
    `at_fault` are the elements in which an error has been told: what of them cannot be read is at fault, not raw.
    `size` is how many values there are, keys among them: what cannot but have too many ends where it gets there.
    """

    def __init__(
        self,
        refused: Mapping[Span, DeclinedError] = MappingProxyType({}),
        *,
        has_quaternions: bool = False,
        shapes: Shapes = NO_SHAPES,
        at_fault: Collection[XmlElement] = (),
    ) -> None:
        self._most = Budget(times=_TIMES_DRAFTED).left(Limit.VALUES)
        self.size = 0
        self.refused = refused
        self.at_fault = at_fault
        self.has_quaternions = has_quaternions
        self.shapes = shapes
        self.keys: dict[XmlElement, YamlNode] = {}
        self.bodies: dict[XmlElement, YamlNode] = {}
        self.raw: set[XmlElement] = set()
        self.told: list[Diagnostic] = []
        self._elements: dict[YamlNode, list[XmlElement]] = {}
        # A robot says the same numbers again and again.
        self._numbers: dict[tuple[str, Dimension | None], tuple[str, ScalarValue] | None] = {}

    def tell(self, sink: Diagnostics) -> None:
        """Report what is to be told; what is kept raw for the same reason at many places is told at the first."""
        alike: dict[str, list[Diagnostic]] = {}
        for number, one in enumerate(self.told):
            kind = f"{one.severity} {one.message}" if one.code is KEPT_RAW else str(number)
            alike.setdefault(kind, []).append(one)
        for first, *others in alike.values():
            more = [Note(f"and {len(others)} more like this, the next one here", others[0].span)] if others else []
            sink.report(replace(first, notes=(*first.notes, *more)))

    # Scalars

    def text(self, text: str, where: Where) -> YamlScalar:
        """Return text in which nothing is an expression."""
        escaped = text.replace("$(", "$$(")
        return YamlScalar(escaped, escaped, *_bounds(where))

    def word(self, text: str, where: Where) -> YamlScalar:
        """Return text that a plugin reads: without quotes where that is the same text."""
        escaped = text.replace("$(", "$$(")
        return YamlScalar(escaped, word_value(escaped), *_bounds(where))

    def number(self, text: str, where: Where, unit: Dimension | None = None) -> YamlScalar | None:
        """Return a number as it is written, None for what is none, or none that a double can hold.

        An angle is in degrees where that is exactly the same double, and says `rad` where it would be taken for
        degrees.
        """
        asked = text, unit
        if asked not in self._numbers:
            self._numbers[asked] = _spelled(text, unit)
        spelled = self._numbers[asked]
        return YamlScalar(spelled[0], spelled[1], *_bounds(where)) if spelled else None

    # Lists and maps

    def list_of(self, items: Iterable[YamlNode], where: Where) -> YamlList:
        """Return a list; each item stands for the element that it was made from."""
        kept = tuple(items)
        for item in kept:
            for element in self._elements.get(item, ()):
                self.keys[element] = item
        return YamlList(kept, *_bounds(where))

    def map_of(self, entries: Mapping[str, YamlNode | None], where: Where) -> YamlMap:
        """Return a map without the entries of None; each key stands for the element that its value was made from."""
        made: dict[str, YamlEntry] = {}
        for name, node in entries.items():
            if node is not None:
                self._put(made, self.text(name, node), node)
        return YamlMap(made, *_bounds(where))

    def named(self, entries: Mapping[str, tuple[XmlAttribute, YamlNode]], where: Where) -> YamlMap | None:
        """Return a map keyed by names that stand in the file, None for an empty one."""
        made: dict[str, YamlEntry] = {}
        for name, (attribute, node) in entries.items():
            self._put(made, self.text(name, attribute), node)
        return YamlMap(made, *_bounds(where)) if made else None

    def _put(self, made: dict[str, YamlEntry], key: YamlScalar, node: YamlNode) -> None:
        made[key.text] = YamlEntry(key, node)
        for element in self._elements.get(node, ()):
            self.keys[element] = key
        self.size += 2 + (len(node) if isinstance(node, YamlList) else 0)
        if self.size > self._most:
            raise Budget().beyond(Limit.VALUES, node.span)

    def one_or_list(self, items: list[YamlNode]) -> YamlNode | None:
        """Return nothing, one thing, or a list of them."""
        if not items:
            return None
        return items[0] if len(items) == 1 else self.list_of(items, items[0].span)

    def made(self, node: YamlNode, *elements: XmlElement) -> None:
        """Note which elements a node says."""
        self._elements.setdefault(node, []).extend(elements)
        for element in elements:
            self.bodies[element] = node

    def stands_for(self, node: YamlNode, *others: YamlNode) -> None:
        """Note that a node says what was made into others."""
        self.made(node, *(element for other in others for element in self._elements.get(other, ())))


def _bounds(where: Where) -> Bounds:
    """Return where a node stands; its span is computed as somebody asks for it, which few do."""
    match where:
        case XmlAttribute() | XmlElement():
            return where.bounds
        case YamlScalar() | YamlList() | YamlMap() if where.end is not None:
            return where.place, where.begin, where.end
        case Span():
            return where, 0, 0
        case _:
            return where.span, 0, 0


def _spelled(text: str, unit: Dimension | None) -> tuple[str, ScalarValue] | None:
    """Return how a number is written, and what that is in YAML; None for what is none."""
    value = number_of(text)
    if value is None:
        return None
    digits = text.strip() if _TIDY.fullmatch(text.strip()) else number_text(value)
    if not value:
        digits = digits.removeprefix("-")
    if unit in _DEGREES and (degrees := _degrees(value, _DEGREES[unit])):
        return degrees, degrees
    if unit is Dimension.ANGLE and abs(value) > WIDEST_ANGLE:
        return f"{digits} rad", f"{digits} rad"
    return digits, scalar_value(digits)


def number_of(text: str) -> float | None:
    """Return the number that the whole text is, None where it is none or beyond a double."""
    stripped = text.strip()
    if not _NUMBER.fullmatch(stripped):
        return None
    value = float(stripped)
    return value if math.isfinite(value) else None


def values_in(node: YamlNode) -> int:
    """Return how many values a node holds, keys among them."""
    match node:
        case YamlMap():
            return sum([2 + values_in(entry.value) for entry in node])
        case YamlList():
            return sum([1 + values_in(item) for item in node])
        case _:
            return 0


def same(one: YamlNode | None, other: YamlNode | None) -> bool:
    """Whether two nodes say the same: numbers by their value, all else by its text."""
    match one, other:
        case None, None:
            return True
        case YamlScalar(), YamlScalar():
            numbers = [node.value for node in (one, other) if type(node.value) in (int, float)]
            return numbers[0] == numbers[1] if len(numbers) == 2 else one.text == other.text
        case YamlList(), YamlList():
            return len(one) == len(other) and all(map(same, one, other))
        case YamlMap(), YamlMap():
            return one.entries.keys() == other.entries.keys() and all(
                same(entry.value, other.entries[name].value) for name, entry in one.entries.items()
            )
        case _:
            return False


def _degrees(value: float, unit: str) -> str | None:
    """Return a round angle in degrees that is exactly this many radians, None where there is none."""
    if not value:
        return None
    for decimals in range(_MOST_DECIMALS + 1):
        digits = number_text(round(math.degrees(value), decimals))
        if UNITS[unit].to_si(digits) == value:
            return f"{digits} {unit}"
    return None
