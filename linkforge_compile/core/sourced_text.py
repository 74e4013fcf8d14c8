"""Names of parameters with the places where they and their values were written."""

from __future__ import annotations

from typing import Self

from linkforge_compile.core.part import dump_like
from linkforge_compile.source import Key, SourceRef


class SourcedText(str):
    """A name in the parameters of a manager, with the `source` of its value, None if it was not read.

    Merging modules puts the parameters of several files into one manager, so the source of the manager would not do.
    It compares, hashes and prints as that name. A key has its own node as the `key` of its source.
    """

    __slots__ = ("source",)

    source: SourceRef | None

    def __new__(cls, text: str, source: SourceRef | None = None) -> Self:
        sourced = super().__new__(cls, text)
        sourced.source = source
        return sourced

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.source)


dump_like(SourcedText, str)


def place_of_parameter(source: SourceRef | None, *path: str) -> tuple[SourceRef | None, *tuple[str, ...]]:
    """Return where the value at a path of a controller was written: an object, and the path from there."""
    name = path[-1]
    if isinstance(name, SourcedText) and name.source:
        return (SourceRef(name.source.node, None, name.source.trail),)
    return (source, *path)


def place_of_parameter_name(source: SourceRef | None, *path: str) -> tuple[SourceRef | None, *tuple[str, ...]]:
    """Return where the last name of a path itself was written."""
    *outer, name = path
    if isinstance(name, SourcedText) and name.source:
        return (name.source,)
    keys = (*outer, Key(name))
    return (source, *keys)
