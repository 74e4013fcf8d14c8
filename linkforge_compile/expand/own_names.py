"""`path()`, `link()` and `joint()`: what a file's expressions may ask of the file itself."""

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


def asked_in(asked: Iterable[NameReference], before: YamlNode, after: YamlNode) -> tuple[NameReference, ...]:
    """Return of the names that were asked for those that an override has left, with the text that they stood in."""
    gone = set(_places(before)) - set(_places(after))
    return tuple(one for one in asked if not any(map(one.where.span.lies_in, gone)))


def _places(node: YamlNode) -> Iterator[Span]:
    """Yield where the scalars and keys of a tree were written."""
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


class OwnNames:
    """The functions of one use of a file, and the names that were asked for: whether they exist is told later."""

    def __init__(
        self,
        spec: SpecFile,
        prefix: str | Fault,
        packages: Callable[[], Mapping[str, Path]],
        loader: Loader,
        trail: tuple[Span, ...],
    ) -> None:
        """`prefix` is the whole of it, in front of every name of the file in the end."""
        self._spec = spec
        self._prefix = prefix
        self._packages = packages
        self._loader = loader
        self._trail = trail
        self._asked: list[NameReference] = []

    @property
    def asked(self) -> tuple[NameReference, ...]:
        return tuple(self._asked)

    @property
    def functions(self) -> dict[str, FileFunction]:
        return {"path": self._path, "link": self._link, "joint": self._joint}

    def site(self, text: str, where: Span) -> PathSite:
        """Return a path as written in one of the files that are this one."""
        return PathSite(text, where, self._spec.part_at(where), self._packages())

    def _path(self, text: str, where: Span, sink: Diagnostics) -> Value | Fault:
        target = locate(self.site(text, where), self._loader, sink)
        return FAULT if target is None else str(target.path.absolute())

    def _link(self, name: str, where: Span, _sink: Diagnostics) -> Value | Fault:
        return self._final("link", name, where)

    def _joint(self, name: str, where: Span, _sink: Diagnostics) -> Value | Fault:
        return self._final("joint", name, where)

    def _final(self, kind: str, name: str, where: Span) -> Value | Fault:
        self._asked.append(NameReference(kind, name, SourceRef(YamlFault(where), None, self._trail)))
        return FAULT if isinstance(self._prefix, Fault) else self._prefix + name
