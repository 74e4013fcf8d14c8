"""One element while it is read: what no reader takes of it stays in the spec as it stands in the file.

So that nothing is lost by forgetting it: a reader takes the attributes and children that it has a form for, and
`map` and `rest` give back all others as `extra` and `extra_attributes`. A reader that cannot say an element exactly
raises DeclinedError, and its parent keeps the element as raw XML.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace

from linkforge_compile.diagnostics import Note, Severity
from linkforge_compile.diagnostics.codes.importing import KEPT_RAW, TEXT_LEFT_OUT
from linkforge_compile.importers.draft import DeclinedError, Draft, values_in
from linkforge_compile.importers.prefixed import raw_with_prefix
from linkforge_compile.source import Span
from linkforge_compile.source.xml_places import MARKUP
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension

Read = Callable[["Reading"], YamlNode | None]
"""Reads an element: a node, or None for one that says only what goes without saying."""

_MOST_SHOWN = 40
_LINE_END = "\x01"  # no XML holds it

_BROKEN_VALUE = re.compile(r"""=\s*(?:"[^"<]*[\r\n][^"]*"|'[^'<]*[\r\n][^']*')""")
_INDENT = re.compile(r"^[ \t]+")


class Reading:
    """An element and what has been taken of it."""

    def __init__(self, draft: Draft, element: XmlElement) -> None:
        self.draft, self.element = draft, element
        self._attributes = element.attributes
        # A robot has thousands, which are taken one by one.
        self._children = dict.fromkeys(element.children)
        self._text_is_taken = False
        self._inside: dict[str, YamlNode] = {}
        self._left: YamlMap | None = None
        self._names_at_fault: set[str] = set()

    @property
    def span(self) -> Span:
        return self.element.span

    # Attributes

    def attribute(self, name: str) -> XmlAttribute:
        """Take an attribute that an element of this kind must have."""
        attribute = self._attributes.pop(name, None)
        if attribute is None:
            raise self.declined(f"it has no '{name}'")
        return attribute

    def word(self, name: str) -> YamlScalar | None:
        """Take an attribute that is text; None where there is none."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        return self.draft.text(attribute.value, attribute)

    def name(self, name: str = "name") -> YamlScalar:
        """Take an attribute that names something, and must be there."""
        attribute = self.attribute(name)
        return self.draft.text(attribute.value, attribute)

    def number(
        self, name: str, unit: Dimension | None = None, *, default: float | None = None, above: float | None = None
    ) -> YamlScalar | None:
        """Take an attribute that is a number, greater than `above`; None where it is not there, or is the default."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        node = self.draft.number(attribute.value, attribute, unit)
        if node is None:
            raise DeclinedError(f"{name} is no finite number: '{attribute.value}'", attribute.span)
        if above is not None and float(attribute.value) <= above:
            raise DeclinedError(f"{name} must be above {above:g}, found {node.text}", attribute.span)
        return None if default is not None and float(attribute.value) == default else node

    def required_number(self, name: str, unit: Dimension | None = None, *, above: float | None = None) -> YamlScalar:
        node = self.number(name, unit, above=above)
        if node is None:
            raise self.declined(f"it has no '{name}'")
        return node

    def numbers(self, name: str, count: int, unit: Dimension | None = None) -> YamlList | None:
        """Take an attribute that is so many numbers; None where it is not there."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        nodes = [self.draft.number(text, attribute, unit) for text in attribute.value.split()]
        if len(nodes) != count:
            raise DeclinedError(f"{name} takes {count} numbers, found '{attribute.value}'", attribute.span)
        if None in nodes:
            raise DeclinedError(f"{name} takes finite numbers, found '{attribute.value}'", attribute.span)
        return YamlList(tuple([node for node in nodes if node is not None]), *attribute.bounds)

    # Children

    def one(self, tag: str, read: Read) -> YamlNode | None:
        """Take the first child of a tag, which is read; None where there is none, or it is declined."""
        child = self._only(tag)
        nodes = self._read(child, read) if child else None
        return nodes[0] if nodes else None

    def must(self, tag: str, read: Read) -> YamlNode | None:
        """Take the first child of a tag without which this element is no use: one that is declined is an error."""
        child = self._only(tag)
        nodes = self._read(child, read) if child else ()
        if child and nodes is None:
            needed = Note(f"this <{self.element.tag}> needs it", self.span)
            self.draft.told[-1] = replace(self.draft.told[-1], taken_for=Severity.ERROR, notes=(needed,))
            return YamlFault(child.span)
        return nodes[0] if nodes else None

    def each(self, tag: str, read: Read) -> list[YamlNode]:
        """Take all children of a tag that are not declined."""
        children = [child for child in self._children if child.tag == tag]
        return [node for child in children for node in self._read(child, read) or () if node is not None]

    def has(self, tag: str) -> bool:
        """Whether there is a child of a tag that nobody has taken."""
        return any(child.tag == tag for child in self._children)

    def children(self) -> list[XmlElement]:
        """The children that nobody has taken."""
        return list(self._children)

    def take(self, child: XmlElement, read: Read) -> tuple[YamlNode | None] | None:
        """Read a child and take it; None where it is declined, which is told."""
        return self._read(child, read)

    def within(self, child: XmlElement, read: Callable[[Reading], YamlNode]) -> YamlNode:
        """Take a child that must be said: where it is declined, so is this element."""
        reading = Reading(self.draft, child)
        node = read(reading)
        self._keep_left(reading)
        del self._children[child]
        self.draft.made(node, child)
        return node

    def maybe(self, tag: str, read: Callable[[Reading], YamlNode]) -> YamlNode | None:
        """Take the first child of a tag, if any; where it is declined, so is this element."""
        return self.needed(tag, read) if self.has(tag) else None

    def needed(self, tag: str, read: Callable[[Reading], YamlNode]) -> YamlNode:
        """Take the first child of a tag, without which this element cannot be said."""
        child = self._only(tag)
        if child is None:
            raise self.declined(f"it has no <{tag}>")
        return self.within(child, read)

    def _only(self, tag: str) -> XmlElement | None:
        """Return the first child of a tag of which there can be one: any more are left, and told of the robot."""
        return next((child for child in self._children if child.tag == tag), None)

    def text_number(self) -> YamlScalar:
        """Take the number that the element holds."""
        node = self.draft.number(self.taken_text(), self.span)
        if node is None:
            raise self.declined(f"it holds no finite number: '{self.element.text}'")
        return node

    def text_numbers(self) -> YamlList:
        """Take the numbers that the element holds."""
        nodes = [self.draft.number(text, self.span) for text in self.taken_text().split()]
        return YamlList(tuple(node for node in nodes if node is not None), self.span)

    def taken_text(self) -> str:
        """Take the text that stands in the element."""
        self._text_is_taken = True
        return self.element.text

    def _read(self, child: XmlElement, read: Read) -> tuple[YamlNode | None] | None:
        """Read a child: one node or None; what is at fault is told already. None where it is declined."""
        mark, size = len(self.draft.told), self.draft.size
        try:
            if self.draft.refused and (refused := self.draft.refused.get(child.span)):
                raise DeclinedError(refused.reason, refused.span)
            reading = Reading(self.draft, child)
            node = read(reading)
        except DeclinedError as declined:
            # What was told of its parts, that they were kept raw or left out, is no longer so.
            del self.draft.told[mark:]
            self.draft.size = size
            if child in self.draft.at_fault:
                del self._children[child]
                self._names_at_fault |= {*_names_in(child)}
                return (YamlFault(child.span),)
            self.draft.told.append(KEPT_RAW.at(declined.span, tag=child.tag, reason=declined.reason))
            return None
        self._keep_left(reading)
        del self._children[child]
        # A short form holds less than was drafted for it.
        self.draft.size = size + (values_in(node) if node is not None else 0)
        if node is not None:
            self.draft.made(node, child)
        return (node,)

    # What is left

    def declined(self, reason: str) -> DeclinedError:
        return DeclinedError(reason, self.span)

    def spent(self) -> None:
        """Decline the element unless all of it was taken: its form in the language has no place for more."""
        for name, attribute in self._attributes.items():
            raise DeclinedError(f"there is no place for its attribute '{name}'", attribute.span)
        for child in self._children:
            raise DeclinedError(f"there is no place for <{child.tag}> in it", child.span)
        if not self._text_is_taken and self.element.text.strip():
            raise self.declined("it holds text")

    def _keep_left(self, child: Reading) -> None:
        if child._left is not None:
            self._inside[child.element.tag] = child._left

    def leave_rest(self) -> None:
        """Leave what nobody has taken to the element around, whose `extra_inside` says it; decline text."""
        if self.element.text.strip() and not self._text_is_taken:
            raise self.declined("it holds text")
        rest = {name: node for name, node in self.rest().items() if node is not None}
        self._left = self.draft.map_of(rest, self.element) if rest else None

    def is_spent(self) -> bool:
        """Whether nothing is left of the element: text is, though there is no place for it, for that is to be told."""
        has_text = bool(self.element.text.strip()) and not self._text_is_taken
        return not (self._attributes or self._children or has_text)

    def map(self, **entries: YamlNode | None) -> YamlMap:
        """Return the object of the element: these entries, then what nobody has taken."""
        return self.draft.map_of({**entries, **self.rest()}, self.element)

    def rest(self) -> dict[str, YamlNode | None]:
        """Return what nobody has taken as `extra` and the like; text has no place in them and is lost."""
        if self.is_spent() and not self._inside and not self._names_at_fault:
            return {}
        text = " ".join(self.element.text.split())
        if text and not self._text_is_taken:
            shown = text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."
            self.draft.told.append(TEXT_LEFT_OUT.at(self.span, tag=self.element.tag, text=shown))
        extra = self.draft.one_or_list([self._raw(child) for child in self._children])
        if self._names_at_fault:
            extra = YamlFault(self.span, frozenset(self._names_at_fault))
        attributes = {one.name: self.draft.word(one.value, one.span) for one in self._attributes.values()}
        return {
            "extra": extra,
            "extra_attributes": self.draft.map_of(attributes, self.span) if attributes else None,
            "extra_inside": self.draft.map_of(self._inside, self.span) if self._inside else None,
        }

    def _raw(self, child: XmlElement) -> YamlNode:
        written = self.draft.text(tidy(without_instructions(child.raw)), child.span).text
        text = raw_with_prefix(written, self.element.tag, self.draft.shapes)
        node = YamlScalar(text, text, child.span)
        self.draft.raw.add(child)
        self.draft.made(node, child)
        return node


