"""The positioned tree: what the text says, with the span of every key and value, frozen.

Every stage up to lowering reads and makes these nodes. Expanding replaces a scalar that holds an expression
by a node of its value with the expression's span, so a tree without expressions is a tree of the same kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from linkforge_compile.source import SourceFile, Span, span_of
from linkforge_compile.units import Quantity

ScalarValue: TypeAlias = None | bool | int | float | str | Quantity

MAX_DEPTH = 100
"""How deep lists and maps may nest: every later stage walks the tree by recursion."""


class YamlScalar(NamedTuple):
    """A scalar: its text as written (without quotes) and what that means in YAML 1.2's core schema.

    Only an evaluated expression or a variable gives a Quantity; a quantity that was typed is still a str here.
    Fields that are text or names take `text`, so that `version: 1.0` stays "1.0"; numbers take `value`.

    A scalar that was read knows its file and between which indexes it stands there; its span is computed when
    asked for.
    `end` is None where it ends with its text.
    """

    text: str
    value: ScalarValue
    place: Span | SourceFile
    begin: int = 0
    end: int | None = None

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.begin + len(self.text) if self.end is None else self.end)

    def child(self, key: str | int) -> None:
        return None

    def key_span(self, key: str) -> None:
        return None

    def __deepcopy__(self, memo: object) -> YamlScalar:
        return self

    # Like every node, it is equal to itself alone: two that say the same at one place may come from two parts.

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


@dataclass(frozen=True, slots=True, eq=False)
class YamlList:
    """A sequence, in block or flow style; its place is said as that of a scalar."""

    items: tuple[YamlNode, ...]
    place: Span | SourceFile
    begin: int = 0
    end: int = 0

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.end)

    def child(self, key: str | int) -> YamlNode | None:
        return self.items[key] if isinstance(key, int) and 0 <= key < len(self.items) else None

    def key_span(self, key: str) -> None:
        return None

    def __iter__(self) -> Iterator[YamlNode]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)

    def __deepcopy__(self, memo: object) -> YamlList:
        return self


class YamlEntry(NamedTuple):
    """A key and its value; the key is a scalar whose text is the name.

    `replaced` is the entry of the same name whose value this one took the place of: what an override changed, or
    the default that an entry's own word goes before. Values that were merged have it further down.
    """

    key: YamlScalar
    value: YamlNode
    replaced: YamlEntry | None = None

    @property
    def name(self) -> str:
        return self.key.text

    def __deepcopy__(self, memo: object) -> YamlEntry:
        return self

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


@dataclass(frozen=True, slots=True, eq=False)
class YamlMap:
    """A mapping, keys unique by their text, in the order written; its place is said as that of a scalar."""

    entries: Mapping[str, YamlEntry]
    place: Span | SourceFile
    begin: int = 0
    end: int = 0

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.end)

    def get(self, key: str) -> YamlNode | None:
        """Return what is said under `key`, None where nothing is: a value of null is as if not written."""
        entry = self.entries.get(key)
        if entry is None:
            return None
        value = entry.value
        return None if isinstance(value, YamlScalar) and value.value is None else value

    def child(self, key: str | int) -> YamlNode | None:
        entry = self.entries.get(str(key))
        return entry.value if entry else None

    def key_span(self, key: str) -> Span | None:
        entry = self.entries.get(key)
        return entry.key.span if entry else None

    def __iter__(self) -> Iterator[YamlEntry]:
        return iter(self.entries.values())

    def __len__(self) -> int:
        return len(self.entries)

    def __deepcopy__(self, memo: object) -> YamlMap:
        return self


@dataclass(frozen=True, slots=True, eq=False)
class YamlFault:
    """Something stood here and its fault has been reported: who meets it stays silent and goes on.

    `keys` are those of the map that it was, and of all maps in it: names that somebody may look for.
    """

    span: Span
    keys: frozenset[str] = frozenset()

    def child(self, key: str | int) -> None:
        return None

    def key_span(self, key: str) -> None:
        return None

    def __deepcopy__(self, memo: object) -> YamlFault:
        return self


YamlNode: TypeAlias = YamlScalar | YamlList | YamlMap | YamlFault

Tags: TypeAlias = Mapping[str, Callable[[YamlScalar], YamlNode]]
"""What a scalar with a tag becomes, by the tag; a fault of it is for the function to report."""


def fault_of(node: YamlNode) -> YamlFault:
    """Return what takes the place of a node that is at fault."""
    return node if isinstance(node, YamlFault) else YamlFault(node.span, frozenset(_keys_in(node)))


def names_at_fault(node: YamlNode | None) -> Iterator[str]:
    """Yield the keys of a map whose values are at fault, and the keys in those: names that somebody may look for."""
    for entry in node if isinstance(node, YamlMap) else ():
        if isinstance(entry.value, YamlFault):
            yield entry.name
            yield from entry.value.keys


def _keys_in(node: YamlNode) -> Iterator[str]:
    if isinstance(node, YamlMap):
        yield from node.entries
    for inner in node if isinstance(node, YamlList) else ():
        yield from _keys_in(inner)
    for entry in node if isinstance(node, YamlMap) else ():
        yield from _keys_in(entry.value)


def is_null(node: YamlNode) -> bool:
    """Whether a node is null, written as `null` or by writing nothing."""
    return isinstance(node, YamlScalar) and node.value is None


def leaves_in(node: YamlNode) -> Iterator[YamlNode]:
    """Yield all keys, scalars and empty nodes; not what holds others, for an arranged map spans nothing of its own."""
    match node:
        case YamlMap() if node.entries:
            for entry in node:
                yield entry.key
                yield from leaves_in(entry.value)
        case YamlList() if node.items:
            for item in node:
                yield from leaves_in(item)
        case _:
            yield node
