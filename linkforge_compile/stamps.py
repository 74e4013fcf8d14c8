"""Whether files have changed: by their times and sizes, which a look at each tells without reading it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple


class _Stamp(NamedTuple):
    """What another content of a file would change: its time [ns], its size [bytes] and which file it is."""

    modified: int
    size: int
    file: int


_NO_FILE_HAS_IT = _Stamp(-1, -1, -1)


class Stamps:
    """Some files as they were last looked at; one that is not there is looked for."""

    def __init__(self, paths: Iterable[Path]) -> None:
        self._seen = {path: _stamp(path) for path in paths}

    @property
    def paths(self) -> tuple[Path, ...]:
        return tuple(self._seen)

    def look(self) -> tuple[Path, ...]:
        """Look at all of them, and return those that have changed, come or gone since the last look."""
        now = {path: _stamp(path) for path in self._seen}
        changed = tuple(path for path, stamp in now.items() if stamp != self._seen[path])
        self._seen = now
        return changed

    def follow(self, paths: Iterable[Path], began: int) -> None:
        """Watch these from now on, of which those that were watched already are as they were last looked at.

        `began` is when the first of them was read [ns since the epoch]. What was not watched and has changed since may
        be other than what was read, and so has changed at the next look.
        """
        self._seen = {path: self._seen[path] if path in self._seen else _stamp(path, began) for path in paths}


def _stamp(path: Path, began: int | None = None) -> _Stamp | None:
    try:
        status = path.stat()
    except (OSError, ValueError):  # ValueError for a name that no file can have
        return None
    # A file that is moved to its place keeps the time of its content; the time of the move is the other one.
    if began is not None and max(status.st_mtime_ns, status.st_ctime_ns) >= began:
        return _NO_FILE_HAS_IT
    return _Stamp(status.st_mtime_ns, status.st_size, status.st_ino)
