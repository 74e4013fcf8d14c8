"""Find what the expanded trees of analyses hold at a place in a text: one node for each use and copy of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple, TypeAlias

from linkforge_compile.analysis import Analysis
from linkforge_compile.expand import Instance
from linkforge_compile.lsp.occurrences import DECLARING
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.source import Position, Span, TracedSpan
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

_Path: TypeAlias = tuple[str | int, ...]
_NAMED = {*DECLARING, ("mount",), ("semantic", "group_states")}
"""The sections whose keys get the prefix."""


class FileUse(NamedTuple):
    """A use of a file: its Instance, `prefix` with those of the uses around it, and `modules`, their names."""

    analysis: Analysis
    instance: Instance
    prefix: str
    modules: tuple[str, ...]

    def path(self, path: _Path) -> str:
        """Return the path that a value of the file has in the finished robot."""
        place = next((len(section) for section in _NAMED if path[: len(section)] == section), len(path))
        keys = [str(key) for key in path]
        keys[:1] = ["joints"] if path[:1] == ("mount",) else keys[:1]
        if place < len(keys):
            keys[place] = self.prefix + keys[place]
        return "/".join(keys)

    @property
    def label(self) -> str:
        """The name of the use, as a person would call it: "left", "cell: arm/gripper"."""
        return "/".join(self.modules) or self.instance.name


class Placed(NamedTuple):
    """A scalar, or what an expression made, in a use of a file; `key` is its key if the position is there."""

    use: FileUse
    path: _Path
    node: YamlNode
    key: YamlScalar | None = None

    @property
    def span(self) -> Span:
        """The place of the key, or of the value."""
        return self.key.span if self.key is not None else self.node.span

    @property
    def robot_path(self) -> str:
        """The path in the finished robot."""
        return self.use.path(self.path)


def uses_in(analyses: Iterable[Analysis]) -> Iterator[FileUse]:
    """Yield all uses of files in some analyses."""
    for analysis in analyses:
        if analysis.instance is not None:
            yield from _uses(analysis, analysis.instance, "", ())


def known_analyses(document: Document) -> tuple[Analysis, ...]:
    """Return the analyses of a document, with the latest of a text that could be read if its own cannot."""
    last = (document.readable,) if document.readable is not None and document.is_malformed else ()
    return (*last, *document.analyses)


def uses_of(document: Document) -> Iterator[FileUse]:
    """Yield the uses of a document's own file; of a malformed one those that it had before."""
    for use in uses_in(known_analyses(document)):
        if use.instance.tree is not None and document.holds(use.instance.tree.span):
            yield use


def _uses(analysis: Analysis, instance: Instance, outer: str, modules: tuple[str, ...]) -> Iterator[FileUse]:
    prefix = outer + instance.prefix
    yield FileUse(analysis, instance, prefix, modules)
    for module in instance.modules:
        yield from _uses(analysis, module, prefix, (*modules, module.name))


def placed_at(document: Document, at: Position) -> Iterator[Placed]:
    """Yield the nodes and keys at a position of a document."""
    for one in placed_in(document, at, at):
        if one.span.start <= at <= one.span.end:
            yield one


def placed_in(document: Document, start: Position, end: Position) -> Iterator[Placed]:
    """Yield the nodes and keys on the lines between two positions of a document."""
    files: dict[int, bool] = {}

    def is_here(span: Span) -> bool:
        if span.end_line < start.line or end.line < span.line:
            return False
        known = files.get(id(span.file))
        if known is None:
            known = files[id(span.file)] = document.holds(span)
        return known

    for use in uses_in(document.analyses):
        for path, node, key in _trees(use.instance):
            if key is not None and is_here(key.span):
                yield Placed(use, path, node, key)
            if _is_leaf(node) and is_here(node.span):
                yield Placed(use, path, node)


def _trees(instance: Instance) -> Iterator[tuple[_Path, YamlNode, YamlScalar | None]]:
    """Yield the nodes of a file, and those of its entry of `modules` in the file around it."""
    yield from nodes_in(instance.tree)
    entry = instance.entry.node if instance.entry else None
    if isinstance(entry, YamlMap):
        for one in entry:
            # The arguments belong to the module's parameters, and overrides to what they change.
            if one.name not in ("with", "override"):
                yield from nodes_in(one.value, ("modules", instance.name, one.name), one.key)


def leaves_in(tree: YamlNode) -> Iterator[tuple[_Path, YamlNode]]:
    """Yield the scalars of a tree, and what an expression made, with their paths."""
    return ((path, node) for path, node, _ in nodes_in(tree) if _is_leaf(node))


def _is_leaf(node: YamlNode) -> bool:
    return isinstance(node, YamlScalar) or (isinstance(node.span, TracedSpan) and node.span.trace is not None)


def nodes_in(
    node: YamlNode | None, path: _Path = (), key: YamlScalar | None = None
) -> Iterator[tuple[_Path, YamlNode, YamlScalar | None]]:
    """Yield the nodes in a tree with their paths and keys; not the parts of what an expression made as a whole."""
    waiting: list[tuple[_Path, YamlNode, YamlScalar | None]] = [(path, node, key)] if node is not None else []
    while waiting:
        path, node, key = waiting.pop()
        yield path, node, key
        inside: list[tuple[_Path, YamlNode, YamlScalar | None]] = []
        if isinstance(node, YamlMap):
            inside = [((*path, entry.name), entry.value, entry.key) for entry in node]
        elif isinstance(node, YamlList) and not _is_leaf(node):
            inside = [((*path, index), item, None) for index, item in enumerate(node)]
        waiting += reversed(inside)
