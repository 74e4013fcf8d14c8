"""Where `package://NAME/` leads: the order of places is part of the language."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.modules import UNKNOWN_PACKAGE
from linkforge_compile.manifest import package_name
from linkforge_compile.roots import Roots, as_walked, is_file, is_folder
from linkforge_compile.source import Span

if TYPE_CHECKING:
    from linkforge_compile.expand.loader import Loader

_NAME = re.compile(r"\w[\w.-]*")
"""The name of a folder that may be a package: no way to another folder, as `$(find ../..)` of a xacro would be."""

_SOURCES = "src"
"""The folder of a workspace of ROS in which its packages and repositories lie."""

_LEVELS_UP = 6
_TOP = 2
"""So many parts has the path of `/home`."""

_MOST_FOLDERS = 500
"""In so many folders a package is looked for that is nowhere."""


@dataclass(frozen=True)
class Package:
    """A package and the folder that its `package://` stands for."""

    name: str
    folder: Path


def find_package(name: str, declared: Mapping[str, Path], start: Path | None, roots: Roots) -> Path | None:
    """Return the folder of a package, None where it is nowhere that the roots let a spec look.

    `declared` are the places that the user named. After them come the source tree (a folder upward from `start`
    whose package.xml has that name), AMENT_PREFIX_PATH and ROS_PACKAGE_PATH.
    """
    if name in declared:
        return declared[name]
    if not _NAME.fullmatch(name):
        return None
    return next(chain(_in_source_tree(name, start, roots), _in_ament(name), _in_ros_1(name, roots)), None)


def _in_source_tree(name: str, start: Path | None, roots: Roots) -> Iterator[Path]:
    folder = as_walked(start) if start else None
    for candidate in (folder, *folder.parents) if folder else ():
        if package_name(candidate, roots) == name:
            yield candidate


def _in_ament(name: str) -> Iterator[Path]:
    for prefix in _search_path("AMENT_PREFIX_PATH"):
        folder = prefix / "share" / name
        if is_folder(folder):
            yield folder


def _in_ros_1(name: str, roots: Roots) -> Iterator[Path]:
    """A path may lead to the package, to the folder that holds it, or to one of repositories that hold it."""
    for root in _search_path("ROS_PACKAGE_PATH"):
        if package_name(root, roots) == name:
            yield root
        # A repository that lies there is a stranger's, and may hold links: whether they lead to a package is not told.
        manifests = (root / name / "package.xml", *sorted(root.glob(f"*/{name}/package.xml")))
        yield from (path.parent for path in manifests if roots.hold(path) and is_file(path))


def unknown_package(
    where: Span | None,
    name: str,
    start: Path | None,
    loader: Loader,
    *,
    near: Iterable[str],
    notes: Iterable[Note] = (),
) -> Diagnostic:
    """Return what tells that a package is nowhere, and where one of its name lies that was not searched.

    A workspace that is not sourced is not searched for what a spec names: another version of the package may be the
    one that is meant, and what lies beside a stranger's package is none of its business. To its user it is told.
    `packages` of the file is no way to one outside of the roots, for it adds none to them.
    """
    seen = _seen_around(start, loader).get(name) if start else None
    option = f"--package {name}=FOLDER"
    way = option if seen and not loader.roots.hold(seen) else f"'packages' of this file or {option}"
    found = [Note(f"there is one; write --package {name}={_quoted(_from_here(seen))}")] if seen else []
    return UNKNOWN_PACKAGE.at(where, name=name, way=way, near=near, notes=(*notes, *found))


def _seen_around(start: Path, loader: Loader) -> Mapping[str, Path]:
    """Return the packages near a folder, the nearest one of each name; looked for once in a compile."""
    if start not in loader.packages_around:
        roots = loader.roots
        folders = reversed([*islice(_folders_around(as_walked(start), roots), _MOST_FOLDERS)])
        loader.packages_around[start] = {name: folder for folder in folders if (name := package_name(folder, roots))}
    return loader.packages_around[start]


def _folders_around(start: Path, roots: Roots) -> Iterator[Path]:
    """Yield the folders beside those above a folder, and what is in them, up to the sources of its workspace.

    The top folders of a machine, where networks are mounted, and what lies in a home are not gone through.
    """
    for above in islice((start, *start.parents), _LEVELS_UP):
        if len(above.parts) <= _TOP or str(above) == os.path.expanduser("~"):  # noqa: PTH111 - Path.home() may raise
            return
        beside = _folders_in(above, roots)
        yield from beside
        for folder in beside:
            yield from _folders_in(folder, roots)
        if above.name == _SOURCES:
            return


def _folders_in(folder: Path, roots: Roots) -> list[Path]:
    """Return the folders in a folder, but for hidden ones and links that lead out of the roots."""
    try:
        with os.scandir(folder) as entries:
            found = [
                entry.name
                for entry in islice(entries, _MOST_FOLDERS)
                if not entry.name.startswith(".") and not roots.are_left_by(folder / entry.name) and entry.is_dir()
            ]
    except OSError:
        return []
    return [folder / name for name in sorted(found)]


def _from_here(folder: Path) -> str:
    """Return the shorter of a folder's two paths: as it is, and from where the command runs."""
    try:
        return min(str(folder), os.path.relpath(folder), key=len)
    except ValueError:  # on another drive of Windows
        return str(folder)


def _quoted(path: str) -> str:
    """Return a path as a shell takes it."""
    import shlex

    return shlex.quote(path)


def _search_path(variable: str) -> Iterator[Path]:
    return (Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry)
