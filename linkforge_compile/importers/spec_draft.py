"""Build the nodes of an imported spec, and remember which XML elements each node came from."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import ENDS_IN_A_BLANK, FOUND_PATH_OF_THIS_MACHINE, KEPT_RAW
from linkforge_compile.importers.package_paths import NO_PACKAGE_PATHS, PackagePaths
from linkforge_compile.importers.raw_xml import NO_SHAPES, Shapes
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
_TIDY_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
"""Spellings of a number that a spec keeps; others are normalized."""

_DEGREES = {Dimension.ANGLE: "deg", Dimension.ANGULAR_VELOCITY: "deg/s"}
_MAX_DECIMALS = 3
"""Decimals that an angle in degrees may have; with more it is not a round angle but a coincidence."""

_TIMES_DRAFTED = 2
"""How often a value of the spec may be counted in `size`.

An element that has been read counts for what its node holds. A value that moves to another map is counted twice: a
Gazebo block to its link, parts of a joint to a frame. So are collisions that repeat the visuals, until their link has
been read.
"""

Where: TypeAlias = Span | XmlAttribute | XmlElement | YamlNode
"""A span, or something with one."""


_GROUPED = (KEPT_RAW, ENDS_IN_A_BLANK, FOUND_PATH_OF_THIS_MACHINE)
"""Codes of which reports with the same words are one."""


class CannotRepresentError(Exception):
    """The language has no form that gives an element back as it is, so it is kept raw; `span` is the reason's place."""

    def __init__(self, reason: str, span: Span) -> None:
        self.reason, self.span = reason, span
        super().__init__(reason)


class SpecDraft:
    """Builds the nodes of one spec.

    `refused` has elements that the language refuses, and why. `has_quaternions` is whether the URDF is
    of a version that has them; readers of others ignore them. `shapes` are the robot's. In the elements `at_fault` an
    error has been reported; what cannot be represented of them becomes a YamlFault, not raw XML. `is_urdf` is whether
    urdfdom reads the document. `renamed` has the names that are replaced, which raw XML still has;
    `package_paths` finds the folders of packages in texts. `outside` are the names
    of parts of others that the spec is merged with; it is a template then.

    `keys` has the key or list item of each element, `bodies` the node below it, `raw` the elements that are kept raw,
    `diagnostics` the reports of the import. `size` is the number of values so far, counting keys.
    """

    def __init__(
        self,
        refused: Mapping[XmlElement, CannotRepresentError] = MappingProxyType({}),
        *,
        has_quaternions: bool = False,
        shapes: Shapes = NO_SHAPES,
        at_fault: Collection[XmlElement] = (),
        is_urdf: bool = False,
        renamed: Mapping[str, str] = MappingProxyType({}),
        package_paths: PackagePaths = NO_PACKAGE_PATHS,
        outside: Collection[str] | None = None,
    ) -> None:
        self._max_size = Budget(times=_TIMES_DRAFTED).left(Limit.VALUES)
        self.size = 0
        self.refused = refused
        self.at_fault = at_fault
        self.is_urdf = is_urdf
        self.renamed = renamed
        self.package_paths = package_paths
        self.is_template, self.outside = outside is not None, frozenset(outside or ())
        self.has_quaternions = has_quaternions
        self.shapes = shapes
        self.keys: dict[XmlElement, YamlNode] = {}
        self.bodies: dict[XmlElement, YamlNode] = {}
        self.raw: set[XmlElement] = set()
        self.diagnostics: list[Diagnostic] = []
        self._elements: dict[YamlNode, list[XmlElement]] = {}
        # A robot repeats the same numbers thousands of times.
        self._numbers: dict[tuple[str, Dimension | None], tuple[str, ScalarValue] | None] = {}

    def report(self, sink: Diagnostics) -> None:
        """Report the diagnostics; those of `_GROUPED` with the same words are one, at the first place."""
        groups: dict[str, list[Diagnostic]] = {}
        for number, one in enumerate(self.diagnostics):
            key = f"{one.severity} {one.message}" if one.code in _GROUPED else str(number)
            groups.setdefault(key, []).append(one)
        for first, *others in groups.values():
            more = [Note(f"and {len(others)} more like this, the next one here", others[0].span)] if others else []
            sink.report(replace(first, notes=(*first.notes, *more)))

    # Scalars

    def text(self, text: str, where: Where) -> YamlScalar:
        """Return text in which nothing is an expression but the folders of packages."""
        escaped = self._escaped(text, where)
        return YamlScalar(escaped, escaped, *_bounds(where))

    def word(self, text: str, where: Where) -> YamlScalar:
        """Return text that a plugin reads, unquoted where YAML reads the same text."""
        escaped = self._escaped(text, where)
        return YamlScalar(escaped, word_value(escaped), *_bounds(where))

    def _escaped(self, text: str, where: Where) -> str:
        escaped, left = self.package_paths.in_expressions(text.replace("$(", "$$("))
        if left is not None:
            place, begin, end = _bounds(where)
            span = place if isinstance(place, Span) else place.between(begin, end)
            self.diagnostics.append(
                FOUND_PATH_OF_THIS_MACHINE.at(span, package=left.name, reason=_WHY_LEFT[left.is_near])
            )
        return escaped

    def number(self, text: str, where: Where, unit: Dimension | None = None) -> YamlScalar | None:
        """Return a number as it is written; None for a text that is no finite double.

        An angle becomes degrees where that gives exactly the same double, and gets the unit `rad` where a bare number
        would be taken for degrees.
        """
        if (text, unit) not in self._numbers:
            self._numbers[text, unit] = _spell_number(text, unit)
        spelling = self._numbers[text, unit]
        return YamlScalar(spelling[0], spelling[1], *_bounds(where)) if spelling else None

    # Lists and maps

    def list_of(self, items: Iterable[YamlNode], where: Where) -> YamlList:
        """Return a list; its items become the keys of their elements."""
        nodes = tuple(items)
        for node in nodes:
            for element in self._elements.get(node, ()):
                self.keys[element] = node
        return YamlList(nodes, *_bounds(where))

    def map_of(self, entries: Mapping[str, YamlNode | None], where: Where) -> YamlMap:
        """Return a map without the entries that are None; its keys become those of their values' elements."""
        made: dict[str, YamlEntry] = {}
        for name, node in entries.items():
            if node is not None:
                self._put(made, self.text(name, node), node)
        return YamlMap(made, *_bounds(where))

    def named(self, entries: Mapping[str, tuple[XmlAttribute, YamlNode]], where: Where) -> YamlMap | None:
        """Return a map whose keys have the spans of attributes; None for an empty one."""
        made: dict[str, YamlEntry] = {}
        for name, (attribute, node) in entries.items():
            self._put(made, self.text(name, attribute), node)
        return YamlMap(made, *_bounds(where)) if made else None

    def _put(self, made: dict[str, YamlEntry], key: YamlScalar, node: YamlNode) -> None:
        made[key.text] = YamlEntry(key, node)
        for element in self._elements.get(node, ()):
            self.keys[element] = key
        self.size += 2 + (len(node) if isinstance(node, YamlList) else 0)
        if self.size > self._max_size:
            raise Budget().beyond(Limit.VALUES, node.span)

    def one_or_list(self, items: list[YamlNode]) -> YamlNode | None:
        """Return None for no items, a single item, or a list of several."""
        if not items:
            return None
        return items[0] if len(items) == 1 else self.list_of(items, items[0].span)

    def note_source(self, node: YamlNode, *elements: XmlElement) -> None:
        """Note that a node was made from elements."""
        self._elements.setdefault(node, []).extend(elements)
        for element in elements:
            self.bodies[element] = node

    def note_same_source(self, node: YamlNode, *others: YamlNode) -> None:
        """Note that a node replaces others, and so was made from their elements."""
        self.note_source(node, *(element for other in others for element in self._elements.get(other, ())))


