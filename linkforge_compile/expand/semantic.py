"""An SRDF beside a vendor's robot, or the xacro of one: the two make one spec."""

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
    from linkforge_compile.expand.xacro import XacroUse
    from linkforge_compile.importers.document import Move


class Semantic(NamedTuple):
    """An SRDF in a folder, as `package` was walked to it: its text, which a xacro was expanded to.

    `moved` puts the elements where they were written, None for where they are. `files` are those in which they were
    written, and `arguments` the names of those that a xacro takes.
    """

    text: SourceFile
    files: tuple[SourceFile, ...]
    folder: Path
    package: Package | None = None
    moved: Move | None = None
    arguments: frozenset[str] = frozenset()


def open_semantic(use: XacroUse, loader: Loader, sink: Diagnostics) -> Semantic | None:
    """Read an SRDF, and expand it if it is a xacro; None where it cannot be had, which is reported."""
    folder = use.path.parent
    if use.path.suffix.lower() != XACRO:
        file = loader.open_xml(use.path, sink, use.used if use.used.where else None)
        return Semantic(file, (file,), folder, use.package) if file else None
    from linkforge_compile.expand.xacro import expand_xacro

    # The URDF is read next, and tells of arguments that neither takes.
    expansion = expand_xacro(replace(use, taken=None), loader, sink)
    if expansion is None:
        return None
    return Semantic(expansion.text, expansion.files, folder, use.package, expansion.moved, expansion.arguments)


def with_semantic(
    spec: SpecFile, semantic: Semantic, use: XacroUse, loader: Loader, sink: Diagnostics
) -> SpecFile | None:
    """Return a vendor's robot with what its SRDF says, which `use` names; None where it is none, as is reported."""
    from linkforge_compile.importers.comments import Comments
    from linkforge_compile.importers.document import Imported
    from linkforge_compile.importers.srdf import with_srdf

    def together(tree: YamlMap) -> SpecFile:
        parts = {file: SpecFile(file, tree, semantic.folder, semantic.package) for file in semantic.files}
        return replace(spec, tree=tree, included={**spec.included, **parts})

    def judged(tree: YamlMap) -> _Judged:
        return _Judged(loader.check_spec(together(tree), loader))

    imported = Imported(spec.tree, Comments({}, {}))
    inside = with_use_trace(sink, (use.used.where,))
    read = with_srdf(imported, semantic.text, judged, inside, semantic.moved)
    return together(read[0].tree) if read else None


class _Judged(NamedTuple):
    """The errors of a vendor's robot by itself: what of its SRDF they are told of is kept raw, as an import does."""

    faults: tuple[Diagnostic, ...]
