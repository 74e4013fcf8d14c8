"""Write files in one step: a reader sees the old file or the new one, never a part of one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def new_file(target: Path, content: bytes) -> Iterator[Path]:
    """Write a new file beside the target, flushed to disk, for the body to move to it; remove it if that does not.

    It has the permissions of the target, or those of any new file.
    """
    import tempfile

    target.parent.mkdir(parents=True, exist_ok=True)
    # The target's name may have the maximal length already.
    descriptor, name = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
    new = Path(name)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        new.chmod(_mode_of(target))
        yield new
    finally:
        with suppress(OSError):
            new.unlink()


def write_atomically(target: Path, content: bytes) -> None:
    """Write one file; OSError if it cannot be written."""
    with new_file(target, content) as new:
        new.replace(target)


def _mode_of(target: Path) -> int:
    """Return the file's permissions, or those of a new file; mkstemp's own are for the owner only."""
    if target.exists():
        return target.stat().st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
