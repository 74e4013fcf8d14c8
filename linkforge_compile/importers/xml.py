"""Parse XML files into trees with places, with limits on size and depth and without document types."""

from __future__ import annotations

import re
from collections.abc import Iterator
from sys import maxsize

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    DOCUMENT_TYPE,
    INSTRUCTION_LEFT_OUT,
    MALFORMED_XML,
    NO_CHARACTER_OF_A_SPEC,
    TOO_DEEP,
    TOO_MANY_ELEMENTS,
    TOO_MUCH_INSIDE,
)
from linkforge_compile.limits import MAX_NESTED_ELEMENTS
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point, without_declaration
from linkforge_compile.source.malformed_xml import MalformedXmlError, find_xml_error
from linkforge_compile.source.xml_tree import MARKUP, Places, XmlDocument, parse_xml

MOST_ELEMENTS = 250_000
MOST_INSIDE = 100_000

_DOCUMENT_TYPE = "<!DOCTYPE"
_EMPTY_SECTION = "<![CDATA[]]>"


def read_xml(file: SourceFile, sink: Diagnostics, *, is_ours: bool = False) -> XmlDocument | None:
    """Parse a text; None if it is malformed or refused, which is reported with its place.

    A document type is refused, and with it all entities except the five of XML: nothing is expanded or fetched.
    A text that `is_ours` was rendered from a robot within its limits, and may be larger than a file.
    """
    if found := FORBIDDEN_CHARACTER.search(file.counted):
        sink.report(NO_CHARACTER_OF_A_SPEC.at(file.between(*found.span()), character=code_point(found[0])))
        return None
    bounds = _Bounds(file, is_ours=is_ours)
    try:
        bounds.require()
        document = parse_xml(file, bounds.places)
    except _RefusedError as refused:
        sink.report_all((*bounds.instructions_before(refused.at), refused.diagnostic))
        return None
    except MalformedXmlError as malformed:
        sink.report_all((*bounds.instructions_before(malformed.at), _malformed(file, malformed)))
        return None
    sink.report_all(bounds.instructions_before(len(file.counted)))
    return document


def _malformed(file: SourceFile, error: MalformedXmlError) -> Diagnostic:
    notes = [Note("the element that is open begins here", file.between(*error.begun))] if error.begun else []
    return MALFORMED_XML.at(file.between(error.at, error.at + 1), problem=error.problem, notes=notes)


class _RefusedError(Exception):
    """A text is refused at an offset, although it may be well-formed."""

    def __init__(self, at: int, diagnostic: Diagnostic) -> None:
        self.at, self.diagnostic = at, diagnostic
        super().__init__(diagnostic.message)


class _Bounds:
    """Checks the limits of a document before its tree is built."""

    def __init__(self, file: SourceFile, *, is_ours: bool) -> None:
        self.places = Places(without_declaration(file.counted))
        self._instructions: list[re.Match[str]] = []
        self._file = file
        self._max_elements, self._max_inside = (maxsize, maxsize) if is_ours else (MOST_ELEMENTS, MOST_INSIDE)
        self._elements = 0
        """Number of elements, comments and processing instructions so far."""
        self._inside = [0] * (MAX_NESTED_ELEMENTS + 1)
        """Number of elements, comments and texts in the file, in its open element, in the open one inside that, ..."""
        self._is_in_text = False

    def require(self) -> None:
        """Walk over the text.

        Raises:
            _RefusedError: for a document type, and where a limit is exceeded.
            MalformedXmlError: where the text is malformed before that.

        """
        for piece in self.places.walk():
            kind = piece.lastgroup
            if kind in ("text", "section"):
                self._is_in_text |= bool(self.places.open) and piece[0] != _EMPTY_SECTION
                continue
            if piece[0].startswith(_DOCUMENT_TYPE):
                place = self._span(piece, len(_DOCUMENT_TYPE))
                raise find_xml_error(self.places.text) or _RefusedError(piece.start(), DOCUMENT_TYPE.at(place))
            if self._is_in_text and kind != "rest":
                # CDATA and the text around it are one text, which ends here.
                self._count_inside(piece, 1)
                self._is_in_text = False
            if kind == "start":
                self._begin(piece)
            elif kind == "comment":
                self._count(piece, len("<!--"))
                self._count_inside(piece, len("<!--"))
            elif kind == "instruction":
                self._count(piece, len("<?"))
                self._instructions.append(piece)

    def instructions_before(self, offset: int) -> Iterator[Diagnostic]:
        """Yield a warning for each processing instruction that ends at or before an offset."""
        for piece in self._instructions:
            if piece.end() <= offset:
                target = piece["target"]
                yield INSTRUCTION_LEFT_OUT.at(self._span(piece, len(target) + len("<?")), target=target)

    def _begin(self, piece: re.Match[str]) -> None:
        depth, length = len(self.places.open), len(piece["tag"]) + 1
        if depth == MAX_NESTED_ELEMENTS:
            raise self._refused(piece, TOO_DEEP.at(self._span(piece, length), limit=MAX_NESTED_ELEMENTS))
        self._count(piece, length)
        self._count_inside(piece, length)
        self._inside[depth + 1] = 0

    def _count(self, piece: re.Match[str], length: int) -> None:
        self._elements += 1
        if self._elements > self._max_elements:
            raise self._refused(piece, TOO_MANY_ELEMENTS.at(self._span(piece, length), limit=MOST_ELEMENTS))

    def _count_inside(self, piece: re.Match[str], length: int) -> None:
        depth = len(self.places.open)
        if self._inside[depth] >= self._max_inside:
            around = MARKUP.match(self.places.text, self.places.begins[self.places.open[-1]]) if depth else None
            owner = f"<{around['tag']}>" if around else "the file"
            refused = TOO_MUCH_INSIDE.at(self._span(piece, length), owner=owner, limit=MOST_INSIDE)
            raise self._refused(piece, refused)
        self._inside[depth] += 1

    def _refused(self, piece: re.Match[str], diagnostic: Diagnostic) -> Exception:
        """Return the exception for a piece: it is malformed if the text up to its end is."""
        before = self.places.text[: piece.end()]
        return find_xml_error(before, is_whole=False) or _RefusedError(piece.start(), diagnostic)

    def _span(self, piece: re.Match[str], length: int) -> Span:
        return self._file.between(piece.start(), piece.start() + length)
