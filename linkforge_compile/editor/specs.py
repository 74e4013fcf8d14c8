"""Finds the specs of a repository."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

from linkforge_compile.roots import Roots, exists, identity, is_file

SPEC_ENDINGS = (".robot.yaml", ".robot.yml")

MAX_SPECS = 200
"""As many as an editor reads the schema of without a wait."""

MAX_FOLDERS = 20_000

_NOT_SOURCES = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Folders of what tools made: colcon copies specs into some of them."""


class TooManyFilesError(Exception):
    """There is more below a folder than a repository of robots has; says what."""


def specs_below(
    root: Path,
    at_most: int = MAX_SPECS,
    *,
    roots: Roots | None = None,
    unread: Callable[[OSError], object] | None = None,
    outside: Callable[[Path], object] | None = None,
) -> tuple[Path, ...]:
    """Return the specs in a folder and below it, sorted; nothing hidden, nothing in linked folders and what tools made.

    A link to one of them is the same spec once more, and left out. So are pipes, devices, and links that lead out of
    `roots`, those around the folder unless said: whoever made a repository names no files of its user. `unread` takes
    the error of each folder that cannot be read, `outside` each such link; None where nobody wants to know.

    Raises:
        TooManyFilesError: For more specs than `at_most`, or than MAX_FOLDERS folders.

    """
    roots = roots or Roots.around(root)
    found: list[Path] = []
    for spec in _named_so(root, unread):
        # Before it is looked for, so that nothing is told of what is there.
        if roots.are_left_by(spec):
            if outside is not None:
                outside(spec)
            continue
        if _is_special(spec):
            continue
        found.append(spec)
        if len(found) > at_most:
            raise TooManyFilesError(f"more than {at_most} specs")
    files = {identity(spec) for spec in found if not spec.is_symlink()}
    return tuple(sorted(spec for spec in found if not spec.is_symlink() or _is_another(spec, files)))


def _is_another(link: Path, files: set[str]) -> bool:
    """Whether a link leads to a file that is not found as itself; that of an editor's lock leads nowhere."""
    return is_file(link) and identity(link) not in files


def _is_special(path: Path) -> bool:
    """Whether it is a pipe or a device, for which a reader may wait."""
    return exists(path) and not is_file(path)


def _named_so(root: Path, unread: Callable[[OSError], object] | None) -> Iterator[Path]:
    for number, (folder, inner, files) in enumerate(os.walk(root, onerror=unread), start=1):
        if number > MAX_FOLDERS:
            raise TooManyFilesError(f"more than {MAX_FOLDERS} folders")
        # What is taken out here is not walked into.
        inner[:] = sorted(name for name in inner if not name.startswith(".") and name not in _NOT_SOURCES)
        yield from (Path(folder, name) for name in files if name.endswith(SPEC_ENDINGS) and not name.startswith("."))
