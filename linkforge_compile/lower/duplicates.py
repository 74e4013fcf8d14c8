"""Two things of one name."""

from __future__ import annotations

from linkforge_compile.diagnostics import Diagnostics, Note, notes_of
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME
from linkforge_compile.source import SourceRef
from linkforge_compile.source.provenance import uses_in


def tell_duplicate(sink: Diagnostics, kind: str, name: str, second: SourceRef | None, first: SourceRef | None) -> None:
    """Report two things of one name at the second, with the first and how it came in as notes."""
    notes = []
    if first:
        notes = [Note("the first is here", first.span), *notes_of(uses_in(first.trail))]
    sink.report(DUPLICATE_NAME.at(second, kind=kind, name=name, notes=notes))
