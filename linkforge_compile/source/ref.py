"""From a value of the IR back to the text that made it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from linkforge_compile.source.span import Change, Span


class Key(str):
    """The last step of a path that ends at a key itself, not at what stands under it."""

    __slots__ = ()


class Located(Protocol):
    """A node of a positioned tree, YAML's or XML's; all that a reference asks of it."""

    @property
    def span(self) -> Span: ...

    def child(self, key: str | int) -> Located | None:
        """Return the node under a key or position, None where nothing is said."""
        ...

    def key_span(self, key: str) -> Span | None:
        """Return where a key stands, None where there is none."""
        ...


Step: TypeAlias = "tuple[Span | None, Span | None]"
"""The places of a key and of the value under it, None for one that there is not."""


def brought_in(way: Iterable[Step]) -> Iterator[Span]:
    """Yield where aliases and `<<` bring in what a way leads to: an anchor stands above the place that uses it.

    A URDF has none, and its attributes and elements in any order.
    """
    place: Span | None = None
    for key, value in way:
        if key == value:
            continue  # nobody wrote this key: it has the place of what was put under it
        for inner in (key, value):
            if inner and place and inner.file is place.file and inner.start < place.start and not inner.file.is_xml:
                yield place
            place = inner or place


@dataclass(frozen=True, slots=True)
class SourceRef:
    """Where an object was written.

    `node` is the object's own node, `key` that of its name where a named map holds it: not its span, which is made
    when somebody asks. `trail` lists the `use` that brought its file in, then the use of that file, and so on outwards.
    """

    node: Located
    key: Located | None = None
    trail: tuple[Span, ...] = ()

    @property
    def span(self) -> Span:
        """The name if the object has one, else the whole node."""
        return self.node.span if self.key is None else self.key.span

    def at(self, *path: str | int) -> Span:
        """Return the span of the deepest node that exists on the path, this object's own for none."""
        node = self.node
        span = self.span
        for key in path:
            if isinstance(key, Key):
                return node.key_span(key) or span
            inner = node.child(key)
            if inner is None:
                break
            node, span = inner, inner.span
        return span

    def changes(self, *path: str | int) -> tuple[Change, ...]:
        """Return what overrides changed in this object, and in those that the path leads through."""
        node: Located | None = self.node
        found = node.span.changes if node else ()
        for key in path:
            node = node.child(key) if node else None
            found = (*found, *(node.span.changes if node else ()))
        return found

    def brought_in(self, *path: str | int) -> tuple[Span, ...]:
        """Return where aliases and `<<` bring in what the path leads to."""
        node = self.node
        way: list[Step] = [(None, self.span)]
        for key in path:
            inner, place = node.child(key), node.key_span(str(key))
            if inner or place:
                way += [(None, node.span), (place, inner.span if inner and not isinstance(key, Key) else None)]
            if inner is None:
                break
            node = inner
        return tuple(brought_in(way))

    def trail_to(self, place: Span) -> tuple[Span, ...]:
        """Return the uses that led to a place: to the object's own file or, from an override, to one that uses it."""
        files = [use.file for use in self.trail]
        return self.trail[files.index(place.file) + 1 :] if place.file in files else self.trail

    def __deepcopy__(self, memo: object) -> SourceRef:
        return self


@dataclass(frozen=True, slots=True, kw_only=True)
class Sourced:
    """A frozen value that remembers where it was written; neither compared nor hashed nor shown.

    The field is not called `origin`: half of the IR has an `origin` that is a pose.
    """

    source: SourceRef | None = field(default=None, compare=False, repr=False)
