"""Elements whose shape an author's data decide: raw XML of `extra`, and the free parts that plugins read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.backends.element import RawXmlError
from linkforge_compile.backends.marks import mark, marks_of_lines, recorded
from linkforge_compile.backends.markup import (
    Xml,
    escaped,
    is_of_numpy,
    is_writable,
    is_xml_name,
    require_writable,
    spelled,
    verbatim_comment,
    verbatim_text,
)
from linkforge_compile.bounds import MAX_NESTED_ELEMENTS
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from xml.parsers.expat import XMLParserType

_BEGIN, _END = "<raw-xml-of-a-spec>", "</raw-xml-of-a-spec>"
"""Stand around raw XML, so that any number of elements is one document and a DOCTYPE is a fault.

No author writes this name, so that an `</extra>` too many closes nothing that is open.
"""

_TEXT_OUTSIDE = "raw XML must be elements, found text"

_LONGEST_KEPT = 10_000
"""Characters of raw XML that is remembered laid out."""

Content: TypeAlias = "str | Node"
"""What stands in an element: text, an element, or a comment, which is Xml."""


Path: TypeAlias = tuple[str | int, ...]
"""Keys and positions that lead from an object to what is written in it."""


class Node(NamedTuple):
    """An element as it was read or as parameters spell it; `content` is in document order, `mark` in its tag."""

    tag: str
    attributes: Sequence[tuple[str, str]]
    content: list[Content]
    mark: str = ""

    @property
    def start(self) -> str:
        """The opening tag without its end."""
        start = f"<{self.tag}{self.mark}"
        return (
            start + "".join(f' {name}="{escaped(value)}"' for name, value in self.attributes)
            if self.attributes
            else start
        )


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
    require_writable(text)
    return Xml("\n".join(_lines(_parse(text, source, path))))


def nodes_of(text: str) -> list[Node]:
    """Return the elements of raw XML; raise as `raw_elements` does where it is not well-formed."""
    return [item for item in _parse(text, None, ()) if isinstance(item, Node)]


def well_formed_nodes(text: str) -> list[Node]:
    """Return the elements of raw XML; none where it is not well-formed, which is told by what looks at the texts."""
    try:
        return nodes_of(text)
    except RobotGeneratorError:
        return []


def parameter_elements(parameters: Mapping[str, object], source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return the parameters of a free part as child elements.

    A mapping is an element with children, where a key `_x` is its attribute `x` and `_text` its text; a list
    repeats its tag; anything else is text. They were written under `path` of what `source` points to.

    Raises:
        RobotGeneratorError: for a key that cannot be a tag.

    """
    return Xml("\n".join(_lines(_nodes(parameters, source, path))))


def is_surely_writable(part: object) -> bool:
    """Whether a free part is texts and maps of texts that XML can hold; a no means that writing it will tell."""
    if isinstance(part, str):
        return is_writable(part)
    if not isinstance(part, dict):
        return False
    return all(key[:1] != "_" and is_xml_name(key) and is_surely_writable(inner) for key, inner in part.items())


def _nodes(parameters: Mapping[str, object], source: SourceRef | None, path: Path) -> list[Content]:
    nodes: list[Content] = []
    for tag, value in parameters.items():
        if not isinstance(value, str) and isinstance(value, Sequence):
            nodes += [_node(tag, item, source, (*path, tag, number)) for number, item in enumerate(value)]
        else:
            nodes.append(_node(tag, value, source, (*path, tag)))
    return nodes


def _node(tag: str, value: object, source: SourceRef | None, path: Path) -> Node:
    _require_name(tag)
    if isinstance(value, str) or not isinstance(value, Mapping):
        return Node(tag, (), [text] if (text := _text(value)) else [], mark(source, *path))
    attributes = [(key[1:], _text(item)) for key, item in value.items() if key.startswith("_") and key != "_text"]
    for name, _ in attributes:
        _require_name(name)
    children = _nodes({key: item for key, item in value.items() if not key.startswith("_")}, source, path)
    text = _text(value.get("_text", ""))
    return Node(tag, attributes, [text, *children] if text else children, mark(source, *path))


def _text(value: object) -> str:
    return spelled(value) if isinstance(value, float | int) or is_of_numpy(value) else str(value)


def _require_name(name: str) -> None:
    if not is_xml_name(name):
        raise RobotGeneratorError(f"'{name}' cannot be the name of an XML element or attribute")


def is_text(item: Content) -> bool:
    return isinstance(item, str) and not isinstance(item, Xml)


def _lines(content: Sequence[Content]) -> Iterator[str]:
    for item in content:
        if isinstance(item, str):
            yield item
        elif not item.content:
            yield f"{item.start}/>"
        elif any(map(is_text, item.content)):
            yield inline(item)
        else:
            yield f"{item.start}>"
            yield from _lines(item.content)
            yield f"</{item.tag}>"


