"""The outline of a spec as a kinematic tree, and the parts of all specs of a workspace by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from lsprotocol import types

from linkforge_compile.analysis import Settings
from linkforge_compile.core.models.graph import child_joints
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.cursor import read_sections
from linkforge_compile.lsp.occurrences import declarations_in
from linkforge_compile.lsp.workspace import Document, specs_in
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import YamlMap

MAX_DEPTH = 30
"""How many links deep an outline is nested, as clients read it by recursion; what is deeper follows at the end."""

MAX_FOUND = 500

MAX_CHARACTERS = 4 * 1024**2
"""How much of a workspace a search reads: it takes seconds, and each letter that is typed searches again."""

_KINDS = {
    "link": types.SymbolKind.Object,
    "joint": types.SymbolKind.Function,
    "module": types.SymbolKind.Module,
    "parameter": types.SymbolKind.Variable,
    "variable": types.SymbolKind.Constant,
    "data": types.SymbolKind.File,
    "material": types.SymbolKind.Property,
    "group": types.SymbolKind.Namespace,
    "state": types.SymbolKind.EnumMember,
}


def outline(document: Document) -> list[types.DocumentSymbol]:
    """Return the parts of a spec: its links and joints as a tree, with those of modules at their `use`, then the rest.

    Of a spec with errors the parts that could be read are there, in the order of the file if there is no tree; of a
    text that never parsed those in the sections that do.
    """
    analysis = document.analysis
    if analysis is None or analysis.spec is None:
        return [*_declared_symbols(document, read_sections(document.file))]
    is_own = analysis.spec.file.path is not None and document.holds(analysis.spec.file.whole)
    tree = _Outline(document, analysis.robot) if is_own and analysis.robot is not None else None
    symbols = list(tree.roots()) if tree else []
    declared = _declared_symbols(document, analysis.spec.tree)
    return [*symbols, *(one for one in declared if not symbols or one.detail not in {"link", "joint"})]


def _declared_symbols(document: Document, tree: YamlMap) -> Iterator[types.DocumentSymbol]:
    """Yield the parts that a document declares, section by section."""
    for kind, entry in declarations_in(tree):
        if document.holds(entry.key.span):
            yield _symbol(document.columns, kind, entry.name, entry.key.span, entry.value.span)


def find_symbols(
    query: str, folders: Iterable[Path], settings: Settings, columns: Columns
) -> list[types.WorkspaceSymbol]:
    """Return the parts that specs in folders declare, as written there, whose names have the letters in this order."""
    declared = _declared((spec for folder in folders for spec in specs_in(folder)), settings)
    found = [one for one in declared if _matches(query.lower(), one.name.lower())]
    found.sort(key=lambda one: (len(one.name), one.name))
    return [
        types.WorkspaceSymbol(
            location, one.name, _KINDS.get(one.kind, types.SymbolKind.Field), container_name=one.path.name
        )
        for one in found[:MAX_FOUND]
        if (location := columns.location(one.span))
    ]


class _Declared(NamedTuple):
    """A part that a spec declares: the path of the spec, the part's kind and name, and the place of the name."""

    path: Path
    kind: str
    name: str
    span: Span


def _declared(paths: Iterable[Path], settings: Settings) -> Iterator[_Declared]:
    """Yield the parts that specs declare, without what they use and compute, until MAX_CHARACTERS are read."""
    characters = 0
    for path in paths:
        try:
            spec = settings.loader(path).open(path, Diagnostics())
        except BeyondLimitError:
            continue
        for kind, entry in declarations_in(spec.tree) if spec else ():
            yield _Declared(path, kind, entry.name, entry.key.span)
        characters += len(spec.file.text) if spec else 0
        if characters > MAX_CHARACTERS:
            return


def _matches(query: str, name: str) -> bool:
    """Whether the letters of the query are in the name in their order, as editors match."""
    letters = iter(name)
    return all(letter in letters for letter in query)


def _symbol(columns: Columns, kind: str, name: str, key: Span, value: Span) -> types.DocumentSymbol:
    """Return the symbol of an entry, which reaches from its key to the end of its value if both are in one file."""
    is_after = key.file is value.file and key.end <= value.end
    whole = key._replace(end_line=value.end_line, end_column=value.end_column) if is_after else key
    return types.DocumentSymbol(
        name=name or "''",
        kind=_KINDS.get(kind, types.SymbolKind.Field),
        range=columns.range(whole),
        selection_range=columns.range(key),
        detail=kind,
        children=[],
    )


class _Outline:
    """The tree of links and joints of a robot, each at its place in a document."""

    def __init__(self, document: Document, robot: Robot) -> None:
        self._document = document
        self._links = {link.name: link for link in robot.links}
        self._below = child_joints(robot.joints)
        self._children = {joint.child for joint in robot.joints}
        self._seen: set[str] = set()

    def roots(self) -> Iterator[types.DocumentSymbol]:
        """Yield the links that are no child with what is below them, then those that no link leads to."""
        for name in sorted(self._links, key=self._children.__contains__):
            yield from self._link(name, 0)

    def _link(self, name: str, depth: int) -> Iterator[types.DocumentSymbol]:
        link = self._links.get(name)
        if link is None or name in self._seen:
            return
        self._seen.add(name)
        inside = [one for joint in self._below.get(name, ()) for one in self._joint(joint, depth)]
        yield from _with_children(self._at("link", name, link.source), inside)

    def _joint(self, joint: Joint, depth: int) -> Iterator[types.DocumentSymbol]:
        inside = list(self._link(joint.child, depth + 1)) if depth < MAX_DEPTH else []
        yield from _with_children(self._at(f"{joint.type} joint", joint.name, joint.source), inside)

    def _at(self, kind: str, name: str, source: SourceRef | None) -> types.DocumentSymbol | None:
        """Return the symbol of a part: where this document writes it, or uses the module that does."""
        places = (source.span, *source.trail) if source else ()
        place = next((one for one in places if self._document.holds(one)), None)
        if source is None or place is None:
            return None
        value = source.node.span if place is source.span else place
        symbol = _symbol(self._document.columns, kind.rpartition(" ")[2], name, place, value)
        symbol.detail = kind
        return symbol


def _with_children(
    symbol: types.DocumentSymbol | None, children: list[types.DocumentSymbol]
) -> Iterable[types.DocumentSymbol]:
    """Return a symbol with its children; without a place of its own, they take its place."""
    if symbol is None:
        return children
    symbol.children = children
    return [symbol]
