"""The name of a file for who knows the repository but not this machine."""

from __future__ import annotations

import os
from pathlib import Path

from linkforge_compile.source import SourceFile


def name_under(root: Path, file: SourceFile) -> str | None:
    """Return a file's path from the root, with slashes; None for what does not lie under it, and for no file."""
    if file.path is None:
        return None
    # Not resolved: a symbolic link inside the repository is a file of the repository.
    whole = Path(os.path.abspath(file.path))  # noqa: PTH100  # Path.absolute keeps the `..` of what was typed
    return whole.relative_to(root).as_posix() if whole.is_relative_to(root) else None