_WHY_LEFT = (
    "as that package is not found from the spec's folder",
    "as it does not begin the path of a file here; write \"$(path('package://...'))\" in the spec",
)
"""Why a folder of a package is in a spec, by whether the spec finds the package."""


def _bounds(where: Where) -> Bounds:
    """Return the place of a node; few of the spans are ever computed."""
    match where:
        case XmlAttribute() | XmlElement():
            return where.bounds
        case YamlScalar() | YamlList() | YamlMap() if where.end is not None:
            return where.place, where.begin, where.end
        case Span():
            return where, 0, 0
        case _:
            return where.span, 0, 0


def _spell_number(text: str, unit: Dimension | None) -> tuple[str, ScalarValue] | None:
    """Return how a spec writes a number, and what YAML reads there; None for a text that is no number."""
    value = number_of(text)
    if value is None:
        return None
    digits = text.strip() if _TIDY_NUMBER.fullmatch(text.strip()) else number_text(value)
    if not value:
        digits = digits.removeprefix("-")
    if unit in _DEGREES and (degrees := in_degrees(value, _DEGREES[unit])):
        return degrees, degrees
    if unit is Dimension.ANGLE and abs(value) > WIDEST_ANGLE:
        return f"{digits} rad", f"{digits} rad"
    return digits, scalar_value(digits)


def number_of(text: str) -> float | None:
    """Return the number that a whole text spells; None for other texts and for what no double can hold."""
    stripped = text.strip()
    if not _NUMBER.fullmatch(stripped):
        return None
    value = float(stripped)
    return value if math.isfinite(value) else None


def in_degrees(value: float, unit: str) -> str | None:
    """Return a round angle in degrees that equals the radians exactly; None where there is none."""
    if not value:
        return None
    for decimals in range(_MAX_DECIMALS + 1):
        digits = number_text(round(math.degrees(value), decimals))
        if UNITS[unit].to_si(digits) == value:
            return f"{digits} {unit}"
    return None


def values_in(node: YamlNode) -> int:
    """Count the values in a node, counting keys."""
    match node:
        case YamlMap():
            return sum([2 + values_in(entry.value) for entry in node])
        case YamlList():
            return sum([1 + values_in(item) for item in node])
        case _:
            return 0


def is_same(one: YamlNode | None, other: YamlNode | None) -> bool:
    """Whether two nodes mean the same: numbers are compared by value, other scalars by text."""
    match one, other:
        case None, None:
            return True
        case YamlScalar(), YamlScalar():
            numbers = [node.value for node in (one, other) if type(node.value) in (int, float)]
            return numbers[0] == numbers[1] if len(numbers) == 2 else one.text == other.text
        case YamlList(), YamlList():
            return len(one) == len(other) and all(map(is_same, one, other))
        case YamlMap(), YamlMap():
            return one.entries.keys() == other.entries.keys() and all(
                is_same(entry.value, other.entries[name].value) for name, entry in one.entries.items()
            )
        case _:
            return False
