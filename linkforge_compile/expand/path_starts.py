"""Where a relative path starts that an expression hands on, and what is said of it where it leads to no file."""

from __future__ import annotations

from pathlib import Path

from linkforge_compile.diagnostics import Note
from linkforge_compile.expand.paths import as_typed
from linkforge_compile.source import Span
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax import YamlScalar


def written_place(path: Located) -> Span:
    """Return the place in whose file a path starts: where it was written that a name of the same whole file hands on.

    Included files are one with the file that includes them, but a relative path starts where its own file lies. That of
    a parameter of type `file` starts where it is used already.
    """
    where = path.span
    origin = where.origin
    if origin is None or origin.is_data or _is_foreign(where):
        return where
    return where if isinstance(path, YamlScalar) and _is_moved(path.value) else origin.span


def looked_for(path: Path, text: str, where: Span) -> Note:
    """Return where a file was looked for that a text at a place names, and why there if another file wrote it."""
    is_relative = "://" not in text and not Path(text).is_absolute()
    if not is_relative or not _is_foreign(where) or _is_moved(text):
        return Note(f"looked for it at {as_typed(path)}")
    why = "a path in text starts at the file that uses it; declare 'type: file' for one that starts where it is written"
    return Note(f"looked for it at {as_typed(path)}: {why}")


def _is_moved(value: object) -> bool:
    """Whether an expression has handed it on as a path that starts where it is used."""
    from linkforge_compile.expressions import PathText  # where an expression hands on, they are imported already

    return isinstance(value, PathText)


def _is_foreign(where: Span) -> bool:
    """Whether what an expression hands on at a place was written in a file that is not one with that of the place."""
    origin = where.origin
    return origin is not None and origin.span.file.outermost is not where.file.outermost
