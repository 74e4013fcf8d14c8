"""XML text to a positioned tree: frozen, comments where they stand, and refusing what a hostile file would try."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from typing import TypeAlias
from xml.parsers import expat

from linkforge_compile.bounds import MAX_NESTED_ELEMENTS
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
from linkforge_compile.frozen import dataclass, field
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point

MOST_ELEMENTS = 250_000
MOST_INSIDE = 100_000

_LINE_START = re.compile("\r\n|\r|\n")
_TAG = re.compile(r"<[^\s/>]+")
_ATTRIBUTE = re.compile(r"""\s*([^\s=/>]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_CLOSING = re.compile(r"\s*/>")
# Only the very start of a document may hold a declaration; generated files have comments and blank lines before it.
_DECLARATION = re.compile(r"(?:\s|<!--(?:(?!-->).)*-->)*(<\?xml\s(?:(?!\?>).)*\?>)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class XmlAttribute:
    """An attribute: its value as XML means it, and the span of what stands between the quotes."""

    name: str
    value: str
    span: Span


@dataclass(frozen=True, slots=True, eq=False)
class XmlComment:
    """A comment, without its marks; `follows` where it stands behind a tag on the line on which that ends."""

    text: str
    span: Span
    follows: bool


@dataclass(frozen=True, slots=True, eq=False)
class XmlElement:
    """An element; its span is that of `<tag`. Names keep their prefixes: namespaces are not resolved."""

    tag: str
    attributes: Mapping[str, XmlAttribute]
    content: tuple[XmlContent, ...]
    span: Span
    raw: str = field(repr=False)
    """The whole element as it stands in the file."""

    def get(self, name: str) -> str | None:
        attribute = self.attributes.get(name)
        return attribute.value if attribute else None

    @property
    def children(self) -> Iterator[XmlElement]:
        return (item for item in self.content if isinstance(item, XmlElement))

    @property
    def text(self) -> str:
        """The text that stands directly in the element, in one."""
        return "".join(item for item in self.content if isinstance(item, str))


XmlContent: TypeAlias = "XmlElement | XmlComment | str"


@dataclass(frozen=True, slots=True, eq=False)
class XmlDocument:
    """A document: its one element, and the comments before and behind it."""

    root: XmlElement
    content: tuple[XmlContent, ...]


def read_xml(file: SourceFile, sink: Diagnostics) -> XmlDocument | None:
    """Parse a text; None where it is malformed or refused, which is told with its place.

    A document type is refused, and with it every entity but the five of XML: nothing is expanded, nothing fetched.
    """
    try:
        return _Parse(file, sink).document()
    except _RefusedError as refused:
        sink.report(refused.diagnostic)
        return None


class _RefusedError(Exception):
    """Parsing ends here."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.message)


@dataclass(slots=True)
class _Open:
    """An element whose end has not been seen."""

    tag: str
    attributes: Mapping[str, XmlAttribute]
    start: int
    end: int | None = None
    """Behind the tag, where that closes itself."""
    content: list[XmlContent] = field(default_factory=list)


class _Parse:
    """One run of expat, which knows nothing of namespaces unless told: a `drake:` without declaration stays."""

    def __init__(self, file: SourceFile, sink: Diagnostics) -> None:
        self._file, self._sink = file, sink
        self._text = file.text
        self._line_starts = [0, *(match.end() for match in _LINE_START.finditer(file.text))]
        self._open = [_Open("", {}, 0)]
        self._elements = 0
        self._last_end = -1
        self._parsed = parsed = _without_declaration(file.text)
        # What expat counts in bytes of UTF-8 is counted in characters here, from the last place that was asked for.
        self._is_ascii = parsed.isascii()
        self._bytes = b"" if self._is_ascii else parsed.encode("utf-8", "surrogatepass")
        self._known = (0, 0)
        self._parser = parser = expat.ParserCreate("utf-8")
        parser.buffer_text = True
        parser.ordered_attributes = True
        parser.StartDoctypeDeclHandler = self._refuse_document_type
        parser.StartElementHandler = self._begin
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.CommentHandler = self._comment
        parser.ProcessingInstructionHandler = self._instruction

    def document(self) -> XmlDocument:
        if found := FORBIDDEN_CHARACTER.search(self._text):
            place = self._span(found.start(), 1)
            raise _RefusedError(NO_CHARACTER_OF_A_SPEC.at(place, character=code_point(found[0])))
        try:
            self._parser.Parse(self._parsed, True)
        except expat.ExpatError as error:
            raise _RefusedError(self._malformed(error)) from None
        [document] = self._open
        [root] = [item for item in document.content if isinstance(item, XmlElement)]
        return XmlDocument(root, tuple(document.content))

    def _malformed(self, error: expat.ExpatError) -> Diagnostic:
        from linkforge_compile.importers.malformed import malformed

        _, *around = self._open
        at = self._offset(self._parser.ErrorByteIndex)
        found = malformed(error.code, self._parsed, at, [element.tag for element in around])
        notes = [
            Note("the element that is open begins here", self._span(element.start, len(element.tag) + 1))
            for element in around[-1:]
            if found.is_open
        ]
        return MALFORMED_XML.at(self._span(found.at, 1), problem=found.problem, notes=notes)

    # Handlers

    def _refuse_document_type(self, name: str, *_: object) -> None:
        start = max(self._text.rfind("<!DOCTYPE", 0, self._here() + 1), 0)
        raise _RefusedError(DOCUMENT_TYPE.at(self._span(start, len("<!DOCTYPE"))))

    def _begin(self, tag: str, attributes: list[str]) -> None:
        start = self._here()
        self._elements += 1
        if len(self._open) > MAX_NESTED_ELEMENTS:
            raise _RefusedError(TOO_DEEP.at(self._span(start, len(tag) + 1), limit=MAX_NESTED_ELEMENTS))
        if self._elements > MOST_ELEMENTS:
            raise _RefusedError(TOO_MANY_ELEMENTS.at(self._span(start, len(tag) + 1), limit=MOST_ELEMENTS))
        self._require_room(start, len(tag) + 1)
        read, place = self._attributes(start, attributes)
        closing = _CLOSING.match(self._text, place)
        self._last_end = self._text.index(">", place) + 1
        self._open.append(_Open(tag, read, start, closing.end() if closing else None))

    def _end(self, tag: str) -> None:
        element = self._open.pop()
        self._last_end = end = element.end or self._text.index(">", self._here()) + 1
        self._open[-1].content.append(
            XmlElement(
                tag,
                element.attributes,
                tuple(element.content),
                self._span(element.start, len(tag) + 1),
                self._text[element.start : end],
            )
        )

    def _require_room(self, start: int, length: int) -> None:
        """Refuse what begins at an offset where the element around it holds as much as it may."""
        around = self._open[-1]
        if len(around.content) >= MOST_INSIDE:
            owner = f"<{around.tag}>" if around.tag else "the file"
            raise _RefusedError(TOO_MUCH_INSIDE.at(self._span(start, length), owner=owner, limit=MOST_INSIDE))

    def _characters(self, text: str) -> None:
        # Text is handed over when what is behind it begins, which is where it is told.
        self._require_room(self._here(), 1)
        self._open[-1].content.append(text)

    def _comment(self, text: str) -> None:
        start = self._here()
        self._require_room(start, len("<!--"))
        between = self._text[self._last_end : start] if self._last_end >= 0 else "\n"
        follows = not between.strip() and "\n" not in between and "\r" not in between
        if follows:
            self._last_end = self._text.index("-->", start) + len("-->")
        self._open[-1].content.append(XmlComment(text, self._span(start, len("<!--")), follows))

    def _instruction(self, target: str, data: str) -> None:
        self._sink.report(INSTRUCTION_LEFT_OUT.at(self._span(self._here(), len(target) + 2), target=target))

    # Places

    def _attributes(self, start: int, pairs: list[str]) -> tuple[Mapping[str, XmlAttribute], int]:
        """Return the attributes of the tag that begins at an offset, and the offset behind them.

        Expat gives their values, the text their places.
        """
        tag = _TAG.match(self._text, start)
        place = tag.end() if tag else start
        attributes: dict[str, XmlAttribute] = {}
        for name, value in zip(pairs[::2], pairs[1::2], strict=True):
            written = _ATTRIBUTE.match(self._text, place)
            assert written, "expat has read an attribute here"
            group = 2 if written[2] is not None else 3
            length = written.end(group) - written.start(group)
            attributes[name] = XmlAttribute(name, value, self._span(written.start(group), length))
            place = written.end()
        return attributes, place

    def _here(self) -> int:
        return self._offset(self._parser.CurrentByteIndex)

    def _offset(self, byte: int) -> int:
        if self._is_ascii:
            return byte
        known_byte, known = self._known
        if byte < known_byte:
            known_byte, known = 0, 0
        offset = known + len(self._bytes[known_byte:byte].decode("utf-8", "replace"))
        self._known = (byte, offset)
        return offset

    def _span(self, start: int, length: int) -> Span:
        return Span(self._file, *self._place(start), *self._place(min(start + length, len(self._text))))

    def _place(self, offset: int) -> tuple[int, int]:
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1


def _without_declaration(text: str) -> str:
    """Return the text with blanks for its XML declaration: it is decoded already, and a late one says no more."""
    found = _DECLARATION.match(text)
    if found is None:
        return text
    blank = re.sub(r"[^\r\n]", " ", found[1])
    return text[: found.start(1)] + blank + text[found.end(1) :]
