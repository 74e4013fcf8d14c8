"""Where the name at a position is declared, and where else it is used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, Span


def declarations_of(document: Document, at: Position) -> list[types.Location]:
    """Return where the parts are declared that the name at a position names, in the order of the specs."""
    return _locations(document, (one for one in _named(document, at) if one.is_declaration))


def references_to(document: Document, at: Position, *, with_declarations: bool) -> list[types.Location]:
    """Return where the name at a position is used, in all specs that read the file."""
    return _locations(document, (one for one in _named(document, at) if with_declarations or not one.is_declaration))


def highlights(document: Document, at: Position) -> list[types.DocumentHighlight]:
    """Return where the file writes the name at a position."""
    spans = _places(_named(document, at))
    return [types.DocumentHighlight(document.columns.range(span)) for span in spans if document.holds(span)]


def _named(document: Document, at: Position) -> Iterator[Occurrence]:
    """Yield all occurrences, in any spec that reads the file, of what the name at a position names."""
    for analysis in document.analyses:
        occurrences = Occurrences(analysis)
        yield from occurrences.of(occurrences.at(identity(document.path), at))


def _places(found: Iterable[Occurrence]) -> Iterable[Span]:
    """Return each place once; each analysis has places of its own in a file, which links may lead to as well."""
    spans: dict[tuple[str, Position, Position], Span] = {}
    for span in (one.span for one in found if one.span.file.path):
        spans.setdefault((identity(span.file.path or ""), span.start, span.end), span)
    return spans.values()


def _locations(document: Document, found: Iterable[Occurrence]) -> list[types.Location]:
    return [location for span in _places(found) if (location := document.columns.location(span))]
