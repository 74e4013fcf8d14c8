"""Read XML with lxml into a tree whose elements and attributes know their places.

lxml knows the line of an element, but no columns, nor the places of attributes and comments.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.source.malformed_xml import MalformedXmlError, find_xml_error
from linkforge_compile.source.span import SourceFile, Span, span_of

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

    def with_content(
        self, values: Mapping[str, str], content: tuple[XmlContent, ...], children: tuple[XmlElement, ...], text: str
    ) -> XmlElement:
        """Return the element at its place with other values of its attributes and another content."""
        return self._replace(values=values, content=content, children=children, text=text)

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

    def walk(self) -> Iterator[XmlElement]:
        """Yield the element and all elements in it, in document order, as xacro's parser counts them."""
        yield self
        for child in self.children:
            yield from child.walk()

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


def parse_xml(file: SourceFile, walked: Places | None = None) -> XmlDocument:
    """Parse a file; `walked` are the places of its text if they are known already.

    Raises:
        MalformedXmlError: for text that is not XML, has names that other readers refuse, or a document type.

    """
    from lxml import etree

    places = walked or Places(file.counted)
    if walked is None:
        deque(places.walk(), maxlen=0)
    text = places.text
    try:
        root = etree.fromstring(places.without_namespaces.encode(), safe_parser("utf-8"))
    except etree.XMLSyntaxError as error:
        # For faults that only lxml finds, the line is enough.
        at = sum(len(line) + 1 for line in text.split("\n")[: max(error.position[0] - 1, 0)])
        reason = _TOO_LONG if "too long" in error.msg else f"it cannot be read: {error.msg.partition(',')[0]}"
        raise find_xml_error(text) or MalformedXmlError(reason, at) from None
    # lxml accepts names of the fifth edition of XML 1.0; expat, and with it xacro, those of the fourth.
    if places.has_foreign_names and (fault := find_xml_error(text)):
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


MARKUP = re.compile(
    r"""(?P<text>[^<]+)
    | (?P<comment><!--.*?-->)
    | (?P<section><!\[CDATA\[.*?\]\]>)
    | (?P<instruction><\?(?P<target>[^\s?]*+).*?\?>)
    | (?P<end></[^<>]*>)
    | (?P<start><(?P<tag>[^\s/<>!?"'][^\s/<>=?"']*+)(?:[^<>"']++|"[^"<]*"|'[^'<]*')*+>)
    | (?P<rest><.*)""",
    re.DOTALL | re.VERBOSE,
)
"""Matches each piece of a document; the group is its kind, `rest` for all after something that is not closed."""

_TAG = re.compile(r"<([^\s/>!?]+)")
ATTRIBUTE = re.compile(r"""(?<=[\s"'])(?P<name>[^\s=/<>"']+)\s*=\s*(?:"(?P<double>[^"]*)"|'(?P<single>[^']*)')""")

# lxml accepts these in names, the fourth edition of XML 1.0 does not, so no name of a document has them.
_COLON, _NOTHING = "\ua789", "\ua78a"

_QUOTED = re.compile(r""""[^"]*"|'[^']*'""")
_HIDDEN = re.compile(rf"""({_QUOTED.pattern})|(:)|(?<=\s)xmlns(?=[\s=])""")
_SHOWN = str.maketrans({_COLON: ":", _NOTHING: None})


class Places:
    """The places of the elements and comments of a text, in its order, after `walk`."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.begins: list[int] = []
        self.ends: list[int] = []
        self.open: list[int] = []
        """The numbers of the elements that have no end yet, the innermost last."""
        self.trailing: set[int] = set()
        """Where the comments begin that follow a tag on the line on which it ends."""
        self.has_foreign_names = False
        """Whether a name has characters outside of ASCII."""
        self._line_from: int | None = None
        """The index after the tag, or the comment after one, that ends on the current line."""
        self._hidden: list[str] = []
        self._hidden_to = 0

    def walk(self) -> Iterator[re.Match[str]]:
        """Yield each piece before it is counted, up to one that is not closed or closes nothing."""
        is_ascii = self.text.isascii()
        for piece in MARKUP.finditer(self.text):
            yield piece
            kind = piece.lastgroup
            if kind == "start":
                if not piece[0].endswith("/>"):
                    self.open.append(len(self.begins))
                self._line_from = piece.end()
            elif kind == "end" and self.open:
                self.ends[self.open.pop()] = self._line_from = piece.end()
            elif kind == "comment":
                self._note_trailing(piece)
            elif kind == "instruction":
                self._line_from = None
            elif kind in ("text", "section"):
                continue
            else:
                return
            if kind in ("start", "comment"):
                self.begins.append(piece.start())
                self.ends.append(piece.end())
            if kind != "comment":
                self._hide_namespaces(piece)
                self.has_foreign_names |= not (is_ascii or _QUOTED.sub("", piece[0]).isascii())

    def _note_trailing(self, comment: re.Match[str]) -> None:
        between = "\n" if self._line_from is None else self.text[self._line_from : comment.start()]
        self._line_from = None
        if not (between.strip() or "\n" in between or "\r" in between):
            self.trailing.add(comment.start())
            self._line_from = comment.end()

    def _hide_namespaces(self, tag: re.Match[str]) -> None:
        if ":" in tag[0] or "xmlns" in tag[0]:
            hidden = _HIDDEN.sub(lambda found: found[1] or (_COLON if found[2] else f"xmlns{_NOTHING}"), tag[0])
            self._hidden += [self.text[self._hidden_to : tag.start()], hidden]
            self._hidden_to = tag.end()

    @property
    def without_namespaces(self) -> str:
        """The text with a letter in place of each ':' in its names, and one after `xmlns`.

        lxml would resolve prefixes and refuse undeclared ones; names are kept as written instead.
        """
        return "".join((*self._hidden, self.text[self._hidden_to :]))


def as_written(name: str) -> str:
    """Return a name of a text without namespaces as it was written."""
    return name if name.isascii() else name.translate(_SHOWN)


def first_tag(xml: str) -> str:
    """Return the tag of the first element in XML; "" if there is none."""
    found = _TAG.search(xml)
    return found[1] if found else ""
