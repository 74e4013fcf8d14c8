"""Paths as specs write them: where they lead, and how they are shown."""

from __future__ import annotations

import os
from itertools import islice
from pathlib import Path


def follow(folder: Path, target: str) -> Path:
    """Return where a relative path leads from a folder, in the shortest form that leads there too.

    `a/..` is nowhere else but here, unless `a` is a symbolic link.
    """
    for part in Path(target).parts:
        # os.path answers for names that no file can have, where pathlib raises.
        back = part == ".." and folder.name not in ("", "..") and not os.path.islink(folder)  # noqa: PTH114
        folder = folder.parent if back else folder / part
    return folder


def as_typed(path: Path) -> Path:
    """Return the path as a person in the working directory would type it: relative where it lies below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


_MAX_NAMES = 10_000


def names_in(folder: Path) -> tuple[str, ...]:
    """Return what lies in a folder, to offer for a name that does not; nothing where it cannot be read."""
    try:
        return tuple(entry.name for entry in islice(folder.iterdir(), _MAX_NAMES))
    except OSError:
        return ()
