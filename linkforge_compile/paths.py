"""Follow paths as specs write them, and find packages."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.modules import UNKNOWN_PACKAGE
from linkforge_compile.roots import Roots, as_walked, is_file, is_folder, package_name, search_path
from linkforge_compile.source import Located, Span
from linkforge_compile.syntax import YamlScalar

_MAX_NAMES = 10_000


def follow(folder: Path, target: str) -> Path:
    """Return where a relative path leads from a folder, with `a/..` removed unless `a` is a symbolic link."""
    for part in Path(target).parts:
        # os.path handles names that no file can have; pathlib raises.
        can_drop = part == ".." and folder.name not in ("", "..") and not os.path.islink(folder)  # noqa: PTH114
        folder = folder.parent if can_drop else folder / part
    return folder


def as_typed(path: Path) -> Path:
    """Return the path as a user in the working directory would type it: relative if it lies below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def names_in(folder: Path) -> tuple[str, ...]:
    """Return the names in a folder, as suggestions for a missing one; empty if it cannot be read."""
    try:
        return tuple(entry.name for entry in islice(folder.iterdir(), _MAX_NAMES))
    except OSError:
        return ()


def misspelt_part(path: Path) -> tuple[str, tuple[str, ...]]:
    """Return the first part of a path that does not exist, and the names in the folder where it should be."""
    missing = path
    while not is_folder(missing.parent) and missing.parent != missing:
        missing = missing.parent
    return missing.name, names_in(missing.parent)


def path_base(path: Located) -> Span:
    """Return the span whose file a relative path is relative to.

    That is the file in which the text was written, even if an expression of an including or included file passes it
    on. A parameter of type `file` is already relative to the file that uses it.
    """
    where = path.span
    origin = where.origin
    if origin is None or origin.is_data or _comes_from_other_spec(where):
        return where
    return where if isinstance(path, YamlScalar) and _is_rebased(path.value) else origin.span


def searched_note(path: Path, text: str, where: Span) -> Note:
    """Return a note that shows where the file named by a text was looked for, and why there if that is surprising."""
    is_relative = "://" not in text and not Path(text).is_absolute()
    if not is_relative or not _comes_from_other_spec(where) or _is_rebased(text):
        return Note(f"looked for it at {as_typed(path)}")
    why = "a path in text starts at the file that uses it; declare 'type: file' for one that starts where it is written"
    return Note(f"looked for it at {as_typed(path)}: {why}")


def _is_rebased(value: object) -> bool:
    """Whether an expression computed the path relative to the file that uses it."""
    from linkforge_compile.expressions import PathText  # imported already if any expression was computed

    return isinstance(value, PathText)


def _comes_from_other_spec(where: Span) -> bool:
    """Whether the value at a place was written in another spec; included files belong to the including spec."""
    origin = where.origin
    return origin is not None and origin.span.file.outermost is not where.file.outermost


_PACKAGE_PATH = re.compile(r"([A-Za-z_][\w.-]*)(?:/+([^/].*)?)?", re.DOTALL)
_NAME = re.compile(r"\w[\w.-]*")
"""What may be the name of a package folder; excludes paths such as those of `$(find ../..)` in a xacro."""

_WORKSPACE_SOURCES = "src"
"""The folder of a ROS workspace that holds its packages and repositories."""

_LEVELS_UP = 6
_MIN_PARTS = 2
"""The nearby search stops at folders with no more parts in their path than `/home` has."""

_MAX_FOLDERS = 500
"""How many nearby folders are searched for a package that was not found."""

NearbyPackages: TypeAlias = "dict[Path, Mapping[str, Path]]"
"""The packages near a folder by name, for each folder around which a package was missed; filled on demand."""


@dataclass(frozen=True)
class Package:
    """A package and the folder that its `package://` stands for."""

    name: str
    folder: Path


def find_package(name: str, declared: Mapping[str, Path], start: Path | None, roots: Roots) -> Path | None:
    """Return the folder of a package, None if it is not found within the roots.

    `declared` are the folders that the user or the spec names. After them come the folders upward from `start` whose
    package.xml has the name, AMENT_PREFIX_PATH and ROS_PACKAGE_PATH.
    """
    return next((place.folder for place in searched_places(name, declared, start, roots) if place.folder), None)


def folders_for_xacro(name: str, declared: Mapping[str, Path], start: Path | None, roots: Roots) -> Iterator[Path]:
    """Yield the folders that `$(find NAME)` of a xacro may stand for, the best first.

    As for xacro, the sourced environment comes before the source tree, where files that CMake installs elsewhere have
    another path.
    """
    if name in declared:
        yield declared[name]
    elif _NAME.fullmatch(name):
        yield from chain(_in_ament(name), _in_ros_1(name, roots), _in_source_tree(name, start, roots))


def split_package_path(path: str) -> tuple[str, str] | None:
    """Return the package of `NAME/PATH`, what follows `package://`, and the path in it; None for any other text.

    The path is empty for a package alone.
    """
    parts = _PACKAGE_PATH.fullmatch(path)
    return (parts[1], parts[2] or "") if parts else None


class SearchedPlace(NamedTuple):
    """A place where a package is looked for: its `source`, such as a variable, and what the place is to the package."""

    source: str
    finding: str
    folder: Path | None
    """The folder of the package, None if it is not there."""


