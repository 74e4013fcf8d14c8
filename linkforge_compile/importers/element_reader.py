"""Read one XML element: what no reader takes out of it stays in the spec as raw XML.

A reader takes the attributes and children that the language has a form for; `map` and `extras` return all others as
`extra`, `extra_attributes` and `extra_inside`, so that nothing is lost. A reader that cannot represent an element
exactly raises CannotRepresentError, and its parent keeps the element as raw XML.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import TypeVar

from linkforge_compile.diagnostics import Diagnostic, Note, Severity
from linkforge_compile.diagnostics.codes.importing import ENDS_IN_A_BLANK, KEPT_RAW, TEXT_LEFT_OUT
from linkforge_compile.importers.raw_xml import raw_with_prefix, tidy, without_instructions
from linkforge_compile.importers.renaming import rename_in_raw, rename_in_raw_srdf
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft, values_in
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension

Read = Callable[["ElementReader"], YamlNode | None]
"""A function that reads an element; it returns None for one that means the same as its absence."""

N = TypeVar("N", bound=YamlNode | None)

Named = dict[str, tuple[XmlAttribute, YamlNode]]
"""Nodes by name, each with the attribute that names it."""

_FLAGS = {"true": True, "1": True, "false": False, "0": False}
"""The words of XML Schema for true and false."""

_NO_INERTIAL, _NO_SHAPE = "reads no <inertial>", "reads no shape"
_WITHOUT_A_NUMBER = {
    **dict.fromkeys(("mass", "inertia"), _NO_INERTIAL),
    **dict.fromkeys(("sphere", "cylinder", "capsule"), _NO_SHAPE),
}
"""What urdfdom does after a number that it cannot read, by the tag of its element."""

_MAX_TEXT = 40
"""Characters shown of a text that is omitted."""


class ElementReader:
    """An element, and which of its attributes and children are not taken yet."""

    def __init__(self, draft: SpecDraft, element: XmlElement) -> None:
        self.draft, self.element = draft, element
        self._attributes = element.attributes
        # A dict, because a robot has thousands of children, which are removed one by one.
        self._children = dict.fromkeys(element.children)
        self._is_text_taken = False
        self._inside: dict[str, YamlNode] = {}
        self._passed_up: YamlMap | None = None
        self._names_at_fault: set[str] = set()

    @property
    def span(self) -> Span:
        return self.element.span

    def cannot_represent(self, reason: str) -> CannotRepresentError:
        """Return the exception that keeps the element raw, for the caller to raise."""
        return CannotRepresentError(reason, self.span)

    # Attributes

    def attribute(self, name: str) -> XmlAttribute:
        """Take an attribute; without it the element cannot be represented."""
        attribute = self._attributes.pop(name, None)
        if attribute is None:
            raise self.cannot_represent(f"it has no '{name}'")
        return attribute

    def require_attributes(self, names: Iterable[str]) -> None:
        """Raise CannotRepresentError unless the element has these attributes."""
        if missing := [name for name in names if name not in self.element.values]:
            raise self.cannot_represent(f"it has no {' and no '.join(map(repr, missing))}")

    def text(self, name: str) -> YamlScalar | None:
        """Take an attribute as text; None where there is none."""
        return self.required_text(name) if name in self._attributes else None

    def required_text(self, name: str = "name") -> YamlScalar:
        """Take an attribute as text; without it the element cannot be represented."""
        attribute = self.attribute(name)
        return self.draft.text(attribute.value, attribute)

    def flag(self, name: str, *, default: bool | None = None) -> YamlScalar | None:
        """Take an attribute as true or false; None where there is none, or it is the default."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        value = _FLAGS.get(attribute.value.strip())
        if value is None:
            raise CannotRepresentError(f"{name} is neither true nor false: '{attribute.value}'", attribute.span)
        return None if value is default else self.draft.word(str(value).lower(), attribute)

    def number(self, name: str, unit: Dimension | None = None, *, default: float | None = None) -> YamlScalar | None:
        """Take an attribute as a number; None where there is none, or it is the default."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        node = self.draft.number(attribute.value, attribute, unit)
        if self.draft.is_urdf and node is not None and attribute.value[-1:].isspace():
            effect = _WITHOUT_A_NUMBER.get(self.element.tag, "refuses the robot")
            self.draft.diagnostics.append(
                ENDS_IN_A_BLANK.at(attribute.span, name=name, tag=self.element.tag, effect=effect)
            )
        if node is None:
            raise CannotRepresentError(f"{name} is not a finite number: '{attribute.value}'", attribute.span)
        return None if default is not None and float(attribute.value) == default else node

    def numbers(self, name: str, count: int, unit: Dimension | None = None) -> YamlList | None:
        """Take an attribute as a list of `count` numbers; None where there is none."""
        if name not in self._attributes:
            return None
        attribute = self._attributes.pop(name)
        nodes = [self.draft.number(text, attribute, unit) for text in attribute.value.split()]
        if len(nodes) != count:
            raise CannotRepresentError(f"{name} takes {count} numbers, found '{attribute.value}'", attribute.span)
        if None in nodes:
            raise CannotRepresentError(f"{name} takes finite numbers, found '{attribute.value}'", attribute.span)
        return YamlList(tuple([node for node in nodes if node is not None]), *attribute.bounds)

    # Text

    def take_text(self) -> str:
        """Take the text of the element."""
        self._is_text_taken = True
        return self.element.text

    def text_number(self) -> YamlScalar:
        """Take the text of the element as a number; the caller has checked that it is one."""
        node = self.draft.number(self.take_text(), self.span)
        assert node, "the caller has checked the text"
        return node

    def text_numbers(self) -> YamlList:
        """Take the text of the element as a list of numbers."""
        nodes = [self.draft.number(text, self.span) for text in self.take_text().split()]
        return YamlList(tuple(node for node in nodes if node is not None), self.span)

    # Children

    def remaining(self, tag: str | None = None) -> list[XmlElement]:
        """Return the children that are not taken yet, of one tag or of all."""
        return [child for child in self._children if tag is None or child.tag == tag]

    def has_child(self, tag: str) -> bool:
        """Whether a child of a tag is not taken yet."""
        return any(child.tag == tag for child in self._children)

    def child(self, tag: str, read: Read, *, is_required: bool = False) -> YamlNode | None:
        """Take the first child of a tag; None where there is none, or it is kept raw.

        Where it `is_required`, this element cannot be represented without it. Further children of the tag stay untaken.
        """
        child = self._first(tag)
        if child is None:
            return None
        return self.read(child, read) if is_required else self.try_read(child, read)

    def essential_child(self, tag: str, read: Callable[[ElementReader], YamlNode]) -> YamlNode | None:
        """Take the first child of a tag as `child` does, but report an error if it cannot be represented."""
        child = self._first(tag)
        node = self.try_read(child, read) if child else None
        if child and node is None:
            note = Note(f"this <{self.element.tag}> needs it", self.span)
            kept_raw = self.draft.diagnostics[-1]
            self.draft.diagnostics[-1] = replace(kept_raw, severity_override=Severity.ERROR, notes=(note,))
            return YamlFault(child.span)
        return node

    def children(self, tag: str, read: Read) -> list[YamlNode]:
        """Take all children of a tag that can be represented."""
        nodes = [self.try_read(child, read) for child in self.remaining(tag)]
        return [node for node in nodes if node is not None]

    def try_read(self, child: XmlElement, read: Read) -> YamlNode | None:
        """Take a child; where it cannot be represented it stays untaken, which is reported.

        In an element with a reported error, such a child becomes a YamlFault without a report.
        """
        mark, size = len(self.draft.diagnostics), self.draft.size
        try:
            if self.draft.refused and (refusal := self.draft.refused.get(child)):
                raise CannotRepresentError(refusal.reason, refusal.span)
            reader = ElementReader(self.draft, child)
            node = read(reader)
        except CannotRepresentError as error:
            # Reports about parts of the child are void, because all of it stays raw.
            del self.draft.diagnostics[mark:]
            self.draft.size = size
            if child in self.draft.at_fault:
                del self._children[child]
                self._names_at_fault |= {*_names_in(child)}
                return YamlFault(child.span)
            self.draft.diagnostics.append(KEPT_RAW.at(error.span, tag=child.tag, reason=error.reason))
            return None
        self._finish(reader)
        # A short form holds fewer values than were drafted for it.
        self.draft.size = size + (values_in(node) if node is not None else 0)
        if node is not None:
            self.draft.note_source(node, child)
        return node

    def read(self, child: XmlElement, read: Callable[[ElementReader], N]) -> N:
        """Take a child; where it cannot be represented, neither can this element."""
        reader = ElementReader(self.draft, child)
        node = read(reader)
        self._finish(reader)
        if node is not None:
            self.draft.note_source(node, child)
        return node

    def required(self, tag: str, read: Callable[[ElementReader], N]) -> N:
        """Take the first child of a tag as `read` does; without it this element cannot be represented."""
        child = self._first(tag)
        if child is None:
            raise self.cannot_represent(f"it has no <{tag}>")
        return self.read(child, read)

    def _first(self, tag: str) -> XmlElement | None:
        return next((child for child in self._children if child.tag == tag), None)

    def _finish(self, reader: ElementReader) -> None:
        """Mark the child of a reader as taken."""
        del self._children[reader.element]
        if reader._passed_up is not None:
            self._inside[reader.element.tag] = reader._passed_up

    # What is left

    def is_used_up(self) -> bool:
        """Whether nothing of the element is left, counting text."""
        return not (self._attributes or self._children or self._has_text_left())

    def require_used_up(self) -> None:
        """Raise CannotRepresentError unless all of the element was taken: its form has no place for more."""
        for name, attribute in self._attributes.items():
            raise CannotRepresentError(f"there is no place for its attribute '{name}'", attribute.span)
        for child in self._children:
            raise CannotRepresentError(f"there is no place for <{child.tag}> in it", child.span)
        if self._has_text_left():
            raise self.cannot_represent("it contains text")

    def pass_rest_up(self) -> None:
        """Pass what is left to the parent's `extra_inside`, for an element whose form is a single value."""
        rest = {name: node for name, node in self.extras().items() if node is not None}
        self._passed_up = self.draft.map_of(rest, self.element) if rest else None

    def map(self, **entries: YamlNode | None) -> YamlMap:
        """Return the object of the element: these entries, then what is left."""
        return self.draft.map_of({**entries, **self.extras()}, self.element)

    def extras(self) -> dict[str, YamlNode | None]:
        """Return what is left as `extra`, `extra_attributes` and `extra_inside`; text is lost, which is reported."""
        if self.is_used_up() and not self._inside and not self._names_at_fault:
            return {}
        if self._has_text_left():
            self.draft.diagnostics.append(text_left_out(self.element))
        extra = self.draft.one_or_list([self._raw(child) for child in self._children])
        if self._names_at_fault:
            extra = YamlFault(self.span, frozenset(self._names_at_fault))
        attributes = {one.name: self.draft.word(one.value, one.span) for one in self._attributes.values()}
        return {
            "extra": extra,
            "extra_attributes": self.draft.map_of(attributes, self.span) if attributes else None,
            "extra_inside": self.draft.map_of(self._inside, self.span) if self._inside else None,
        }

    def _has_text_left(self) -> bool:
        return not self._is_text_taken and bool(self.element.text.strip())

    def _raw(self, child: XmlElement) -> YamlNode:
        rename = rename_in_raw if self.draft.is_urdf else rename_in_raw_srdf
        raw = rename(without_instructions(child.raw), self.draft.renamed)
        written = self.draft.text(tidy(raw), child.span).text
        text = raw_with_prefix(written, self.element.tag, self.draft.shapes)
        node = YamlScalar(text, text, child.span)
        self.draft.raw.add(child)
        self.draft.note_source(node, child)
        return node


def text_left_out(element: XmlElement) -> Diagnostic:
    """Return the warning that the text of an element is omitted."""
    text = " ".join(element.text.split())
    shown = text if len(text) <= _MAX_TEXT else f"{text[:_MAX_TEXT]}..."
    return TEXT_LEFT_OUT.at(element.span, tag=element.tag, text=shown)


def read_named(owner: ElementReader, tag: str, read: Callable[[ElementReader], YamlNode], key: str = "name") -> Named:
    """Take the children of a tag by the attribute that names them; one with a name that is taken stays raw."""
    section: Named = {}

    def read_one(reader: ElementReader) -> YamlNode:
        name = reader.attribute(key)
        if name.value in section:
            raise CannotRepresentError(f"there is a {tag} '{name.value}' already", name.span)
        node = read(reader)
        section[name.value] = name, node
        return node

    for child in owner.remaining(tag):
        owner.try_read(child, read_one)
    return section


def _names_in(element: XmlElement) -> Iterator[str]:
    """Yield the tag of an element at fault, its name, and the names of the links that it joins."""
    yield element.tag
    for one in (element, *element.children):
        yield from (name for key in ("name", "link") if (name := one.get(key)))
