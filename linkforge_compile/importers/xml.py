"""XML text to a positioned tree: frozen, comments where they stand, and refusing what a hostile file would try."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from sys import maxsize
from types import MappingProxyType
from typing import NamedTuple, TypeAlias
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
from linkforge_compile.source import SourceFile, Span, span_of
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point

MOST_ELEMENTS = 250_000
MOST_INSIDE = 100_000

_TAG = re.compile(r"<[^\s/>]+")
_ATTRIBUTE = re.compile(r"""\s*([^\s=/>]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
# Only the very start of a document may hold a declaration; generated files have comments and blank lines before it.
_DECLARATION = re.compile(r"(?:\s|<!--(?:(?!-->).)*-->)*(<\?xml\s(?:(?!\?>).)*\?>)", re.DOTALL)
_NOTHING: Mapping[str, str] = MappingProxyType({})


Bounds: TypeAlias = tuple[Span | SourceFile, int, int]
"""Where something stands, as nodes of a spec know it: its span, or its file and the indexes between which it stands."""


class XmlAttribute(NamedTuple):
    """An attribute, its value as XML means it; its place is that of what stands between the quotes."""

    name: str
    value: str
    bounds: Bounds

    @property
    def span(self) -> Span:
        return span_of(*self.bounds)


@dataclass(frozen=True, slots=True, eq=False)
class XmlComment:
    """A comment, without its marks; `follows` where it stands behind a tag on the line on which that ends."""

    text: str
    span: Span
    follows: bool


class XmlElement(NamedTuple):
    """An element. Names keep their prefixes: namespaces are not resolved.

    A tuple, and its places are computed as they are asked for: a robot of 2,000 links has 40,000, and those of the
    document that it compiles to are asked for nothing but what they say. It stands in its file from `begin` to `end`.
    """

    tag: str
    values: Mapping[str, str]
    """What its attributes say, by their names."""
    content: tuple[XmlContent, ...]
    children: tuple[XmlElement, ...]
    """The elements of the content."""
    text: str
    """The text that stands directly in the element, in one."""
    file: SourceFile
    begin: int
    end: int

    @property
    def attributes(self) -> dict[str, XmlAttribute]:
        """The attributes with their places, looked for anew each time."""
        # Expat gives their values, the text their places.
        text = self.file.counted
        attributes: dict[str, XmlAttribute] = {}
        place = _end_of_name(text, self.begin)
        for name, value in self.values.items():
            written = _attribute_at(text, place)
            begin, end = written.span(2 if written[2] is not None else 3)
            attributes[name] = XmlAttribute(name, value, (self.file, begin, end))
            place = written.end()
        return attributes

    @property
    def bounds(self) -> Bounds:
        """Where `<tag` stands."""
        return self.file, self.begin, self.begin + len(self.tag) + 1

    @property
    def span(self) -> Span:
        return span_of(*self.bounds)

    @property
    def raw(self) -> str:
        """The whole element as it stands in the file."""
        return self.file.counted[self.begin : self.end]

    def get(self, name: str) -> str | None:
        return self.values.get(name)

    # Equal to itself alone: elements that say the same stand at several places.

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


XmlContent: TypeAlias = "XmlElement | XmlComment | str"


def _end_of_name(text: str, begin: int) -> int:
    tag = _TAG.match(text, begin)
    return tag.end() if tag else begin


def _attribute_at(text: str, place: int) -> re.Match[str]:
    written = _ATTRIBUTE.match(text, place)
    assert written, "expat has read an attribute here"
    return written


@dataclass(frozen=True, slots=True, eq=False)
class XmlDocument:
    """A document: its one element, and the comments before and behind it."""

    root: XmlElement
    content: tuple[XmlContent, ...]


def read_xml(file: SourceFile, sink: Diagnostics, *, is_ours: bool = False) -> XmlDocument | None:
    """Parse a text; None where it is malformed or refused, which is told with its place.

    A document type is refused, and with it every entity but the five of XML: nothing is expanded, nothing fetched.
    What `is_ours`, made of a robot within its bounds, may hold more than a file: there is space between its tags.
    """
    try:
        return _Parse(file, sink, is_ours=is_ours).document()
    except _RefusedError as refused:
        sink.report(refused.diagnostic)
        return None


class _RefusedError(Exception):
    """Parsing ends here."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.message)


class _Open(NamedTuple):
    """An element whose end has not been seen."""

    tag: str
    values: Mapping[str, str]
    begin: int
    content: list[XmlContent]


class _Parse:
    """One run of expat, which knows nothing of namespaces unless told: a `drake:` without declaration stays."""

    def __init__(self, file: SourceFile, sink: Diagnostics, *, is_ours: bool) -> None:
        self._file, self._sink = file, sink
        self._most_elements, self._most_inside = (maxsize, maxsize) if is_ours else (MOST_ELEMENTS, MOST_INSIDE)
        self._text = file.counted
        self._open = [_Open("", _NOTHING, 0, [])]
        self._elements = 0
        """How many there were, comments among them."""
        self._last_tag: _Open | None = None
        """The element whose tag was read last, None where that was an end; `_last_end` is that of an end or comment."""
        self._last_end = -1
        self._parsed = parsed = _without_declaration(self._text)
        # What expat counts in bytes of UTF-8 is counted in characters here, from the last place that was asked for.
        self._is_ascii = parsed.isascii()
        self._bytes = b"" if self._is_ascii else parsed.encode("utf-8", "surrogatepass")
        self._known = (0, 0)
        self._parser = parser = expat.ParserCreate("utf-8")
        parser.buffer_text = True
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
        finally:
            # The two know each other, and would stay until Python looks for cycles.
            del self._parser
        [document] = self._open
        [root] = [item for item in document.content if isinstance(item, XmlElement)]
        return XmlDocument(root, tuple(document.content))

    def _malformed(self, error: expat.ExpatError) -> Diagnostic:
        from linkforge_compile.source.malformed_xml import malformed

        _, *around = self._open
        at = self._offset(self._parser.ErrorByteIndex)
        found = malformed(error.code, self._parsed, at, [element.tag for element in around])
        notes = [
            Note("the element that is open begins here", self._span(element.begin, len(element.tag) + 1))
            for element in around[-1:]
            if found.is_open
        ]
        return MALFORMED_XML.at(self._span(found.at, 1), problem=found.problem, notes=notes)

    # Handlers

    def _refuse_document_type(self, name: str, *_: object) -> None:
        start = max(self._text.rfind("<!DOCTYPE", 0, self._here() + 1), 0)
        raise _RefusedError(DOCUMENT_TYPE.at(self._span(start, len("<!DOCTYPE"))))

    def _begin(self, tag: str, values: dict[str, str]) -> None:
        begin = self._here()
        if len(self._open) > MAX_NESTED_ELEMENTS:
            raise _RefusedError(TOO_DEEP.at(self._span(begin, len(tag) + 1), limit=MAX_NESTED_ELEMENTS))
        self._count(begin, len(tag) + 1)
        self._require_room(begin, len(tag) + 1)
        self._last_tag = _Open(tag, values or _NOTHING, begin, [])
        self._open.append(self._last_tag)

    def _end(self, tag: str) -> None:
        _, values, begin, content = self._open.pop()
        end, text = self._here(), self._text
        # Expat is behind a tag that closes itself, and before one that closes another.
        if content or not text.endswith("/>", begin, end):
            end = text.index(">", end) + 1
        self._last_tag, self._last_end = None, end
        children = tuple([item for item in content if isinstance(item, XmlElement)])
        said = "".join([item for item in content if isinstance(item, str)])
        self._open[-1].content.append(XmlElement(tag, values, tuple(content), children, said, self._file, begin, end))

    def _count(self, start: int, length: int) -> None:
        """Refuse the element or comment that begins at an offset where the file has as many as it may."""
        self._elements += 1
        if self._elements > self._most_elements:
            raise _RefusedError(TOO_MANY_ELEMENTS.at(self._span(start, length), limit=MOST_ELEMENTS))

    def _require_room(self, start: int, length: int) -> None:
        """Refuse what begins at an offset where the element around it holds as much as it may."""
        around = self._open[-1]
        if len(around.content) >= self._most_inside:
            owner = f"<{around.tag}>" if around.tag else "the file"
            raise _RefusedError(TOO_MUCH_INSIDE.at(self._span(start, length), owner=owner, limit=MOST_INSIDE))

    def _characters(self, text: str) -> None:
        # Text is handed over when what is behind it begins, which is where it is told.
        self._require_room(self._here(), 1)
        self._open[-1].content.append(text)

    def _comment(self, text: str) -> None:
        start = self._here()
        self._count(start, len("<!--"))
        self._require_room(start, len("<!--"))
        follows = self._follows(start)
        if follows:
            self._last_tag, self._last_end = None, self._text.index("-->", start) + len("-->")
        self._open[-1].content.append(XmlComment(text, self._span(start, len("<!--")), follows))

    def _follows(self, start: int) -> bool:
        """Whether what starts at an offset stands on the line on which the last tag ends, or a comment behind that."""
        last_end = self._last_end if self._last_tag is None else self._end_of(self._last_tag)
        between = self._text[last_end:start] if last_end >= 0 else "\n"
        return not between.strip() and "\n" not in between and "\r" not in between

    def _end_of(self, tag: _Open) -> int:
        """Return the offset behind a tag: its attributes may hold what looks like an end."""
        place = _end_of_name(self._text, tag.begin)
        for _ in tag.values:
            place = _attribute_at(self._text, place).end()
        return self._text.index(">", place) + 1

    def _instruction(self, target: str, data: str) -> None:
        self._sink.report(INSTRUCTION_LEFT_OUT.at(self._span(self._here(), len(target) + 2), target=target))

    # Places

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
        return self._file.between(start, start + length)


def _without_declaration(text: str) -> str:
    """Return the text with blanks for its XML declaration: it is decoded already, and a late one says no more."""
    found = _DECLARATION.match(text)
    if found is None:
        return text
    blank = re.sub(r"[^\r\n]", " ", found[1])
    return text[: found.start(1)] + blank + text[found.end(1) :]