def searched_places(
    name: str, declared: Mapping[str, Path], start: Path | None, roots: Roots
) -> Iterator[SearchedPlace]:
    """Yield all places where `find_package` looks for a package, in its order; the first with a folder is used."""
    others = f"not among {', '.join(sorted(declared))}" if declared else "none declared"
    yield SearchedPlace("declared", str(declared.get(name, others)), declared.get(name))
    if not _NAME.fullmatch(name):
        return
    above = as_walked(start) if start else None
    manifests = 0
    for folder in (above, *above.parents) if above else ():
        if found := package_name(folder, roots):
            manifests += 1
            yield SearchedPlace("folders above", f"{folder} is package {found}", folder if found == name else None)
    if above and not manifests:
        yield SearchedPlace("folders above", f"no package.xml in {above} or above", None)
    for variable, folders in (
        ("AMENT_PREFIX_PATH", {prefix: _in_prefix(prefix, name) for prefix in search_path("AMENT_PREFIX_PATH")}),
        ("ROS_PACKAGE_PATH", {root: _in_root(root, name, roots) for root in search_path("ROS_PACKAGE_PATH")}),
    ):
        for searched, candidates in folders.items():
            candidate = next(candidates, None)
            missing = f"not in {searched}" if is_folder(searched) else f"{searched}, which is not a folder"
            yield SearchedPlace(variable, str(candidate or missing), candidate)
        if not folders:
            yield SearchedPlace(variable, "not set", None)


def _in_source_tree(name: str, start: Path | None, roots: Roots) -> Iterator[Path]:
    folder = as_walked(start) if start else None
    for candidate in (folder, *folder.parents) if folder else ():
        if package_name(candidate, roots) == name:
            yield candidate


def _in_ament(name: str) -> Iterator[Path]:
    for prefix in search_path("AMENT_PREFIX_PATH"):
        yield from _in_prefix(prefix, name)


def _in_prefix(prefix: Path, name: str) -> Iterator[Path]:
    folder = prefix / "share" / name
    if is_folder(folder):
        yield folder


def _in_ros_1(name: str, roots: Roots) -> Iterator[Path]:
    """Yield matches of ROS_PACKAGE_PATH, which lists packages, folders of packages and folders of repositories."""
    for root in search_path("ROS_PACKAGE_PATH"):
        yield from _in_root(root, name, roots)


def _in_root(root: Path, name: str, roots: Roots) -> Iterator[Path]:
    if package_name(root, roots) == name:
        yield root
    # Links in an untrusted repository may lead out of the roots; do not reveal whether they lead to a package.
    manifests = (root / name / "package.xml", *sorted(root.glob(f"*/{name}/package.xml")))
    yield from (path.parent for path in manifests if roots.hold(path) and is_file(path))


def packages_in_environment() -> dict[str, Path]:
    """Return the folders of all packages that AMENT_PREFIX_PATH and ROS_PACKAGE_PATH name, the first of each name."""
    folders: dict[str, Path] = {}
    for prefix in search_path("AMENT_PREFIX_PATH"):
        for folder in filter(is_folder, sorted(prefix.glob("share/*"))):
            folders.setdefault(folder.name, folder)
    for root in search_path("ROS_PACKAGE_PATH"):
        folders.setdefault(package_name(root) or "", root)
        for manifest in (*sorted(root.glob("*/package.xml")), *sorted(root.glob("*/*/package.xml"))):
            folders.setdefault(manifest.parent.name, manifest.parent)
    folders.pop("", None)
    return folders


def unknown_package(
    where: Span | None,
    name: str,
    start: Path | None,
    roots: Roots,
    nearby: NearbyPackages,
    *,
    near: Iterable[str],
    notes: Iterable[Note] = (),
) -> Diagnostic:
    """Return the diagnostic for a package that was not found, with a note if one of that name is nearby.

    `nearby` caches the search of the workspace around `start`. Packages found there are only suggested, never used: a
    workspace that is not sourced may hold another version. Outside the roots only --package helps, because the
    `packages` of a file cannot add roots.
    """
    seen = packages_around(start, roots, nearby).get(name) if start else None
    option = f"--package {name}=FOLDER"
    way = option if seen and not roots.hold(seen) else f"'packages' of this file or {option}"
    found = [Note(f"there is one; write --package {name}={shlex.quote(shortest(seen))}")] if seen else []
    return UNKNOWN_PACKAGE.at(where, name=name, way=way, near=near, notes=(*notes, *found))


def packages_around(start: Path, roots: Roots, nearby: NearbyPackages) -> Mapping[str, Path]:
    """Return the packages near a folder, the nearest of each name."""
    if start not in nearby:
        folders = reversed([*islice(_folders_around(as_walked(start), roots), _MAX_FOLDERS)])
        nearby[start] = {name: folder for folder in folders if (name := package_name(folder, roots))}
    return nearby[start]


def _folders_around(start: Path, roots: Roots) -> Iterator[Path]:
    """Yield the siblings of each folder upward and their subfolders, up to the sources of the workspace.

    Top-level folders, where networks may be mounted, and the home folder itself are not searched.
    """
    for above in islice((start, *start.parents), _LEVELS_UP):
        if len(above.parts) <= _MIN_PARTS or str(above) == os.path.expanduser("~"):  # noqa: PTH111 - home() may raise
            return
        siblings = _folders_in(above, roots)
        yield from siblings
        for folder in siblings:
            yield from _folders_in(folder, roots)
        if above.name == _WORKSPACE_SOURCES:
            return


def _folders_in(folder: Path, roots: Roots) -> list[Path]:
    """Return the folders in a folder, without hidden ones and links that leave the roots."""
    try:
        with os.scandir(folder) as entries:
            found = [
                entry.name
                for entry in islice(entries, _MAX_FOLDERS)
                if not entry.name.startswith(".") and not roots.are_left_by(folder / entry.name) and entry.is_dir()
            ]
    except OSError:
        return []
    return [folder / name for name in sorted(found)]


def shortest(folder: Path) -> str:
    """Return the shorter of a folder's absolute path and its path from the working directory."""
    try:
        return min(str(folder), os.path.relpath(folder), key=len)
    except ValueError:  # another drive of Windows
        return str(folder)
