"""Read XML with lxml into a tree whose elements and attributes know their places."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.source.malformed_xml import MalformedXmlError, fault_of
from linkforge_compile.source.span import SourceFile, Span, span_of
from linkforge_compile.source.xml_places import ATTRIBUTE, Places, as_written, walked_over

if TYPE_CHECKING:
    from lxml import etree

_NO_VALUES: Mapping[str, str] = MappingProxyType({})

Bounds: TypeAlias = tuple[Span | SourceFile, int, int]
"""A place as nodes of a spec hold it: a span, or a file and two indexes, of which the span is made on demand."""


class XmlAttribute(NamedTuple):
    """An attribute with its value as XML reads it; its place is that of the text between the quotes."""

    name: str
    value: str
    bounds: Bounds

    @property
    def span(self) -> Span:
        return span_of(*self.bounds)


@dataclass(frozen=True, slots=True, eq=False)
class XmlComment:
    """A comment without its `<!--`; `follows` if it is after a tag on the line on which that ends."""

    text: str
    span: Span
    follows: bool


class XmlElement(NamedTuple):
    """An element. Names keep their prefixes: namespaces are not resolved.

    lxml makes its elements anew at each access, so that they cannot keep a place. Spans are computed on demand: a robot
    of 2,000 links has 40,000. The element is the text of its file from `begin` to `end`.
    """

    tag: str
    values: Mapping[str, str]
    """The values of its attributes by name."""
    content: tuple[XmlContent, ...]
    children: tuple[XmlElement, ...]
    """The elements of the content."""
    text: str
    """The text directly in the element, joined."""
    file: SourceFile
    begin: int
    end: int

    @property
    def attributes(self) -> dict[str, XmlAttribute]:
        """The attributes with their places, searched at each call."""
        written = ATTRIBUTE.finditer(self.file.counted, self.begin)
        attributes: dict[str, XmlAttribute] = {}
        for (name, value), found in zip(self.values.items(), written, strict=False):
            begin, end = found.span("single" if found["double"] is None else "double")
            attributes[name] = XmlAttribute(name, value, (self.file, begin, end))
        return attributes

    @property
    def bounds(self) -> Bounds:
        """The place of `<tag`."""
        return self.file, self.begin, self.begin + len(self.tag) + 1

    @property
    def span(self) -> Span:
        return span_of(*self.bounds)

    @property
    def raw(self) -> str:
        """The whole element as written."""
        return self.file.counted[self.begin : self.end]

    def get(self, name: str) -> str | None:
        return self.values.get(name)

    # Equal to itself only: equal elements at two places are two.

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


XmlContent: TypeAlias = "XmlElement | XmlComment | str"


@dataclass(frozen=True, slots=True, eq=False)
class XmlDocument:
    """A document: its one element, and the comments before and after it."""

    root: XmlElement
    content: tuple[XmlContent, ...]


_TOO_LONG = "a text or a value in it has more than 10 MB, or a name more than 50,000 characters"


def document_of(file: SourceFile, walked: Places | None = None) -> XmlDocument:
    """Parse a file; `walked` are the places of its text if they are known already.

    Raises:
        MalformedXmlError: for text that is not XML, has names that other readers refuse, or a document type.

    """
    from lxml import etree

    places = walked or walked_over(file.counted)
    text = places.text
    try:
        root = etree.fromstring(places.without_namespaces.encode(), safe_parser("utf-8"))
    except etree.XMLSyntaxError as error:
        # For faults that only lxml finds, the line is enough.
        at = sum(len(line) + 1 for line in text.split("\n")[: max(error.position[0] - 1, 0)])
        reason = _TOO_LONG if "too long" in error.msg else f"it cannot be read: {error.msg.partition(',')[0]}"
        raise fault_of(text) or MalformedXmlError(reason, at) from None
    # lxml accepts names of the fifth edition of XML 1.0; expat, and with it xacro, those of the fourth.
    if places.has_foreign_names and (fault := fault_of(text)):
        raise fault
    if root.getroottree().docinfo.internalDTD is not None:
        raise MalformedXmlError("it has a document type", 0)
    builder = _TreeBuilder(file, places)
    before = tuple(reversed([*root.itersiblings(preceding=True)]))
    content = builder.content(None, (*before, root, *root.itersiblings()))
    [root_element] = (item for item in content if isinstance(item, XmlElement))
    return XmlDocument(root_element, content)


@cache
def safe_parser(encoding: str | None = None, *, remove_comments: bool = False) -> etree.XMLParser:
    """Return a parser for untrusted XML; `encoding` is that of the bytes, None for the declared one."""
    from lxml import etree

    return etree.XMLParser(
        encoding=encoding,
        remove_comments=remove_comments,
        remove_pis=True,
        resolve_entities=False,
        load_dtd=False,
        no_network=True,
        huge_tree=False,
    )


class _TreeBuilder:
    """Builds elements from those of lxml, whose order is that of the places."""

    def __init__(self, file: SourceFile, places: Places) -> None:
        from lxml import etree

        self._comment = etree._Comment
        self._file, self._trailing = file, places.trailing
        self._places = zip(places.begins, places.ends, strict=True)

    def content(self, text: str | None, nodes: Iterable[etree._Element]) -> tuple[XmlContent, ...]:
        """Return a text, then the nodes, each with the text after it."""
        content: list[XmlContent] = [text] if text else []
        for node in nodes:
            begin, end = next(self._places)
            if isinstance(node, self._comment):
                span = self._file.between(begin, begin + len("<!--"))
                content.append(XmlComment(node.text or "", span, begin in self._trailing))
            else:
                content.append(self._element(node, begin, end))
            if node.tail:
                content.append(node.tail)
        return tuple(content)

    def _element(self, node: etree._Element, begin: int, end: int) -> XmlElement:
        # Popped, because lxml searches each from the first one: 100,000 attributes would take quadratic time.
        left = node.attrib
        values = {as_written(str(name)): str(left.pop(name)) for name in list(left)}
        content = self.content(node.text, node)
        children = tuple([item for item in content if isinstance(item, XmlElement)])
        text = "".join([item for item in content if isinstance(item, str)])
        return XmlElement(as_written(node.tag), values or _NO_VALUES, content, children, text, self._file, begin, end)