def _names_in(element: XmlElement) -> Iterator[str]:
    """Yield the names that an element at fault gives, its tag at least, and of the links that it joins."""
    yield element.tag
    for one in (element, *element.children):
        yield from (name for key in ("name", "link") if (name := one.get(key)))


def without_instructions(raw: str) -> str:
    """Return an element without its processing instructions, which are told as left out and no spec can write."""
    return "".join(found[0] for found in MARKUP.finditer(raw) if found.lastgroup != "instruction")


def tidy(raw: str) -> str:
    """Return an element as it stands in a file, moved to the left where that changes only the space between tags.

    Comments stay as they are, wherever their lines begin.
    """
    has_lines = any(found["text"] and "\n" in found[0] and found[0].strip() for found in MARKUP.finditer(raw))
    if has_lines or "<![CDATA[" in raw or _BROKEN_VALUE.search(raw):
        return raw
    lines = MARKUP.sub(_tidied, raw.replace("\r\n", "\n").replace("\r", "\n"))
    first, *others = [line.rstrip() for line in lines.split("\n")]
    others = [_INDENT.sub(lambda space: space[0].expandtabs(2), line) for line in others if line]
    margin = min((len(line) - len(line.lstrip(" ")) for line in others), default=0)
    return "\n".join((first, *(line[margin:] for line in others))).replace(_LINE_END, "\n")


def _tidied(found: re.Match[str]) -> str:
    """Return `<tag />` as `<tag/>`, a comment on one line, and anything else as it is."""
    piece = found[0]
    if found["start"] and piece.endswith("/>"):
        return f"{piece[:-2].rstrip()}/>"
    return piece.replace("\n", _LINE_END) if found["comment"] else piece
