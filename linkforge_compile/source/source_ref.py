"""References from the values of a robot to where they were written."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Protocol, Self

from linkforge_compile.source.span import ModuleUse, Span


class Key(str):
    """The last step of a path that leads to a key itself, not to the value under it."""

    __slots__ = ()


class Located(Protocol):
    """A node of a tree with places, of YAML or XML; all that a reference needs."""

    @property
    def span(self) -> Span: ...

    def child(self, key: str | int) -> Located | None:
        """Return the node under a key or position, None if there is none."""
        ...

    def key_span(self, key: str) -> Span | None:
        """Return the place of a key, None if there is none."""
        ...


@dataclass(frozen=True, slots=True)
class SourceRef:
    """Where an object was written.

    `node` is the object's own node, `key` the node of its name in a map of names. `trail` lists the `use` of its file,
    then the use of the file that wrote that, and so on outwards.
    """

    node: Located
    key: Located | None = None
    trail: tuple[ModuleUse, ...] = ()

    @property
    def modules(self) -> tuple[str, ...]:
        """The names of the modules that the object is in, the outermost first; none in the compiled file."""
        return tuple(use.module for use in reversed(self.trail))

    @property
    def span(self) -> Span:
        """The name if the object has one, else the whole node."""
        return self.node.span if self.key is None else self.key.span

    def at(self, *path: str | int) -> Span:
        """Return the span of the deepest node that exists on the path; this object's own if none does."""
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

    def __deepcopy__(self, memo: object) -> SourceRef:
        return self


class Sourced:
    """A value with the place where it was written, None if it was not read.

    `source` is no field of the dataclasses that are derived from this class: it is neither compared nor hashed, shown,
    or converted by `asdict`. It is not called `origin`, as half of the IR has an `origin` that is a pose.
    """

    source: SourceRef | None = None

    def with_source(self, source: SourceRef | None) -> Self:
        """Return a copy of the value that was written there."""
        value = copy(self)
        object.__setattr__(value, "source", source)  # the value may be frozen
        return value
