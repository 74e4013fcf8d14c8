"""Whether files that were compiled once are still what their spec compiles to."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.formats import MISSING_OUTPUT, STALE_OUTPUT
from linkforge_compile.source import SourceFile, Span

if TYPE_CHECKING:
    from linkforge_compile.diagnostics import Diagnostic

_LONGEST = 120
"""How many characters of a line a message quotes: a whole mesh's worth of numbers helps nobody."""


def difference(
    path: Path, text: str, spec: str, source: Span | None, templates: Path | None = None
) -> Diagnostic | None:
    """Return what is wrong with a file that should hold `text`, at the first line that differs; None for nothing.

    `templates` is the folder of a user's templates that make it. A file that is not there is told at `source`, the
    place of the spec.
    """
    try:
        found = path.read_bytes().decode("utf-8", errors="replace")
    except FileNotFoundError:
        return MISSING_OUTPUT.at(source, path=path, spec=spec)
    except OSError as error:
        raise UsageError(f"cannot read '{path}': {error.strerror}") from error
    # git hands out text with the line ends of the machine; it commits it with those that we write.
    found = found.replace("\r\n", "\n")
    if found == text:
        return None
    pairs = zip_longest(found.split("\n"), text.split("\n"))
    number, was, wanted = next((at, *pair) for at, pair in enumerate(pairs, 1) if pair[0] != pair[1])
    span = Span(SourceFile(str(path), found, path), number, 1, number, 1 + len(was or ""))
    notes = [Note(f"the templates in '{templates}' make it of the spec, and may have changed")] if templates else []
    return STALE_OUTPUT.at(span, spec=spec, expected=_quoted(wanted), notes=notes)


def _quoted(line: str | None) -> str:
    line = (line or "").strip()
    if not line:
        return "nothing"
    return f"'{line if len(line) <= _LONGEST else line[:_LONGEST] + '…'}'"
