"""Raw XML of `extra`: any number of elements, whose white space is layout where it is alone between tags."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.element import RawXmlError
from linkforge_compile.formats.marks import marks_of_lines, recorded
from linkforge_compile.formats.markup import Xml, require_writable, verbatim_comment
from linkforge_compile.formats.node import Content, Node, is_text, lines_of
from linkforge_compile.limits import MAX_NESTED_ELEMENTS
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.source.malformed_xml import MalformedXmlError, fault_of
from linkforge_compile.source.xml_places import Places
from linkforge_compile.source.xml_tree import XmlElement, document_of

_BEGIN, _END = "<raw-xml-of-a-spec>", "</raw-xml-of-a-spec>"
"""Stand around raw XML, so that any number of elements is one document and a DOCTYPE is a fault.

No author writes this name, so that an `</extra>` too many closes no open element.
"""

_BLANK = re.compile(r"(?:\s|&#(?:9|10|13|32|x9|x[Aa]|x[Dd]|x20);)*")

_LONGEST_KEPT = 10_000
"""Characters of raw XML that is remembered laid out."""

Path: TypeAlias = tuple[str | int, ...]
"""Keys and positions that lead from an object to what is written in it."""


def raw_elements(text: str, source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return raw XML laid out; names, prefixes, values, texts and comments as written.

    White space alone between tags is layout, unless the element says `xml:space="preserve"` or CDATA marks it as text.
    CDATA becomes text. The text was written under `path` of what `source` points to.

    Prefixes need no declaration here: it usually stands on `<robot>`.

    Raises:
        RobotGeneratorError: for XML that is not well-formed, for text outside of elements, for a document type, and for
            a processing instruction, which most readers refuse.

    """
    if recorded() or len(text) > _LONGEST_KEPT:
        return _laid_out(text, source, path)
    return _kept(str(text))  # one that knows its place would keep its whole file


# A text is asked for by the limits of its format and by the rendering, and by each compile of a watcher.
@lru_cache(maxsize=256)
def _kept(text: str) -> Xml:
    return _laid_out(text, None, ())


def _laid_out(text: str, source: SourceRef | None, path: Path) -> Xml:
    return Xml("\n".join(lines_of(_parse(text, source, path))))


def nodes_of(text: str) -> list[Node]:
    """Return the elements of raw XML; raise as `raw_elements` does where it is not well-formed."""
    return [item for item in _parse(text, None, ()) if isinstance(item, Node)]


def well_formed_nodes(text: str) -> list[Node]:
    """Return the elements of raw XML; none where it is not well-formed, which is told by what looks at the texts."""
    try:
        return nodes_of(text)
    except RobotGeneratorError:
        return []


def _parse(text: str, source: SourceRef | None, path: Path) -> list[Content]:
    require_writable(text)
    file = SourceFile("", f"{_BEGIN}{text}{_END}")
    places = Places(file.text)
    try:
        sections = _sections(places)
        root = document_of(file, places).root
    except MalformedXmlError as error:
        # As of a text that just ends: a tag that is not closed would be one that holds what stands around the text.
        fault = fault_of(text, _BEGIN) if fault_of(file.text) else None
        raise _malformed(text, fault or MalformedXmlError(error.problem, max(error.at - len(_BEGIN), 0))) from None
    return _Reading(sections, marks_of_lines(text, source, path)).content(root, keeps_space=False)


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
            reason = f"raw XML holds the processing instruction {target}; most readers of URDF refuse a file with one"
            raise _refused(reason, places, begin, piece)
        elif kind == "start" and len(places.open) >= MAX_NESTED_ELEMENTS:
            raise _refused(f"raw XML is nested more than {MAX_NESTED_ELEMENTS} elements deep", places, begin, piece)
    return sections


def _refused(reason: str, places: Places, at: int, piece: re.Match[str]) -> Exception:
    """Return why raw XML is refused once a piece is read: it may be malformed before the end of that."""
    fault = fault_of(places.text[len(_BEGIN) : piece.end()], _BEGIN, is_whole=False)
    text = places.text[len(_BEGIN) : -len(_END)]
    return fault or RawXmlError(reason, text, at - len(_BEGIN))


def _malformed(text: str, fault: MalformedXmlError) -> RawXmlError:
    at = min(fault.at, len(text.rstrip()))
    if text.startswith("<!DOCTYPE", at - len("<!")):
        reason = "raw XML has a document type, whose entities can read other files; delete it"
        return RawXmlError(reason, text, at - len("<!"))
    if text.startswith(("<?xml ", "<?xml?"), at):
        reason = "raw XML is part of a file, which has its '<?xml'; delete this one"
        return RawXmlError(reason, text, at)
    return RawXmlError(
        f"raw XML is not well-formed: {fault.problem}", text, at, fault.begun[0] if fault.begun else None
    )


class _Reading(NamedTuple):
    """Makes nodes of elements: `sections` are those with CDATA, `mark` gives that of a line."""

    sections: Mapping[int, int]
    mark: Callable[[int], str]

    def content(self, element: XmlElement, *, keeps_space: bool) -> list[Content]:
        space = element.get("xml:space")
        keeps_space = keeps_space if space is None else space == "preserve"
        section = self.sections.get(element.begin)
        content: list[Content] = []
        for item in element.content:
            if isinstance(item, XmlElement):
                mark = self.mark(item.span.line) if recorded() else ""
                inside = self.content(item, keeps_space=keeps_space or (section is not None and section < item.begin))
                content.append(Node(item.tag, tuple(item.values.items()), inside, mark))
            else:
                content.append(item if isinstance(item, str) else verbatim_comment(item.text))
        if keeps_space or section is not None or any(is_text(item) and str(item).strip() for item in content):
            return content
        return [item for item in content if not is_text(item)]
