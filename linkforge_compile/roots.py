"""Which files a compile may read: whoever wrote the spec, it reaches nothing but what its user gave."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

MARKERS = ("package.xml", ".git")
"""What the top folder of a package or repository holds."""


@dataclass(frozen=True)
class Roots:
    """The folders in which a file must lie that a spec names, wherever links and `..` lead.

    `folders` are those of the spec and those that its user named, `files` single files that he named, all as real
    paths. `installed` are the prefixes of installations in the environment, as it names them: links below them were
    made by whoever installed it, such as those by which colcon leads each file into its source tree.
    """

    folders: tuple[Path, ...] = ()
    files: frozenset[Path] = frozenset()
    installed: tuple[Path, ...] = ()
    is_anywhere: bool = False

    @classmethod
    def around(cls, place: Path | None, named: Iterable[Path] = ()) -> Roots:
        """Return the roots of a spec file, or of a text in a folder; None for a text that lies nowhere.

        `named` are folders that the user named himself.
        """
        # A spec that is reached by a link may use what lies beside the link, and beside itself.
        ways = () if place is None else dict.fromkeys((as_walked(place), *_real((place,))))
        folders = (*map(_top_of, ways), *named, *_search_path("ROS_PACKAGE_PATH"))
        installed = tuple(_search_path("AMENT_PREFIX_PATH"))
        return cls(_real(folders), installed=installed)

    def naming(self, files: Iterable[Path]) -> Roots:
        """Return the same roots with single files that the user named himself."""
        return replace(self, files=self.files.union(_real(files)))

    def with_those_around(self, place: Path) -> Roots:
        """Return the same roots with those of another file that the user named beside the spec."""
        return replace(self, folders=tuple(dict.fromkeys((*self.folders, *Roots.around(place).folders))))

    def __str__(self) -> str:
        folders = [*map(str, self.folders), *(["what AMENT_PREFIX_PATH names"] if self.installed else [])]
        return ", ".join(folders) or "no folder"

    def hold(self, path: Path) -> bool:
        """Whether a file may be read, be it there or not."""
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
        """Whether a path is a link that leads out of them, which no search follows: it may be a stranger's."""
        # os.path answers for what may not be looked at as well, where pathlib raises.
        return os.path.islink(path) and not self.hold(path)  # noqa: PTH114

    def reasons(self, path: Path) -> tuple[str, str]:
        """Return why a path may not be read that they do not hold, for notes: how it leads out, and of what."""
        return self.way_out(path), f"what may be read lies in {self}"

    def way_out(self, path: Path) -> str:
        """Return how a path that they do not hold leads out of them, for a message: by what in them, or to where.

        Where links lead is none of a stranger's business, who may have made one to `/proc/self/exe`: none is followed.
        """
        links = [step for step in (path, *path.parents) if self._has_link(step)]
        for link in links:
            if not self.hold(link):
                return f"the link '{link}' leads out"
        # Behind a link that stays within, `..` climbs from where it leads: to name that would tell of the link.
        return "it leads out by '..'" if links else f"it leads to {os.path.normpath(path.absolute())}"

    def _has_link(self, path: Path) -> bool:
        # os.path answers for what may not be looked at as well, where pathlib raises.
        around = real_path(path.parent) if os.path.islink(path) else None  # noqa: PTH114
        return around is not None and any(Path(around).is_relative_to(folder) for folder in self.folders)


ANYWHERE = Roots(is_anywhere=True)


def real_path(path: Path | str) -> str | None:
    """Return where links and `..` lead, be there a file or not; None where a link may not be looked at.

    Links to what a process of somebody else has open are such: `/proc/1/exe`.
    """
    try:
        return os.path.realpath(path)
    except OSError:
        return None


def identity(path: Path | str) -> str:
    """Return what all paths to one file have in common; of one that may not be looked at, the path."""
    return real_path(path) or str(path)


def as_walked(path: Path) -> Path:
    """Return an absolute path whose parents are the folders above it: with links as they were walked, without `..`.

    `here/../there` does not lie in `here`, and `..` behind a link is the folder above where it leads.
    """
    steps = path.absolute().parts
    climbed = len(steps) - steps[::-1].index("..") if ".." in steps else 0
    return Path(identity(Path(*steps[:climbed])), *steps[climbed:]) if climbed else Path(*steps)


def _top_of(place: Path) -> Path:
    """Return the package or repository in which a file or folder lies, else its folder, or the folder itself."""
    # os.path answers for names that no file can have and what may not be looked at, where pathlib raises.
    folder = place if os.path.isdir(place) else place.parent  # noqa: PTH112
    # A marker that is a link is one wherever that leads: whether there is anything is none of a stranger's business.
    tops = (top for top in (folder, *folder.parents) if any(map(os.path.lexists, (top / marker for marker in MARKERS))))
    return next(tops, folder)


def _search_path(variable: str) -> Iterator[Path]:
    return (Path(entry).absolute() for entry in os.environ.get(variable, "").split(os.pathsep) if entry)


def _real(paths: Iterable[Path]) -> tuple[Path, ...]:
    """Return the real ones of paths, without those that may not be looked at."""
    return tuple(dict.fromkeys(Path(real) for real in map(real_path, paths) if real is not None))


# os.path answers for what may not be looked at as well, where pathlib raises.


def exists(path: Path) -> bool:
    """Whether there is anything at a path; no where that may not be looked at."""
    return os.path.exists(path)  # noqa: PTH110 see above


def is_file(path: Path) -> bool:
    """Whether there is a regular file at a path; no where that may not be looked at."""
    return os.path.isfile(path)  # noqa: PTH113 see above


def is_folder(path: Path) -> bool:
    """Whether there is a folder at a path; no where that may not be looked at."""
    return os.path.isdir(path)  # noqa: PTH112 see above
