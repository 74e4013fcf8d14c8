"""Follow paths as specs write them, find the file that a path is relative to, and show paths in messages."""

from __future__ import annotations

import os
from itertools import islice
from pathlib import Path

from linkforge_compile.diagnostics import Note
from linkforge_compile.roots import is_folder
from linkforge_compile.source import Span
from linkforge_compile.source.span import Located
from linkforge_compile.syntax import YamlScalar

_MAX_NAMES = 10_000


def follow(folder: Path, target: str) -> Path:
    """Return where a relative path leads from a folder, with `a/..` removed unless `a` is a symbolic link."""
    for part in Path(target).parts:
        # os.path handles names that no file can have; pathlib raises.
        can_drop = part == ".." and folder.name not in ("", "..") and not os.path.islink(folder)  # noqa: PTH114
        folder = folder.parent if can_drop else folder / part
    return folder


def as_typed(path: Path) -> Path:
    """Return the path as a user in the working directory would type it: relative if it lies below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def names_in(folder: Path) -> tuple[str, ...]:
    """Return the names in a folder, as suggestions for a missing one; empty if it cannot be read."""
    try:
        return tuple(entry.name for entry in islice(folder.iterdir(), _MAX_NAMES))
    except OSError:
        return ()


def misspelt_part(path: Path) -> tuple[str, tuple[str, ...]]:
    """Return the first part of a path that does not exist, and the names in the folder where it should be."""
    missing = path
    while not is_folder(missing.parent) and missing.parent != missing:
        missing = missing.parent
    return missing.name, names_in(missing.parent)


def path_base(path: Located) -> Span:
    """Return the span whose file a relative path is relative to.

    That is the file in which the text was written, even if an expression of an including or included file passes it
    on. A parameter of type `file` is already relative to the file that uses it.
    """
    where = path.span
    origin = where.origin
    if origin is None or origin.is_data or _comes_from_other_spec(where):
        return where
    return where if isinstance(path, YamlScalar) and _is_rebased(path.value) else origin.span


def searched_note(path: Path, text: str, where: Span) -> Note:
    """Return a note that shows where the file named by a text was looked for, and why there if that is surprising."""
    is_relative = "://" not in text and not Path(text).is_absolute()
    if not is_relative or not _comes_from_other_spec(where) or _is_rebased(text):
        return Note(f"looked for it at {as_typed(path)}")
    why = "a path in text starts at the file that uses it; declare 'type: file' for one that starts where it is written"
    return Note(f"looked for it at {as_typed(path)}: {why}")


def _is_rebased(value: object) -> bool:
    """Whether an expression computed the path relative to the file that uses it."""
    from linkforge_compile.expressions import PathText  # imported already if any expression was computed

    return isinstance(value, PathText)


def _comes_from_other_spec(where: Span) -> bool:
    """Whether the value at a place was written in another spec; included files belong to the including spec."""
    origin = where.origin
    return origin is not None and origin.span.file.outermost is not where.file.outermost
