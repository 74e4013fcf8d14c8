"""Build the nodes of a spec from values of a robot: without what the language implies, or with all of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol, TypeVar

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Element, FreePart, Inside
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, word_value
from linkforge_compile.units import Dimension, number_text

Node = TypeVar("Node", bound=YamlNode)

_NOWHERE = SourceFile("<robot>", "").whole
_WHOLE_TURN = 2 * math.pi  # [rad]


class Extended(Protocol):
    """A part of the robot with its source and its extras."""

    @property
    def source(self) -> SourceRef | None: ...
    @property
    def extra_attributes(self) -> Sequence[tuple[str, str]] | Mapping[str, str]: ...
    @property
    def extra_elements(self) -> Sequence[str]: ...


class Written(NamedTuple):
    """Where the value of a node was written: in the object that `source` points to, at the path `field`."""

    source: SourceRef
    field: tuple[str, ...] = ()


class SpecBuilder:
    """Builds the nodes of one spec, and remembers their sources.

    A `full` spec has every value in its long form, defaults too; `explain` looks up paths in it.
    `written` has the source of each value, `parts` the source of each name whose origin a comment shows, `units` the
    dimension of each number with one.
    """

    def __init__(self, *, full: bool = False) -> None:
        self.full = full
        self.written: dict[YamlNode, Written] = {}
        self.parts: dict[YamlNode, SourceRef] = {}
        self.units: dict[YamlNode, Dimension] = {}

    # Scalars: None for a value that is None or, unless the spec is full, equal to its default

    def text(self, value: str | None, default: str | None = None) -> YamlScalar | None:
        return None if value is None or self._is_left_out(value, default) else _text(value)

    def flag(self, value: bool | None, default: bool | None = None) -> YamlScalar | None:
        if value is None or self._is_left_out(value, default):
            return None
        return YamlScalar(str(bool(value)).lower(), bool(value), _NOWHERE)

    def number(
        self, value: float | None, unit: Dimension | None = None, *, default: float | None = None
    ) -> YamlScalar | None:
        return None if value is None or self._is_left_out(value, default) else self.quantity(value, unit)

    def quantity(self, value: float, unit: Dimension | None = None) -> YamlScalar:
        """Return a number that is never left out, in the SI unit of its dimension."""
        digits = number_text(value)
        if unit is Dimension.ANGLE and abs(value) > _WHOLE_TURN and not self.full:
            # A bare number of that size causes a warning, because it may be in degrees.
            return _text(f"{digits} rad")
        node = YamlScalar(digits, value, _NOWHERE)
        if unit is not None:
            self.units[node] = unit
        return node

    def word(self, value: str | None) -> YamlScalar:
        """Return a text that is never left out: null for None."""
        return YamlScalar("null", None, _NOWHERE) if value is None else _text(value)

    # Lists and maps

    def numbers(self, values: Iterable[float], unit: Dimension | None = None) -> YamlList:
        return self.list_of(self.quantity(value, unit) for value in values)

    def texts(self, values: Iterable[str]) -> YamlList | None:
        """Return a list of texts, None for an empty one."""
        return self.list_of(map(_text, values)) if values else None

    def list_of(self, items: Iterable[YamlNode]) -> YamlList:
        return YamlList(tuple(items), _NOWHERE)

    def map_of(self, entries: Mapping[str, YamlNode | None]) -> YamlMap:
        """Return a map without the entries of None."""
        made = {key: YamlEntry(_text(key), node) for key, node in entries.items() if node is not None}
        return YamlMap({_escaped(key): entry for key, entry in made.items()}, _NOWHERE)

    def element(self, part: Extended, /, **entries: YamlNode | None) -> YamlMap:
        """Return the object of a part: these entries, then its extras."""
        inside = part.extra_inside if isinstance(part, Element | Inside | Interface) else ()
        inside_nodes = ((one.key, self.element(one)) for one in inside)
        node = self.map_of(
            {
                **entries,
                "extra": self._raw(part.extra_elements),
                "extra_attributes": self.free(dict(part.extra_attributes)) if part.extra_attributes else None,
                "extra_inside": self.named("element", inside_nodes, with_origins=False),
            }
        )
        return self.located(node, part.source)

    def alone(self, node: YamlMap, key: str) -> YamlNode:
        """Return the short form of an object with this key only: its value; the object if it has more, or is full."""
        return node.entries[key].value if not self.full and node.entries.keys() == {key} else node

    def named(self, kind: str, parts: Iterable[tuple[str, YamlNode]], *, with_origins: bool = True) -> YamlMap | None:
        """Return a map keyed by names, None for an empty one; comments show origins of its parts if `with_origins`.

        Raises:
            RobotGeneratorError: for two parts with the same name.

        """
        nodes: dict[str, YamlNode] = {}
        for name, node in parts:
            if name in nodes:
                raise RobotGeneratorError(f"a spec can have only one {kind} '{name}', found two")
            nodes[name] = node
        section = self.map_of(nodes)
        for entry in section if with_origins else ():
            self._note_origin(entry.key, entry.value)
        return section if nodes else None

    def nested(
        self, kind: str, parts: Iterable[tuple[str, str, YamlNode]], *, first_origin_only: bool = False
    ) -> YamlMap | None:
        """Return `{outer: {inner: node}}`, None for an empty one.

        Comments show the origin of each part or, if `first_origin_only`, of the first below each outer name.

        Raises:
            RobotGeneratorError: for two parts of the same two names.

        """
        groups: dict[str, list[tuple[str, YamlNode]]] = {}
        for outer, inner, node in parts:
            groups.setdefault(outer, []).append((inner, node))
        section = self.map_of(
            {
                outer: self.named(f"{kind} of '{outer}'", group, with_origins=not first_origin_only)
                for outer, group in groups.items()
            }
        )
        for entry, group in zip(section, groups.values(), strict=True):
            if first_origin_only:
                self._note_origin(entry.key, group[0][1])
        return section if groups else None

    def _note_origin(self, key: YamlScalar, node: YamlNode) -> None:
        if node in self.written:
            self.parts[key] = self.written[node].source

    # Data of plugins and authors

    def free(self, part: FreePart) -> YamlNode:
        """Return a parameter of a plugin: a text, unquoted where YAML reads the same text, a map or a list."""
        if isinstance(part, Mapping):
            return self.map_of({key: self.free(item) for key, item in part.items()})
        if isinstance(part, tuple | list):
            return self.list_of(map(self.free, part))
        return _plain(part if isinstance(part, str) else _scalar_text(part))

    def free_map(self, parts: Mapping[str, FreePart]) -> YamlNode | None:
        return self.free(parts) if parts else None

    def data(self, value: object) -> YamlNode:
        """Return an author's data: what YAML has as such, all other values as text."""
        if isinstance(value, Mapping):
            return self.map_of({str(key): self.data(item) for key, item in value.items()})
        if isinstance(value, list | tuple):
            return self.list_of(self.data(item) for item in value)
        if value is None or isinstance(value, bool):
            return YamlScalar("null" if value is None else _scalar_text(value), value, _NOWHERE)
        if isinstance(value, int | float):
            is_whole = isinstance(value, float) and value.is_integer()
            return YamlScalar(repr(float(value)) if is_whole else _scalar_text(value), value, _NOWHERE)
        return _text(str(value))

    def _raw(self, texts: Sequence[str]) -> YamlNode | None:
        """Return one text of raw XML, or a list of several."""
        if not texts:
            return None
        nodes = [_text(text) for text in texts]
        return nodes[0] if len(nodes) == 1 else self.list_of(nodes)

    # Sources

    def located(self, node: Node, source: SourceRef | None, *field: str) -> Node:
        """Note that the value of a node was written at the path `field` of an object, and return the node."""
        if source is not None:
            self.written[node] = Written(source, field)
        return node

    def _is_left_out(self, value: object, default: object) -> bool:
        return not self.full and value == default


def _escaped(text: str) -> str:
    """Return text in which nothing is an expression."""
    return text.replace("$(", "$$(")


def _text(text: str) -> YamlScalar:
    escaped = _escaped(text)
    return YamlScalar(escaped, escaped, _NOWHERE)


def _plain(text: str) -> YamlScalar:
    escaped = _escaped(text)
    return YamlScalar(escaped, word_value(escaped), _NOWHERE)


def _scalar_text(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return number_text(value) if isinstance(value, int | float) else str(value)
