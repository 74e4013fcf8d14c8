"""Decide which files a compile may read, so that an untrusted spec reads only what its user allows."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

MARKERS = ("package.xml", ".git")
"""One of these is in the top folder of a package or repository."""


@dataclass(frozen=True)
class Roots:
    """The folders in which every file that a spec names must lie, after links and `..` are resolved.

    `folders` are those of the spec and those that the user names, `files` single files that the user names, all as
    real paths. `installed` are the installation prefixes in the environment; links below them are trusted, such as
    those of colcon into the source tree.
    """

    folders: tuple[Path, ...] = ()
    files: frozenset[Path] = frozenset()
    installed: tuple[Path, ...] = ()
    is_anywhere: bool = False

    @classmethod
    def around(cls, place: Path | None, named: Iterable[Path] = ()) -> Roots:
        """Return the roots of a spec file, or of a text in a folder, None for no folder.

        `named` are further folders that the user names.
        """
        # A spec reached through a link may use files next to the link and next to the spec.
        starts = () if place is None else dict.fromkeys((as_walked(place), *_real((place,))))
        folders = (*map(top_of, starts), *named, *search_path("ROS_PACKAGE_PATH"))
        installed = tuple(search_path("AMENT_PREFIX_PATH"))
        return cls(_real(folders), installed=installed)

    def naming(self, files: Iterable[Path]) -> Roots:
        """Return the roots with further files that the user names."""
        return replace(self, files=self.files.union(_real(files)))

    def with_those_around(self, place: Path) -> Roots:
        """Return the roots with those of another file that the user names."""
        return replace(self, folders=tuple(dict.fromkeys((*self.folders, *Roots.around(place).folders))))

    def __str__(self) -> str:
        folders = [*map(str, self.folders), *(["what AMENT_PREFIX_PATH names"] if self.installed else [])]
        return ", ".join(folders) or "no folder"

    def hold(self, path: Path) -> bool:
        """Whether a file may be read, whether or not it exists."""
        if self.is_anywhere:
            return True
        followed = real_path(path)
        if followed is None:
            return False
        real = Path(followed)
        if real in self.files or any(real.is_relative_to(folder) for folder in self.folders):
            return True
        named = path.absolute()
        is_installed = ".." not in named.parts and any(named.is_relative_to(prefix) for prefix in self.installed)
        return is_installed or any(real.is_relative_to(prefix) for prefix in _real(self.installed))

    def are_left_by(self, path: Path) -> bool:
        """Whether a path is a link that leaves the roots; searches do not follow it."""
        # os.path handles paths without access; pathlib raises.
        return os.path.islink(path) and not self.hold(path)  # noqa: PTH114

    def reasons(self, path: Path) -> tuple[str, str]:
        """Return the notes for a path outside of the roots: how it leaves them, and what they are."""
        return self.way_out(path), f"files may be read only in {self}"

    def way_out(self, path: Path) -> str:
        """Return how a path leaves the roots, for a message.

        The target of a link is not shown, because it may be secret: a spec may come with a link to `/proc/self/exe`.
        """
        links = [step for step in (path, *path.parents) if self._has_link(step)]
        for link in links:
            if not self.hold(link):
                return f"the link '{link}' leads out"
        # `..` after a link that stays inside starts at the link's target, which is not shown.
        return "it leads out by '..'" if links else f"it leads to {os.path.normpath(path.absolute())}"

    def _has_link(self, path: Path) -> bool:
        # os.path handles paths without access; pathlib raises.
        around = real_path(path.parent) if os.path.islink(path) else None  # noqa: PTH114
        return around is not None and any(Path(around).is_relative_to(folder) for folder in self.folders)


ANYWHERE = Roots(is_anywhere=True)


def real_path(path: Path | str) -> str | None:
    """Resolve links and `..`, whether or not the file exists.

    None for a link without access such as `/proc/1/exe`, and for a path with characters that no path can have.
    """
    try:
        return os.path.realpath(path)
    except (OSError, UnicodeEncodeError):
        return None


def identity(path: Path | str) -> str:
    """Return the same string for all paths to one file; the path itself if it cannot be resolved."""
    return real_path(path) or str(path)


def as_walked(path: Path) -> Path:
    """Return an absolute path without `..` whose parents are the folders above it, with links kept.

    A link before a `..` is resolved, since `..` leads to the folder above its target.
    """
    steps = path.absolute().parts
    climbed = len(steps) - steps[::-1].index("..") if ".." in steps else 0
    return Path(identity(Path(*steps[:climbed])), *steps[climbed:]) if climbed else Path(*steps)


def top_of(place: Path) -> Path:
    """Return the package or repository of a file or folder, else the file's folder or the folder itself."""
    # os.path handles invalid names and paths without access; pathlib raises.
    folder = place if os.path.isdir(place) else place.parent  # noqa: PTH112
    # A marker that is a link counts without following it, so as not to reveal whether its target exists.
    tops = (top for top in (folder, *folder.parents) if any(map(os.path.lexists, (top / marker for marker in MARKERS))))
    return next(tops, folder)


def search_path(variable: str) -> Iterator[Path]:
    """Yield the folders that a variable of the environment lists."""
    return (Path(entry).absolute() for entry in os.environ.get(variable, "").split(os.pathsep) if entry)


def _real(paths: Iterable[Path]) -> tuple[Path, ...]:
    """Return the real paths of those that can be resolved."""
    return tuple(dict.fromkeys(Path(real) for real in map(real_path, paths) if real is not None))


# os.path handles paths without access; pathlib raises.


def exists(path: Path) -> bool:
    """Whether there is anything at a path; False without access."""
    return os.path.exists(path)  # noqa: PTH110 see above


def is_file(path: Path) -> bool:
    """Whether there is a regular file at a path; False without access."""
    return os.path.isfile(path)  # noqa: PTH113 see above


def is_folder(path: Path) -> bool:
    """Whether there is a folder at a path; False without access."""
    return os.path.isdir(path)  # noqa: PTH112 see above


# The file may be hostile: this pattern does not backtrack.
_NAME_TAG = re.compile(r"<name>([^<]*)</name>")
_MAX_MANIFEST_BYTES = 1024 * 1024


def package_name(folder: Path, roots: Roots = ANYWHERE) -> str | None:
    """Return the name in a folder's package.xml; None if there is none, or it is a link that leaves the roots.

    It is searched as text, because one tag does not justify parsing untrusted XML with its entities.
    """
    manifest = folder / "package.xml"
    if roots.are_left_by(manifest) or not is_file(manifest):  # reading a pipe would block
        return None
    try:
        with manifest.open("rb") as stream:
            text = stream.read(_MAX_MANIFEST_BYTES).decode("utf-8", errors="replace")
    except OSError:
        return None
    first, *rest = text.split("<!--")
    match = _NAME_TAG.search("".join((first, *(piece.partition("-->")[2] for piece in rest))))
    return match[1].strip() if match else None
