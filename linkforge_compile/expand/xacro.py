"""A xacro file as a module: its arguments are given as those of any other, and packages are found where ours are."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import (
    XACRO_ARGUMENT,
    XACRO_FORBIDDEN,
    XACRO_WARNS,
)
from linkforge_compile.expand.annotating_sink import with_use_trace
from linkforge_compile.expand.arguments import Arguments
from linkforge_compile.expand.evaluate_tree import TreeEvaluator
from linkforge_compile.expand.loader import ImportSite, Loader, SpecFile
from linkforge_compile.expand.packages import Package, find_package
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expand.xacro_faults import Telling, Written
from linkforge_compile.expressions import FAULT
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlNode, YamlScalar
from linkforge_compile.units import Quantity, number_text, parse_quantity

if TYPE_CHECKING:
    from linkforge_compile.importers.document import Imported, Move

FORBIDDEN = "LINKFORGE_NO_XACRO"
"""The environment variable that, set to anything, keeps xacro files from being expanded."""


@dataclass(frozen=True)
class XacroUse:
    """One use of a xacro file: what names it, what it is given, and where packages are said to be.

    `tree` computes the arguments, None where they hold no expressions. `package` is the one through whose
    `package://` the file was reached. `taken` are the names of those that another file of the same robot takes; None
    where that one tells of what neither takes.
    """

    path: Path
    used: ImportSite
    arguments: Arguments
    tree: TreeEvaluator | None = None
    packages: Mapping[str, Path] | None = None
    package: Package | None = None
    taken: Collection[str] | None = ()


class Expansion(NamedTuple):
    """What a xacro file expands to: `moved` puts the elements of `text` where they were written.

    `files` are those in which they were written, the first one first, and the text itself. `arguments` are the names
    of those that it takes.
    """

    text: SourceFile
    moved: Move
    files: tuple[SourceFile, ...]
    arguments: frozenset[str]


class Robot(NamedTuple):
    """What a xacro file expands to, read, and the files that it was written in, the first one first."""

    imported: Imported
    file: SourceFile
    others: tuple[SourceFile, ...]


def open_xacro(use: XacroUse, loader: Loader, sink: Diagnostics) -> SpecFile | None:
    """Expand a xacro file and read it as a spec; None where it cannot be had, which is reported.

    What is wrong with the robot is told in the xacro file that wrote it.
    """
    robot = read_xacro(use, loader, sink)
    if robot is None:
        return None
    tree, folder = robot.imported.tree, use.path.parent
    included = {file: SpecFile(file, tree, folder, use.package) for file in robot.others}
    return SpecFile(robot.file, tree, folder, use.package, included, use.packages or {})


def read_xacro(use: XacroUse, loader: Loader, sink: Diagnostics, *, keeps_refused: bool = False) -> Robot | None:
    """Expand a xacro file and read the robot in it, as `open_xacro` does; `keeps_refused` as `read_urdf` has it."""
    from linkforge_compile.importers.urdf import read_urdf

    expansion = expand_xacro(use, loader, sink)
    if expansion is None:
        return None
    imported = read_urdf(expansion.text, _inside(use, sink), expansion.moved, keeps_refused=keeps_refused)
    main, *others = expansion.files
    return Robot(imported, main, tuple(others)) if imported else None


def expand_xacro(use: XacroUse, loader: Loader, sink: Diagnostics) -> Expansion | None:
    """Expand a xacro file of any kind; None where it cannot be had, which is reported."""
    from linkforge_compile.importers.xacro import Failed, moved_back, run_xacro

    main = loader.open_xml(use.path, sink, use.used)
    arguments = _texts(use, sink)
    if main is None or arguments is None:
        return None
    if os.environ.get(FORBIDDEN) or not loader.runs_xacro:
        sink.report(XACRO_FORBIDDEN.at(use.used.where, path=use.used.text, variable=FORBIDDEN))
        return None
    asked = Asked(use, loader)
    result = run_xacro(use.path, arguments, asked)
    written = Written(result, main, loader)
    inside = _inside(use, sink)
    told = Telling(use, written, loader, sink, inside)
    if isinstance(result, Failed):
        told.failed(result, asked)
        return None
    told.unknown_arguments(result.arguments, result.wanted)
    for warning in result.warnings:
        inside.report(XACRO_WARNS.at(main.whole, text=warning))
    expanded = SourceFile(f"{main.name} (expanded)", result.text, order=main.order)
    files = (main, *written.files, expanded)
    moved = partial(moved_back, find=written.element)
    return Expansion(expanded, moved, files, frozenset((*result.arguments, *result.wanted)))


def _inside(use: XacroUse, sink: Diagnostics) -> Diagnostics:
    """Return what takes what is told in the files of a use."""
    return with_use_trace(sink, (use.used.where,))


class Asked:
    """Answers what xacro asks while it expands a file, and keeps what it may not have."""

    def __init__(self, use: XacroUse, loader: Loader) -> None:
        self._use, self._loader = use, loader
        self.lost: list[str] = []
        """The names of packages that are nowhere."""
        self.refused: list[Path] = []
        """The files outside of the roots."""

    def find(self, name: str) -> Path | None:
        declared = {**(self._use.packages or {}), **self._loader.packages}
        folder = find_package(name, declared, self._use.path.parent, self._loader.roots)
        if folder is None:
            self.lost.append(name)
        return folder

    def may_read(self, path: Path) -> bool:
        # The file itself was read already by whoever may.
        is_held = path == self._use.path.absolute() or self._loader.roots.hold(path)
        if not is_held:
            self.refused.append(path)
        return is_held


def _texts(use: XacroUse, sink: Diagnostics) -> dict[str, str] | None:
    """Return the arguments as xacro takes them, all of them text; None where one is at fault."""
    texts: dict[str, str] = {}
    is_whole = not use.arguments.is_partial
    for name, entry in use.arguments.entries.items():
        text = _text(entry.value, use)
        if text is FAULT:
            is_whole = False
        elif isinstance(text, str):
            texts[name] = text
        else:
            sink.report(XACRO_ARGUMENT.at(entry.value.span, name=name))
            is_whole = False
    return texts if is_whole else None


def _text(node: YamlNode, use: XacroUse) -> object:
    """Return a value as text, FAULT where it was reported, None for what is neither text, number nor flag."""
    if use.arguments.as_text and isinstance(node, YamlScalar):
        quantity = parse_quantity(node.text)
        return number_text(quantity.value) if quantity else node.text
    value = use.tree.value(node) if use.tree else plain_value(node)
    match value:
        case bool():
            return "true" if value else "false"
        case Quantity():
            return number_text(value.value)
        case int() | float():
            return number_text(value)
        case str():
            return value
    return FAULT if value is FAULT else None
