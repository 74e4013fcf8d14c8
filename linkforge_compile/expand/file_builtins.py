"""The functions `path()`, `link()` and `joint()` of one use of a file, and the names that they were called with."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.assembly import NameReference
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.uses import PathSite, locate
from linkforge_compile.expressions import FAULT, Fault, FileFunction, Value
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar


class FileBuiltins:
    """The functions of one use of a file; collects names passed to `link()` and `joint()` for a later check."""

    def __init__(
        self,
        spec: SpecFile,
        prefix: str | Fault,
        packages: Callable[[], Mapping[str, Path]],
        loader: Loader,
        include_stack: tuple[Span, ...],
    ) -> None:
        """`prefix` is the full one, of this use and those around it; `packages` is called when a path is located."""
        self._spec = spec
        self._prefix = prefix
        self._packages = packages
        self._loader = loader
        self._include_stack = include_stack
        self._references: list[NameReference] = []

    @property
    def references(self) -> tuple[NameReference, ...]:
        return tuple(self._references)

    @property
    def functions(self) -> dict[str, FileFunction]:
        return {"path": self._path, "link": self._link, "joint": self._joint}

    def site(self, text: str, where: Span) -> PathSite:
        """Return the site of a path that this file or one that it includes wrote."""
        return PathSite(text, where, self._spec.part_at(where), self._packages())

    def _path(self, text: str, where: Span, sink: Diagnostics) -> Value | Fault:
        target = locate(self.site(text, where), self._loader, sink)
        return FAULT if target is None else str(target.path.absolute())

    def _link(self, name: str, where: Span, _sink: Diagnostics) -> Value | Fault:
        return self._prefixed("link", name, where)

    def _joint(self, name: str, where: Span, _sink: Diagnostics) -> Value | Fault:
        return self._prefixed("joint", name, where)

    def _prefixed(self, kind: str, name: str, where: Span) -> Value | Fault:
        self._references.append(NameReference(kind, name, SourceRef(YamlFault(where), None, self._include_stack)))
        return FAULT if isinstance(self._prefix, Fault) else self._prefix + name


def references_left(
    references: Iterable[NameReference], before: YamlNode, after: YamlNode
) -> tuple[NameReference, ...]:
    """Return the references in texts that an override has not removed from a tree."""
    removed = set(_places(before)) - set(_places(after))
    return tuple(one for one in references if not any(map(one.where.span.lies_in, removed)))


def _places(node: YamlNode) -> Iterator[Span]:
    """Yield the spans of the scalars and keys of a tree."""
    match node:
        case YamlScalar():
            yield Span(*node.span)
        case YamlList():
            for item in node:
                yield from _places(item)
        case YamlMap():
            for entry in node:
                yield Span(*entry.key.span)
                yield from _places(entry.value)
