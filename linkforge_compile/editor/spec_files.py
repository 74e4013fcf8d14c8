"""Finds the specs of a repository."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

from linkforge_compile.roots import Roots, exists, identity, is_file

SPEC_ENDINGS = (".robot.yaml", ".robot.yml")

MAX_SPECS = 200
"""An editor reads the schema of this many specs without noticeable delay."""

MAX_FOLDERS = 20_000

_OUTPUT_FOLDERS = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Folders that tools write; colcon copies specs into some of them."""


class TooManyFilesError(Exception):
    """There are more specs or folders than a repository of robots has; the message says how many."""


def find_specs(
    root: Path,
    at_most: int = MAX_SPECS,
    *,
    roots: Roots | None = None,
    unread: Callable[[OSError], object] | None = None,
    outside: Callable[[Path], object] | None = None,
) -> tuple[Path, ...]:
    """Return the specs in a folder and below, sorted, except in hidden, linked and output folders.

    Left out are links to specs that are found anyway, pipes, devices, and links that lead out of `roots` (default:
    those around the folder), because an untrusted repository must not name files of its user. `unread` is called with
    the error of each folder that cannot be read, `outside` with each such link.

    Raises:
        TooManyFilesError: There are more than `at_most` specs or MAX_FOLDERS folders.

    """
    roots = roots or Roots.around(root)
    found: list[Path] = []
    for spec in _walk(root, unread):
        # Checked before the file is touched, so that nothing is revealed about a file outside.
        if roots.are_left_by(spec):
            if outside is not None:
                outside(spec)
            continue
        if exists(spec) and not is_file(spec):  # a pipe or device, for which a reader may wait
            continue
        found.append(spec)
        if len(found) > at_most:
            raise TooManyFilesError(f"more than {at_most} specs")
    files = {identity(spec) for spec in found if not spec.is_symlink()}
    return tuple(sorted(spec for spec in found if not spec.is_symlink() or _is_another(spec, files)))


def _is_another(link: Path, files: set[str]) -> bool:
    """Whether a link leads to a file that is not in `files`; the lock of an editor is a link that leads nowhere."""
    return is_file(link) and identity(link) not in files


def _walk(root: Path, unread: Callable[[OSError], object] | None) -> Iterator[Path]:
    for number, (folder, inner, files) in enumerate(os.walk(root, onerror=unread), start=1):
        if number > MAX_FOLDERS:
            raise TooManyFilesError(f"more than {MAX_FOLDERS} folders")
        # os.walk does not enter what is removed here.
        inner[:] = sorted(name for name in inner if not name.startswith(".") and name not in _OUTPUT_FOLDERS)
        yield from (Path(folder, name) for name in files if name.endswith(SPEC_ENDINGS) and not name.startswith("."))
