"""Merge the SRDF that `srdf` names into the URDF or xacro robot of the same module."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.annotating_sink import with_use_trace
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.packages import Package
from linkforge_compile.expand.uses import XACRO
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap

if TYPE_CHECKING:
    from linkforge_compile.expand.xacro_use import XacroUse
    from linkforge_compile.importers.document import Move


class Semantic(NamedTuple):
    """The text of an SRDF, expanded if it is a xacro, in a folder that was reached through `package`.

    `moved` gives its elements the places where they were written in `files`, None for a text that was not expanded.
    `arguments` are the names of those that a xacro uses.
    """

    text: SourceFile
    files: tuple[SourceFile, ...]
    folder: Path
    package: Package | None = None
    moved: Move | None = None
    arguments: frozenset[str] = frozenset()


def open_semantic(use: XacroUse, loader: Loader, sink: Diagnostics) -> Semantic | None:
    """Read an SRDF, expanded if it is a xacro; None after a reported error."""
    folder = use.path.parent
    if use.path.suffix.lower() != XACRO:
        file = loader.open_xml(use.path, sink, use.used if use.used.where else None)
        return Semantic(file, (file,), folder, use.package) if file else None
    from linkforge_compile.expand.xacro import expand_xacro

    # The URDF, which is read next, reports arguments that neither of the two uses.
    expansion = expand_xacro(replace(use, used_elsewhere=None), loader, sink)
    if expansion is None:
        return None
    return Semantic(expansion.text, expansion.files, folder, use.package, expansion.moved, expansion.arguments)


def with_semantic(
    spec: SpecFile, semantic: Semantic, use: XacroUse, loader: Loader, sink: Diagnostics
) -> SpecFile | None:
    """Return a robot with its SRDF merged; None after a reported error. `use` names the SRDF."""
    from linkforge_compile.importers.document import Comments, Imported
    from linkforge_compile.importers.srdf_with_urdf import with_srdf

    def merged(tree: YamlMap) -> SpecFile:
        parts = {file: SpecFile(file, tree, semantic.folder, semantic.package) for file in semantic.files}
        return replace(spec, tree=tree, included={**spec.included, **parts})

    def judged(tree: YamlMap) -> _Judged:
        return _Judged(loader.check_spec(merged(tree), loader))

    imported = Imported(spec.tree, Comments({}, {}))
    inside = with_use_trace(sink, (use.used.where,))
    read = with_srdf(imported, semantic.text, judged, inside, semantic.moved)
    return merged(read[0].tree) if read else None


class _Judged(NamedTuple):
    """The errors of a robot with its SRDF, as `with_srdf` needs them."""

    faults: tuple[Diagnostic, ...]
