"""Raw XML of `extra`: any number of elements, whose white space is layout where it is alone between tags."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from linkforge_compile.core.exceptions import FieldPath, RobotGeneratorError
from linkforge_compile.formats.source_map import active_origins, origins_of_lines
from linkforge_compile.formats.xml_text import (
    KEEPS_SPACE,
    XML_BLANKS,
    RawXmlError,
    Xml,
    element_text,
    is_xml_blank,
    raw_text,
    require_writable,
)
from linkforge_compile.limits import MAX_NESTED_ELEMENTS
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.source.malformed_xml import MalformedXmlError, find_xml_error
from linkforge_compile.source.xml_tree import Places, XmlElement, parse_xml

_BEGIN, _END = "<raw-xml-of-a-spec>", "</raw-xml-of-a-spec>"
"""Stand around raw XML, so that any number of elements is one document and a DOCTYPE is a fault.

No author writes this name, so that an `</extra>` too many closes no open element.
"""

_BLANK = re.compile(r"(?:[ \t\r\n]|&#(?:9|10|13|32|x9|x[Aa]|x[Dd]|x20);)*")

_LONGEST_KEPT = 10_000
"""Characters of raw XML that is kept normalized."""


def raw_elements(text: str, source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return raw XML without its layout; names, prefixes, values, texts and comments as written.

    White space alone between tags is layout, unless the element says `xml:space="preserve"` or CDATA marks it as text.
    CDATA becomes text. The text was written under `path` of what `source` points to.

    Prefixes need no declaration here: it is usually on `<robot>`.

    Raises:
        RobotGeneratorError: for XML that is not well-formed, for text outside of elements, for a document type, and for
            a processing instruction, which most readers refuse.

    """
    if active_origins() or len(text) > _LONGEST_KEPT:
        return _normalized(text, source, path)
    return _normalized_once(str(text))  # a text that knows its place would keep its whole file in memory


# A text is needed by the limits of its format and by the rendering, and by each compile of `watch`.
@lru_cache(maxsize=256)
def _normalized_once(text: str) -> Xml:
    return _normalized(text, None, ())


def _normalized(text: str, source: SourceRef | None, path: FieldPath) -> Xml:
    root, sections = _parse(text)
    normalizer = _Normalizer(sections, origins_of_lines(text, source, path))
    return Xml("".join(normalizer.content(root, keeps_space=False)))


def elements_of(text: str) -> tuple[XmlElement, ...]:
    """Return the elements of raw XML; raise as `raw_elements` does where it is not well-formed."""
    return _parse(text)[0].children


def well_formed_elements(text: str) -> tuple[XmlElement, ...]:
    """Return the elements of raw XML; none where it is not well-formed, which `limits` reports."""
    try:
        return elements_of(text)
    except RobotGeneratorError:
        return ()


def element_texts(text: str, source: SourceRef | None = None, *path: str | int) -> Iterator[tuple[XmlElement, Xml]]:
    """Yield each element of raw XML with its text as of `raw_elements`; none where it is not well-formed."""
    try:
        root, sections = _parse(text)
    except RobotGeneratorError:
        return
    normalizer = _Normalizer(sections, origins_of_lines(text, source, path))
    for element in root.children:
        yield element, Xml(normalizer.element(element))


def _parse(text: str) -> tuple[XmlElement, Mapping[int, int]]:
    """Return the element that encloses raw XML, and the sections of CDATA in it."""
    require_writable(text)
    file = SourceFile("", f"{_BEGIN}{text}{_END}")
    places = Places(file.text)
    try:
        sections = _sections(places)
        return parse_xml(file, places).root, sections
    except MalformedXmlError as error:
        # Parse without the closing tag, which would be reported for a tag that is not closed.
        fault = find_xml_error(text, _BEGIN) if find_xml_error(file.text) else None
        raise _malformed(text, fault or MalformedXmlError(error.problem, max(error.at - len(_BEGIN), 0))) from None


