"""XML documents: the text that a template makes is read as a tree, completed by `extra_inside`, and laid out.

The tree holds tags and texts as they are written: lxml would resolve references, quotes, CDATA and prefixes, all of
which a document keeps as its template has them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from html import unescape
from math import inf
from typing import TypeAlias

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.source_map import Mapped, Origins, Segment, SourceMap, split_origins
from linkforge_compile.formats.xml_text import KEEPS_SPACE, RESERVED, escaped, is_xml_blank
from linkforge_compile.source.xml_tree import ATTRIBUTE, first_tag

INDENT = "  "

_TOKEN = re.compile(
    r"""[^<]++ | <(?![!?])(?:[^<>"']++|"[^"]*+"|'[^']*+')*+> | <!--.*?--> | <!\[CDATA\[.*?\]\]> | <\?.*?\?>
    | <!(?:[^<>\["']|"[^"]*"|'[^']*'|\[(?:<!--.*?-->|<\?.*?\?>|"[^"]*"|'[^']*'|[^\]"'])*+\])*+> | <""",
    re.DOTALL | re.VERBOSE,
)
_BREAK_IN_TAG = re.compile(r"""(?P<value>"[^"]*"|'[^']*')|\s*\n\s*""")

_INSIDE, _ATTRIBUTES = f"{RESERVED}inside", f"{RESERVED}attributes"


class InsideError(RobotGeneratorError):
    """An addition of `extra_inside` that cannot be placed.

    `id` is the number of the `Inside` object, `key` its tag and name; `others` are further such faults of the document.
    """

    def __init__(self, reason: str) -> None:
        self.id = self.key = ""
        self.others: tuple[InsideError, ...] = ()
        super().__init__(reason)


class XmlNode:
    """An element: `start` is its first tag as written, `end` its last tag, empty where `start` closes itself."""

    __slots__ = ("content", "end", "is_inline", "keeps_space", "start")

    def __init__(self, start: str, *, keeps_space: bool = False) -> None:
        self.start, self.end, self.keeps_space = start, "", keeps_space
        self.content: list[Content] = []
        self.is_inline = False
        """Whether white space in it is text, so that it is written on one line."""

    @property
    def tag(self) -> str:
        return first_tag(self.start)

    @property
    def elements(self) -> list[XmlNode]:
        return [item for item in self.content if isinstance(item, XmlNode)]

    @property
    def attributes(self) -> dict[str, str]:
        """The attributes and their values, both as written."""
        pairs = ((found["name"], found["double"] or found["single"] or "") for found in ATTRIBUTE.finditer(self.start))
        return {name: value for name, value in pairs if not name.startswith(RESERVED)}

    def close(self, end: str) -> None:
        """End the element, and drop white space that is layout: a lone blank on the line of the tags is text."""
        self.end = end
        if self.keeps_space or self.is_inline:
            self.is_inline = True
        elif len(self.content) == 1 and isinstance(blank := self.content[0], str) and is_xml_blank(blank):
            self.is_inline = "\n" not in blank
            self.content = self.content if self.is_inline else []
        else:
            self.content = [item for item in self.content if isinstance(item, XmlNode) or not is_xml_blank(item)]

    def add(self, attributes: str, content: Sequence[Content]) -> None:
        """Append attributes and content."""
        is_empty = self.start.endswith("/>")
        start = self.start.removesuffix("/>" if is_empty else ">").rstrip()
        if content and is_empty:
            self.end = f"</{self.tag}>"
        self.start = f"{start}{attributes}{'/>' if is_empty and not content else '>'}"
        self.content += content


Content: TypeAlias = "XmlNode | str"
"""An element; or as written: a text, an element of one tag, a comment, CDATA, an instruction or a declaration."""


def parse_rendered(text: str, *, most_nested: float = inf) -> XmlNode:
    """Return what a template renders as the content of an element without tags.

    Elements that are not closed, and tags that close nothing, are left to the readers of the document.

    Raises:
        InsideError: for an addition of `extra_inside` that cannot be placed.
        RobotGeneratorError: where more than `most_nested` elements are nested.

    """
    has_insides = _INSIDE in text
    node = XmlNode("")
    around: list[XmlNode] = []
    for token in _TOKEN.findall(text):
        begin = token[:2]
        if begin[0] != "<":
            node.content.append(token)
            if around and not is_xml_blank(token):
                node.is_inline = True
        elif begin == "</" and around:
            node.close(token)
            node = around.pop()
        elif begin in _NOT_ELEMENTS:
            node.content.append(token)
            node.is_inline = node.is_inline or token.startswith("<![CDATA[")
        else:
            tag = _BREAK_IN_TAG.sub(_without_break, token) if "\n" in token else token
            is_closed = tag[-2] == "/"
            if is_closed and not has_insides:
                node.content.append(tag.replace(KEEPS_SPACE, ""))
            elif is_closed:
                _append_element(node, tag)
            else:
                around.append(node)
                node = _append_element(node, tag)
                if len(around) > most_nested:
                    raise RobotGeneratorError(f"its elements are nested more than {most_nested} deep")
    return _complete([*around, node], has_insides=has_insides)


_NOT_ELEMENTS = frozenset({"</", "<!", "<?", "<"})
"""How tokens begin that are no first tag of an element."""


def _append_element(node: XmlNode, tag: str) -> XmlNode:
    """Add an element with its first tag to the content of another, and return it."""
    inner = XmlNode(tag, keeps_space=node.keeps_space)
    if ":space=" in tag:
        _take_space(inner)
    node.content.append(inner)
    return inner


def _complete(nodes: Sequence[XmlNode], *, has_insides: bool) -> XmlNode:
    """Return the document, the first of the nodes; the others are its innermost elements, which have no last tag."""
    document, *unclosed = nodes
    for inner in unclosed:
        inner.close("")
    document.content = [item for item in document.content if isinstance(item, XmlNode) or not is_xml_blank(item)]
    if has_insides:
        _place_insides(document)
    return document


def _without_break(found: re.Match[str]) -> str:
    return found[0].replace("\n", " ") if found["value"] else " "


def _take_space(node: XmlNode) -> None:
    if KEEPS_SPACE in node.start:
        node.start, node.keeps_space = node.start.replace(KEEPS_SPACE, ""), True
    elif (space := node.attributes.get("xml:space")) is not None:
        node.keeps_space = space == "preserve"


# Elements inside


_INSIDE_IN_TEXT = re.compile(
    rf"(?:<|&lt;){_INSIDE} (?:(?!(?:<|&lt;){_INSIDE} ).)*?/{_INSIDE}(?:>|&gt;)", re.DOTALL | re.IGNORECASE
)
_SPACE_IN_TEXT = re.compile(rf" {RESERVED}space=(\S{{1,6}}?)preserve\1", re.IGNORECASE)


def without_marks(text: str) -> str:
    """Return a text that is no XML without what only the writer of XML can place or remove.

    Filters of a template may have escaped it.
    """
    if RESERVED[:-1] not in text.lower():
        return text
    removed = 1
    while removed:  # the innermost first
        text, removed = _INSIDE_IN_TEXT.subn("", text)
    return _SPACE_IN_TEXT.sub("", text)


def inside_text(number: int, key: str, attributes: str, content: str) -> str:
    """Return an element that is not written: it adds to the sibling element that `key` names."""
    return f'<{_INSIDE} id="{number}" key="{escaped(key)}"><{_ATTRIBUTES}{attributes}/>{content}</{_INSIDE}>'


def _place_insides(node: XmlNode) -> None:
    """Move the additions that `inside_text` made to their elements."""
    faults: list[InsideError] = []
    nodes = [node]
    while nodes:
        node = nodes.pop()
        _place_insides_of(node, faults)
        nodes += reversed(node.elements)
    if faults:
        faults[0].others = tuple(faults[1:])
        raise faults[0]


def _place_insides_of(node: XmlNode, faults: list[InsideError]) -> None:
    for inside in [inner for inner in node.elements if inner.tag == _INSIDE]:
        place = node.content.index(inside)
        before = [item for item in node.content[:place] if isinstance(item, XmlNode)]
        del node.content[place]
        try:
            _place(inside, node, before)
        except InsideError as error:
            error.id, error.key = inside.attributes["id"], _key(inside)
            faults.append(error)


def _place(inside: XmlNode, node: XmlNode, among: Sequence[XmlNode]) -> None:
    if not node.start:
        raise InsideError("the 'elements' of a view need the other elements of that view before them")
    target = _find(_key(inside), node, among)
    added, *others = inside.elements
    for name in added.attributes:
        if name in target.attributes:
            raise InsideError(f"the attribute '{name}' of <{target.tag}> is stated twice")
    among = target.elements
    for inner in (other for other in others if other.tag == _INSIDE):
        _place(inner, target, among)
    content = [item for item in inside.content if item is not added]
    kept = [item for item in content if not (isinstance(item, XmlNode) and item.tag == _INSIDE)]
    target.add(added.start.removeprefix(f"<{_ATTRIBUTES}").removesuffix("/>"), kept)


def _key(inside: XmlNode) -> str:
    return unescape(inside.attributes["key"])


def _find(key: str, node: XmlNode, among: Sequence[XmlNode]) -> XmlNode:
    """Return the one element that has the tag, and the name if any."""
    tag, _, name = key.partition(" ")
    found = [child for child in among if child.tag == tag and (not name or _is_named(child, name))]
    if not found:
        known = ", ".join(dict.fromkeys(f"'{child.tag}'" for child in among)) or "nothing"
        raise InsideError(f"there is no '{key}' inside of <{node.tag}>, which has {known}")
    if len(found) > 1:
        raise InsideError(f"there are {len(found)} of '{key}'; say which by its name, as in '{tag} NAME'")
    return found[0]


def _is_named(node: XmlNode, name: str) -> bool:
    attributes, written = node.attributes, escaped(name)
    return written in (attributes.get("name"), attributes.get("link")) or node.content == [written]


# Writing


def write(document: XmlNode, *, pretty: bool) -> str:
    """Return the document indented, or with nothing between its tags."""
    lines = _lines(document)
    if not pretty:
        return "".join(["".join(pieces) for _, pieces, _ in lines])
    return "\n".join([INDENT * depth + "".join(pieces) for depth, pieces, _ in lines])


def write_with_map(document: XmlNode, origins: Origins) -> Mapped:
    """Return the document indented, and its map.

    A line without an origin has that of the element around it; an end tag has that of its element.
    """
    places = origins.places
    lines: list[str] = []
    map_: list[tuple[Segment, ...]] = []
    around: list[tuple[Segment, ...]] = []
    for depth, pieces, is_end in _lines(document):
        line = INDENT * depth
        segments: list[Segment] = []
        for piece in pieces:
            for text, number in split_origins(piece) if piece[0] == "<" and piece[1] != "!" else ((piece, None),):
                place = None if number is None else places[number]
                if place is not None and (not segments or segments[-1].place != place):
                    segments.append(Segment(len(line) + 1 if segments else 1, place))
                line += text
        if is_end:
            own = around[depth]
        else:
            own = tuple(segments) or (around[depth - 1] if depth else ())
            around[depth:] = [own[:1]]
        for part in line.split("\n"):
            lines.append(part)
            map_.append(own)
            own = own[-1:] and (own[-1]._replace(column=1),)
    return Mapped("\n".join(lines), SourceMap(tuple(map_)))


def _lines(document: XmlNode) -> Iterator[tuple[int, Iterable[str], bool]]:
    """Yield each line: its depth, its tags and texts, and whether it is the last tag of an element."""
    opened = [(document, iter(document.content))]
    depth = 0
    while opened:
        node, items = opened[-1]
        for item in items:
            if isinstance(item, str):
                yield depth, (item,), False
            elif item.is_inline or not item.content:
                yield depth, _inline(item), False
            else:
                yield depth, (item.start,), False
                opened.append((item, iter(item.content)))
                depth += 1
                break
        else:
            opened.pop()
            depth -= 1
            if node.end:
                yield depth, (node.end,), True


def _inline(item: Content) -> Iterator[str]:
    """Yield the tags and texts of an element on one line."""
    if isinstance(item, str):
        yield item
    elif item.content:
        yield item.start
        for inner in item.content:
            yield from _inline(inner)
        yield item.end
    else:
        yield item.start if item.start.endswith("/>") else f"{item.start[:-1]}/>"
