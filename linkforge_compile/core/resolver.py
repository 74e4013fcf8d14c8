"""From a URI in a robot description to the file on this machine."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, field
from itertools import islice
from pathlib import Path
from typing import Protocol, runtime_checkable

from linkforge_compile.roots import ANYWHERE, Roots, exists, identity, package_name

_PACKAGE_URI = re.compile(r"package:/{0,2}(?P<package>[^/]+)/?(?P<path>.*)", re.DOTALL)
_WINDOWS_DRIVE = re.compile(r"^/(?=[A-Za-z]:)")
_LEVELS_UP = 10


@runtime_checkable
class IResourceResolver(Protocol):
    """Finds the file of a URI."""

    def resolve(self, uri: str, relative_to: Path | None = None) -> Path:
        """Return the absolute path of an existing file or folder.

        `relative_to` is the folder that relative paths start from; None for nowhere in particular.

        Raises:
            FileNotFoundError: There is no such file.

        """
        ...


@dataclass(eq=False)
class FileSystemResolver:
    """Finds `package://`, `file://`, absolute and relative paths in the file system.

    Packages are in the folders that `packages` gives by their names; others are looked for in
    `additional_search_paths`, then in those of ROS_PACKAGE_PATH, then under `share` of those of AMENT_PREFIX_PATH,
    then from `relative_to` up to ten folders outwards, where a package is a folder of its name or with a package.xml
    with that name, unless it is a symbolic link out of `roots`. The first folder that holds the file wins.
    Relative paths are looked for in `relative_to`, then in the current folder.
    """

    additional_search_paths: list[Path] | None = None
    _: KW_ONLY
    packages: Mapping[str, Path] = field(default_factory=dict)
    roots: Roots = ANYWHERE

    def resolve(self, uri: str, relative_to: Path | None = None) -> Path:
        """Return the absolute path of an existing file or folder.

        Raises:
            FileNotFoundError: There is no such file.

        """
        for candidate in self._candidates(uri, relative_to):
            if exists(candidate):
                return candidate.absolute()
        raise FileNotFoundError(uri)

    def _candidates(self, uri: str, relative_to: Path | None) -> Iterator[Path]:
        if package_uri := _PACKAGE_URI.fullmatch(uri):
            for folder in self._package_folders(package_uri["package"], relative_to or Path.cwd()):
                yield folder / package_uri["path"]
        elif uri.startswith("file://"):
            yield Path(_WINDOWS_DRIVE.sub("", uri.removeprefix("file://")))
        elif uri:
            if relative_to is not None:
                yield Path(identity(relative_to / uri))
            yield Path(uri)

    def _package_folders(self, package: str, start: Path) -> Iterator[Path]:
        if package in self.packages:
            yield self.packages[package]
        ros = _folders_of("ROS_PACKAGE_PATH")
        ament = (prefix / "share" for prefix in _folders_of("AMENT_PREFIX_PATH"))
        for folder in (*(self.additional_search_paths or ()), *ros, *ament):
            yield Path(folder) / package
            if Path(folder).name == package:
                yield Path(folder)
        start = Path(identity(start))
        for folder in islice((start, *start.parents), _LEVELS_UP):
            if folder.name == package or package_name(folder, self.roots) == package:
                yield folder


def _folders_of(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry.strip()]
