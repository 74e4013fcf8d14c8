"""A sink that tells, with every fault, what the reader must know besides: who used this file, who declared this."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, notes_of
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import uses_in


class NotedSink(Diagnostics):
    """Hands each diagnostic on to another sink with notes behind its own."""

    def __init__(self, sink: Diagnostics, notes: Iterable[Note]) -> None:
        super().__init__()
        self._sink = sink
        self._notes = tuple(notes)

    def report(self, diagnostic: Diagnostic) -> None:
        self._sink.report(replace(diagnostic, notes=(*diagnostic.notes, *self._notes)))


def used_from(sink: Diagnostics, trail: tuple[Span, ...]) -> Diagnostics:
    """Return a sink for what stands in a file that was brought in by a trail of uses."""
    return NotedSink(sink, notes_of(uses_in(trail))) if trail else sink