def inline(item: Content) -> str:
    if isinstance(item, str):
        return item if isinstance(item, Xml) else verbatim_text(item)
    return f"{item.start}>{''.join(map(inline, item.content))}</{item.tag}>" if item.content else f"{item.start}/>"


def _parse(text: str, source: SourceRef | None, path: Path) -> list[Content]:
    # expat knows nothing of namespaces unless told, so an undeclared `drake:` stays what it is; lxml refuses it.
    from xml.parsers import expat

    parser = expat.ParserCreate("utf-8")
    parser.ordered_attributes = True
    parser.buffer_text = True
    reader = _Reader(parser, text, marks_of_lines(text, source, path))
    parser.StartElementHandler = reader.begin
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.characters
    parser.CommentHandler = reader.comment
    parser.StartCdataSectionHandler = reader.begin_cdata
    parser.ProcessingInstructionHandler = reader.instruction
    try:
        parser.Parse(f"{_BEGIN}{text}{_END}", True)
    except expat.ExpatError:
        raise reader.malformed() from None
    finally:
        # The two know each other, and would stay until Python looks for cycles: 13 kB each, while a compile rests that.
        del reader.parser
    [wrapper] = reader.document.content
    assert isinstance(wrapper, Node)
    return wrapper.content


class _Reader:
    """What a parser tells of a document, as nodes below `document`, each with the mark of its line."""

    def __init__(self, parser: XMLParserType, text: str, mark: Callable[[int], str]) -> None:
        self.parser = parser
        self._text = text
        self.document = Node("", (), [])
        self._mark = mark
        self._open = [self.document]
        # Of each open element, whether white space in it is text.
        self._keeps_space = [False]

    def begin(self, tag: str, attributes: list[str]) -> None:
        if len(self._open) > MAX_NESTED_ELEMENTS:
            raise self._refused(f"raw XML is nested more than {MAX_NESTED_ELEMENTS} elements deep")
        pairs = tuple(zip(attributes[::2], attributes[1::2], strict=True))
        node = Node(tag, pairs, [], self._mark(self.parser.CurrentLineNumber))
        self._open[-1].content.append(node)
        self._open.append(node)
        space = dict(pairs).get("xml:space")
        self._keeps_space.append(self._keeps_space[-1] if space is None else space == "preserve")

    def end(self, _: str) -> None:
        content = self._open.pop().content
        if not self._keeps_space.pop() and all(not is_text(item) or not str(item).strip() for item in content):
            content[:] = [item for item in content if not is_text(item)]

    def characters(self, text: str) -> None:
        if self._is_outside and text.strip():
            # Text is told once it has ended, which is where the parser is then.
            end = len(self._text[: self._index(self.parser.CurrentByteIndex)].rstrip())
            begin = self._text.rfind(">", 0, end - 1) + 1
            begin += len(self._text[begin:end]) - len(self._text[begin:end].lstrip())
            raise RawXmlError(_TEXT_OUTSIDE, self._text, begin)
        self._open[-1].content.append(text)

    def comment(self, text: str) -> None:
        self._open[-1].content.append(verbatim_comment(text))

    def begin_cdata(self) -> None:
        if self._is_outside:
            raise self._refused(_TEXT_OUTSIDE)
        self._keeps_space[-1] = True

    def instruction(self, target: str, _: str) -> None:
        reason = "most readers of URDF refuse a file with one"
        raise self._refused(f"raw XML holds the processing instruction '<?{target}'; {reason}")

    def malformed(self) -> RawXmlError:
        """Return what is wrong where the parser gave up."""
        from linkforge_compile.source.malformed_xml import fault_of

        # As of a text that just ends: a tag that is not closed would be one that holds what stands around the text.
        found = fault_of(self._text, _BEGIN)
        assert found, "the element around it is not closed"
        at = min(found.at, len(self._text.rstrip()))
        if self._text.startswith("<!DOCTYPE", at - len("<!")):
            reason = "raw XML has a document type, whose entities can hold and fetch anything; delete that"
            return RawXmlError(reason, self._text, at - len("<!"))
        if self._text.startswith(("<?xml ", "<?xml?"), at):
            reason = "raw XML is part of a file, which has its '<?xml'; delete this one"
            return RawXmlError(reason, self._text, at)
        begun = found.begun[0] if found.begun else None
        return RawXmlError(f"raw XML is not well-formed: {found.problem}", self._text, at, begun)

    @property
    def _is_outside(self) -> bool:
        """Whether no element of the text is open: only the document, and what stands around the text."""
        return len(self._open) == 2

    def _refused(self, reason: str) -> RawXmlError:
        return RawXmlError(reason, self._text, self._index(self.parser.CurrentByteIndex))

    def _index(self, byte: int) -> int:
        """Return the index into the text for one of expat, who counts bytes, and those of what stands around it."""
        read = self._text.encode()[: byte - len(_BEGIN)]
        return min(len(read.decode(errors="replace")), len(self._text.rstrip()))
