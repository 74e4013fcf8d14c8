"""Lines that show a place in a spec on standard output."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics.render.text import snippet
from linkforge_compile.source import Span
from linkforge_compile.source.characters import on_one_line


def told(what: str, place: Span) -> Iterator[str]:
    """Yield `WHAT at FILE:LINE:COLUMN`, the source line and a caret under the place."""
    yield on_one_line(f"{what} at {place}")
    yield from snippet(place)
