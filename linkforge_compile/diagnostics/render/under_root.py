"""The name of a file for one who knows the repository but not this machine."""

from __future__ import annotations

import os
from pathlib import Path

from linkforge_compile.source import SourceFile


def name_under(root: Path, file: SourceFile) -> str | None:
    """Return a file's path from the root, with slashes; None for what does not lie under it, and for no file."""
    whole = absolute(file)
    return whole.relative_to(root).as_posix() if whole and whole.is_relative_to(root) else None


def absolute(file: SourceFile) -> Path | None:
    """Return a file's whole path, None for no file.

    It is not resolved: a symbolic link inside the repository is a file of the repository.
    """
    # Path.absolute would keep the `..` of what was typed.
    return Path(os.path.abspath(file.path)) if file.path else None  # noqa: PTH100
