"""Places as commands tell them on standard output: a line with the file, and the source line under it."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics.render.text import snippet
from linkforge_compile.source import Span
from linkforge_compile.source.characters import on_one_line


def told(what: str, place: Span) -> Iterator[str]:
    """Yield `WHAT at FILE:LINE:COLUMN`, the line itself and a caret under what is meant."""
    yield on_one_line(f"{what} at {place}")
    yield from snippet(place)
