"""The files of a spec by their digests, which are all that a worker has of it, and the tree that it makes of them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from threading import Lock
from typing import NamedTuple

from linkforge_compile.roots import MARKERS, as_walked, exists, is_file
from linkforge_compile.sweep.errors import SweepError

SEARCH_PATHS = ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH")


class Bundle(NamedTuple):
    """Files as they lie on the client.

    `files` are the digests of files by absolute path, `folders` empty ones that mark a repository. `folder` is the
    client's working directory, and `environment` has the variables that name more places to search.
    """

    folder: str
    environment: Mapping[str, str]
    files: Mapping[str, str] = {}
    folders: tuple[str, ...] = ()

    @classmethod
    def of_here(cls) -> Bundle:
        """Return a bundle without files, of this process's working directory and environment."""
        names = (*SEARCH_PATHS, "LINKFORGE_LIMITS")
        return cls(str(Path.cwd()), {name: os.environ[name] for name in names if name in os.environ})


class Files(NamedTuple):
    """A bundle, and the contents of its files by digest."""

    bundle: Bundle
    blobs: dict[str, bytes]

    def with_paths(self, paths: Iterable[Path]) -> Files:
        """Return the files with more, as far as they exist, and what marks the packages around them.

        Without new ones, the bundle is the same object. `blobs` receives the contents.
        """
        files, folders = dict(self.bundle.files), dict.fromkeys(self.bundle.folders)
        for path in map(as_walked, paths):
            if str(path) in files or not is_file(path):
                continue
            for one in (path, *_manifests(path)):
                if str(one) not in files:
                    content = one.read_bytes()
                    files[str(one)] = digest = sha256(content).hexdigest()
                    self.blobs[digest] = content
            folders |= dict.fromkeys(str(above / ".git") for above in path.parents if exists(above / ".git"))
        if len(files) == len(self.bundle.files):
            return self
        return self._replace(bundle=self.bundle._replace(files=files, folders=tuple(folders)))


def _manifests(path: Path) -> Iterator[Path]:
    return (above / MARKERS[0] for above in path.parents if is_file(above / MARKERS[0]))


# In a worker

_changing_process = Lock()
"""Held while the working directory and the environment are those of a client."""


class Tree:
    """The files of a bundle below a folder of this machine, at the paths that they have on the client."""

    def __init__(self, top: Path, bundle: Bundle, blobs: Mapping[str, bytes]) -> None:
        """Write the files; `blobs` has their contents by digest."""
        self.top, self.folder = str(top), bundle.folder
        self._files: set[str] = set()
        # The upper end of what a spec may read here, also where the client's folders have no mark of a repository.
        for folder in (top / ".git", Path(self.place(self.folder))):
            folder.mkdir(parents=True, exist_ok=True)
        self._environment = {
            name: os.pathsep.join(map(self.place, value.split(os.pathsep))) if name in SEARCH_PATHS else value
            for name, value in bundle.environment.items()
        }
        self.add(bundle, blobs)

    def add(self, bundle: Bundle, blobs: Mapping[str, bytes]) -> None:
        """Write the files that a larger bundle has in addition; SweepError for contents of another digest."""
        with _changing_process:
            for path in bundle.files.keys() - self._files:
                digest = bundle.files[path]
                content = blobs[digest]
                if sha256(content).hexdigest() != digest:
                    raise SweepError(f"a file arrived changed, with another digest than {digest}")
                place = Path(self.place(path))
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_bytes(content)
                self._files.add(path)
            for folder in bundle.folders:
                Path(self.place(folder)).mkdir(parents=True, exist_ok=True)

    def place(self, path: str) -> str:
        """Return where an absolute path of the client is here; a relative one stays, as `inside` changes the folder."""
        return str(Path(self.top, *Path(path).parts[1:])) if Path(path).is_absolute() else path

    @contextmanager
    def inside(self) -> Iterator[None]:
        """Be in the client's working directory, with its search paths: both are of the whole process.

        One compile at a time does this. Where the worker has threads, they wait for each other, as for Python's lock.
        """
        names = (*SEARCH_PATHS, "LINKFORGE_LIMITS")
        with _changing_process:
            before, folder = {name: os.environ.pop(name, None) for name in names}, Path.cwd()
            os.environ.update(self._environment)
            os.chdir(self.place(self.folder))
            try:
                yield
            finally:
                os.chdir(folder)
                for name, value in before.items():
                    os.environ.pop(name, None)
                    if value is not None:
                        os.environ[name] = value


def changed_files(files: Mapping[str, str]) -> list[str]:
    """Return the files, of digests by path, that have another content by now, or are gone."""

    def digest_of(path: str) -> str | None:
        try:
            return sha256(Path(path).read_bytes()).hexdigest()
        except OSError:
            return None

    return [path for path, digest in files.items() if digest_of(path) != digest]
