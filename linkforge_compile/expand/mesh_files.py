"""Where the mesh files of a robot are: from the paths that its links write to the files on this machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import USE_OF_NOWHERE
from linkforge_compile.expand.loader import Loader
from linkforge_compile.expand.paths import names_in
from linkforge_compile.expand.uses import UseSite, locate
from linkforge_compile.roots import is_folder
from linkforge_compile.source import SourceFile, Span

FindMesh: TypeAlias = Callable[[str, Span, Diagnostics], Path | None]
"""Returns where the mesh should be whose path is written at a place; None where it leads nowhere, as reported."""

MakeSite: TypeAlias = Callable[[str, Span], UseSite]
"""Makes the site of a path that is written at a place."""


def mesh_finder(sites: Mapping[SourceFile, MakeSite], loader: Loader) -> FindMesh:
    """Return what finds the meshes of one use of a file; `sites` has every file that may have written their paths."""

    def find(path: str, where: Span, sink: Diagnostics) -> Path | None:
        make = sites.get(where.file)
        if make is None:
            return no_mesh(path, where, sink)
        site = make(path, where)
        target = locate(site, loader, sink)
        return target.path if target and loader.may_read(target.path, site.used, sink) else None

    return find


def no_mesh(path: str, where: Span, sink: Diagnostics) -> Path | None:
    """Report that a path leads nowhere, as those of a file that lies nowhere do."""
    sink.report(USE_OF_NOWHERE.at(where, path=path, reason="it is written in no file"))
    return None


def misspelt_part(path: Path) -> tuple[str, tuple[str, ...]]:
    """Return the first part of a path that is not there, and the names that stand in its place."""
    missing = path
    while not is_folder(missing.parent) and missing.parent != missing:
        missing = missing.parent
    return missing.name, names_in(missing.parent)
