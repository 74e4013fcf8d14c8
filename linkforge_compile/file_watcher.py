"""Detects changes of files by their times and sizes, without reading them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple


class _Stamp(NamedTuple):
    """What differs once a file has other content: its time [ns], its size [bytes] and its inode."""

    modified: int
    size: int
    inode: int


_NEVER_EQUAL = _Stamp(-1, -1, -1)


class FileWatcher:
    """Remembers the state of some files, which need not exist."""

    def __init__(self, paths: Iterable[Path] = ()) -> None:
        self._stamps = {path: _stamp(path) for path in paths}

    @property
    def paths(self) -> tuple[Path, ...]:
        return tuple(self._stamps)

    def poll(self) -> tuple[Path, ...]:
        """Return the files that were changed, created or deleted since the last poll."""
        now = {path: _stamp(path) for path in self._stamps}
        changed = tuple(path for path, stamp in now.items() if stamp != self._stamps[path])
        self._stamps = now
        return changed

    def track(self, paths: Iterable[Path], began: int) -> None:
        """Watch these files from now on; those that were watched already keep their last state.

        `began` is when the first of them was read [ns since the epoch]. A new file that has changed since may differ
        from what was read, so the next poll returns it.
        """
        self._stamps = {path: self._stamps[path] if path in self._stamps else _stamp(path, began) for path in paths}


def _stamp(path: Path, began: int | None = None) -> _Stamp | None:
    try:
        status = path.stat()
    except (OSError, ValueError):  # ValueError for a name that no file can have
        return None
    # A moved file keeps the time of its content; st_ctime is the time of the move.
    if began is not None and max(status.st_mtime_ns, status.st_ctime_ns) >= began:
        return _NEVER_EQUAL
    return _Stamp(status.st_mtime_ns, status.st_size, status.st_ino)