def _sections(places: Places) -> Mapping[int, int]:
    """Walk over raw XML, and return where elements with CDATA begin, each with where the first of that does.

    Raises:
        RawXmlError: for what is XML, but none to be raw.
        MalformedXmlError: where the text is malformed before that.

    """
    sections: dict[int, int] = {}
    outside: int | None = None
    for piece in places.walk():
        kind, begin, is_outside = piece.lastgroup, piece.start(), len(places.open) == 1
        if kind == "text":
            blank = _BLANK.match(piece[0])
            if is_outside and blank and blank.end() < len(piece[0]):
                outside = begin + blank.end()
        elif kind == "rest":
            break
        elif outside is not None or (kind == "section" and is_outside):
            raise _refused("raw XML must be elements, found text", places, begin if outside is None else outside, piece)
        elif kind == "section" and places.open:
            sections.setdefault(places.begins[places.open[-1]], begin)
        elif kind == "instruction":
            target = f"'<?{piece['target']}'"
            reason = f"raw XML contains the processing instruction {target}; most URDF readers refuse a file with one"
            raise _refused(reason, places, begin, piece)
        elif kind == "start" and len(places.open) >= MAX_NESTED_ELEMENTS:
            raise _refused(f"raw XML is nested more than {MAX_NESTED_ELEMENTS} elements deep", places, begin, piece)
    return sections


def _refused(reason: str, places: Places, at: int, piece: re.Match[str]) -> Exception:
    """Return why raw XML is refused once a piece is read: it may be malformed before the end of that."""
    fault = find_xml_error(places.text[len(_BEGIN) : piece.end()], _BEGIN, is_whole=False)
    text = places.text[len(_BEGIN) : -len(_END)]
    return fault or RawXmlError(reason, text, at - len(_BEGIN))


def _malformed(text: str, fault: MalformedXmlError) -> RawXmlError:
    at = min(fault.at, len(text.rstrip(XML_BLANKS)))
    if text.startswith("<!DOCTYPE", at - len("<!")):
        reason = "raw XML has a document type, whose entities can read other files; delete it"
        return RawXmlError(reason, text, at - len("<!"))
    if text.startswith(("<?xml ", "<?xml?"), at):
        reason = "raw XML is part of a file, which has its '<?xml'; delete this one"
        return RawXmlError(reason, text, at)
    return RawXmlError(
        f"raw XML is not well-formed: {fault.problem}", text, at, fault.begun[0] if fault.begun else None
    )


class _Normalizer(NamedTuple):
    """Writes elements without layout: `sections` are those with CDATA, `origin` gives the attribute of a line."""

    sections: Mapping[int, int]
    origin: Callable[[int], str]

    def content(self, element: XmlElement, *, keeps_space: bool) -> list[str]:
        """Return the content of an element, without blank texts where these are layout."""
        space = element.get("xml:space")
        keeps_space = keeps_space if space is None else space == "preserve"
        section = self.sections.get(element.begin)
        texts = (item for item in element.content if isinstance(item, str))
        keeps_texts = keeps_space or section is not None or not all(map(is_xml_blank, texts))
        content: list[str] = []
        for item in element.content:
            if isinstance(item, XmlElement):
                is_behind_section = section is not None and section < item.begin
                content.append(self.element(item, keeps_space=keeps_space or is_behind_section))
            elif not isinstance(item, str):
                content.append(f"<!--{item.text}-->")
            elif keeps_texts:
                content.append(raw_text(item))
        return content

    def element(self, element: XmlElement, *, keeps_space: bool = False) -> str:
        origin = self.origin(element.span.line) if active_origins() else ""
        content = "".join(self.content(element, keeps_space=keeps_space))
        if content and element.begin in self.sections:
            origin += KEEPS_SPACE
        return element_text(element.tag, element.values.items(), content, origin)


def plain_text(element: XmlElement) -> str:
    """Return an element of raw XML as it is written, without layout."""
    return _Normalizer({}, lambda _: "").element(element).replace(KEEPS_SPACE, "")
