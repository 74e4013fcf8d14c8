"""Add notes to diagnostics on their way into a sink: who uses this file, who declares this parameter."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, notes_of
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import uses_in


class AnnotatingSink(Diagnostics):
    """Pass each diagnostic on to another sink, with notes appended to its own."""

    def __init__(self, sink: Diagnostics, notes: Iterable[Note]) -> None:
        super().__init__()
        self._sink = sink
        self._notes = tuple(notes)

    def report(self, diagnostic: Diagnostic) -> None:
        self._sink.report(replace(diagnostic, notes=(*diagnostic.notes, *self._notes)))


def with_use_trace(sink: Diagnostics, uses: Iterable[Span | None]) -> Diagnostics:
    """Return a sink for a file that is reached through these uses, the innermost first; None stands for no use."""
    notes = notes_of(uses_in(use for use in uses if use is not None))
    return AnnotatingSink(sink, notes) if notes else sink
