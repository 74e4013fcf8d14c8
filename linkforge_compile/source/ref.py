"""From a value of the IR back to the text that made it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from linkforge_compile.source.span import Span


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

    def __deepcopy__(self, memo: object) -> SourceRef:
        return self


@dataclass(frozen=True, slots=True, kw_only=True)
class Sourced:
    """A frozen value that remembers where it was written; neither compared nor hashed nor shown.

    The field is not called `origin`: half of the IR has an `origin` that is a pose.
    """

    source: SourceRef | None = field(default=None, compare=False, repr=False)
