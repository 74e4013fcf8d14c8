"""The builder: values of the IR as nodes of a spec, without what the language fills in by itself, or with all of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.part import Element, Inside
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, word_value
from linkforge_compile.units import Dimension, number_text

if TYPE_CHECKING:
    from linkforge_compile.core.frozen_map import FreePart
    from linkforge_compile.source import SourceRef

Node = TypeVar("Node", bound=YamlNode)

_NOWHERE = SourceFile("<robot>", "").whole
_WHOLE_TURN = 2 * math.pi  # [rad]


class Extended(Protocol):
    """A part of the robot: where it was written, and what no field of it says."""

    @property
    def source(self) -> SourceRef | None: ...
    @property
    def extra_attributes(self) -> Sequence[tuple[str, str]] | Mapping[str, str]: ...
    @property
    def extra_elements(self) -> Sequence[str]: ...


class Written(NamedTuple):
    """Where the value of a node was written: in the object that `source` points to, under `field` of it."""

    source: SourceRef
    field: tuple[str, ...] = ()


class SpecBuilder:
    """Makes the nodes of one spec, and remembers of what they were made.

    In `full` it writes every value in its long form, defaults too: the robot as `explain` looks through it.
    `written` says where the value of a node was written, `parts` the same of the keys that are names of parts whose
    origin a person asks for; `units` has the dimension of each number that is not bare.
    """

    def __init__(self, *, full: bool = False) -> None:
        self.full = full
        self.written: dict[YamlNode, Written] = {}
        self.parts: dict[YamlNode, SourceRef] = {}
        self.units: dict[YamlNode, Dimension] = {}

    # Scalars; None, which is not written, for None and, unless in full, for what the language fills in

    def text(self, value: str | None, default: str | None = None) -> YamlScalar | None:
        return None if value is None or self._is_unsaid(value, default) else _text(value)

    def flag(self, value: bool | None, default: bool | None = None) -> YamlScalar | None:
        if value is None or self._is_unsaid(value, default):
            return None
        return YamlScalar(str(bool(value)).lower(), bool(value), _NOWHERE)

    def number(
        self, value: float | None, unit: Dimension | None = None, *, default: float | None = None
    ) -> YamlScalar | None:
        return None if value is None or self._is_unsaid(value, default) else self.quantity(value, unit)

    def quantity(self, value: float, unit: Dimension | None = None) -> YamlScalar:
        """Return a number that is always written, in the SI unit of its dimension."""
        digits = number_text(value)
        if unit is Dimension.ANGLE and abs(value) > _WHOLE_TURN and not self.full:
            # A bare number of that size would be warned about: somebody may have meant degrees.
            return _text(f"{digits} rad")
        node = YamlScalar(digits, value, _NOWHERE)
        if unit is not None:
            self.units[node] = unit
        return node

    def word(self, value: str | None) -> YamlScalar:
        """Return a text that stands where something must: null for None."""
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
        said = {key: YamlEntry(_text(key), node) for key, node in entries.items() if node is not None}
        return YamlMap({_escaped(key): entry for key, entry in said.items()}, _NOWHERE)

    def element(self, part: Extended, /, **entries: YamlNode | None) -> YamlMap:
        """Return the object of a part: these entries, then what no field says."""
        inside = part.extra_inside if isinstance(part, Element | Interface) else ()
        node = self.map_of(
            {
                **entries,
                "extra": self._raw(part.extra_elements),
                "extra_attributes": self.free(dict(part.extra_attributes)) if part.extra_attributes else None,
                "extra_inside": self.named("element", ((_tag(one), self.element(one)) for one in inside), told=False),
            }
        )
        return self.located(node, part.source)

    def alone(self, node: YamlMap, key: str) -> YamlNode:
        """Return what stands under the key of an object that says nothing else: its short form, unless in full."""
        return node.entries[key].value if not self.full and node.entries.keys() == {key} else node

    def named(self, kind: str, parts: Iterable[tuple[str, YamlNode]], *, told: bool = True) -> YamlMap | None:
        """Return a map keyed by names, None for an empty one; unless `told`, nobody asks where its parts come from.

        Raises:
            RobotGeneratorError: for two parts of one name, of which a spec can hold only one.

        """
        nodes: dict[str, YamlNode] = {}
        for name, node in parts:
            if name in nodes:
                raise RobotGeneratorError(f"a spec holds one {kind} '{name}', found two")
            nodes[name] = node
        section = self.map_of(nodes)
        for entry in section if told else ():
            self._tell(entry.key, entry.value)
        return section if nodes else None

    def nested(
        self, kind: str, parts: Iterable[tuple[str, str, YamlNode]], *, told_once: bool = False
    ) -> YamlMap | None:
        """Return `{outer: {inner: node}}`, None for an empty one; what has one outer name comes together.

        Where it comes from is told of each part or, `told_once`, of the first below each outer name.

        Raises:
            RobotGeneratorError: for two parts of the same two names.

        """
        groups: dict[str, list[tuple[str, YamlNode]]] = {}
        for outer, inner, node in parts:
            groups.setdefault(outer, []).append((inner, node))
        section = self.map_of(
            {outer: self.named(f"{kind} of '{outer}'", below, told=not told_once) for outer, below in groups.items()}
        )
        for entry, below in zip(section, groups.values(), strict=True):
            if told_once:
                self._tell(entry.key, below[0][1])
        return section if groups else None

    def _tell(self, key: YamlScalar, node: YamlNode) -> None:
        if node in self.written:
            self.parts[key] = self.written[node].source

    # What plugins read

    def free(self, part: FreePart) -> YamlNode:
        """Return a free part: text without quotes where that means the same there, maps and lists as they are."""
        if isinstance(part, Mapping):
            return self.map_of({key: self.free(item) for key, item in part.items()})
        if isinstance(part, tuple | list):
            return self.list_of(map(self.free, part))
        return _plain(part if isinstance(part, str) else _spelled(part))

    def free_map(self, parts: Mapping[str, FreePart]) -> YamlNode | None:
        return self.free(parts) if parts else None

    def data(self, value: object) -> YamlNode:
        """Return an author's own data: numbers, flags, null, lists and maps as such, and all else as text."""
        if isinstance(value, Mapping):
            return self.map_of({str(key): self.data(item) for key, item in value.items()})
        if isinstance(value, list | tuple):
            return self.list_of(self.data(item) for item in value)
        if value is None or isinstance(value, bool):
            return YamlScalar("null" if value is None else _spelled(value), value, _NOWHERE)
        if isinstance(value, int | float):
            return YamlScalar(_spelled(value), value, _NOWHERE)
        return _text(str(value))

    def _raw(self, texts: Sequence[str]) -> YamlNode | None:
        """Return raw XML: one text as it is, several as a list."""
        if not texts:
            return None
        nodes = [_text(text) for text in texts]
        return nodes[0] if len(nodes) == 1 else self.list_of(nodes)

    # Where it was written

    def located(self, node: Node, source: SourceRef | None, *field: str) -> Node:
        """Note that the value of a node was written under `field` of an object, and return the node."""
        if source is not None:
            self.written[node] = Written(source, field)
        return node

    def _is_unsaid(self, value: object, default: object) -> bool:
        return not self.full and value == default


def _tag(one: Inside) -> str:
    return one.tag if one.name is None else f"{one.tag} {one.name}"


def _escaped(text: str) -> str:
    """Return text in which nothing is an expression."""
    return text.replace("$(", "$$(")


def _text(text: str) -> YamlScalar:
    escaped = _escaped(text)
    return YamlScalar(escaped, escaped, _NOWHERE)


def _plain(text: str) -> YamlScalar:
    escaped = _escaped(text)
    return YamlScalar(escaped, word_value(escaped), _NOWHERE)


def _spelled(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return number_text(value) if isinstance(value, int | float) else str(value)
