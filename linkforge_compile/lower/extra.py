"""Read what no field describes: raw XML and attributes (`extra…`), and free parts such as parameters of plugins."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NotRequired, TypedDict

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.part import Inside
from linkforge_compile.core.raw_xml import RawXml
from linkforge_compile.diagnostics.codes.model import ATTRIBUTE_OF_OWNER, LIST_IN_LIST
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar

EXTRA_KEYS = frozenset({"extra", "extra_attributes", "extra_inside"})


class OuterExtras(TypedDict):
    """Raw XML of a link or a robot, which have no elements inside that are not parts."""

    extra_elements: tuple[str, ...]
    extra_attributes: tuple[tuple[str, str], ...]


class CommonKwargs(TypedDict):
    """The keyword arguments of every element: where it was written, and its raw XML if it has any."""

    source: SourceRef
    extra_elements: NotRequired[tuple[str, ...]]
    extra_attributes: NotRequired[tuple[tuple[str, str], ...]]
    extra_inside: NotRequired[tuple[Inside, ...]]


def common_kwargs(fields: Fields) -> CommonKwargs:
    """Return the keyword arguments that the constructor of every element accepts.

    Formats check the raw XML, because it depends on them how it is written.
    """
    if EXTRA_KEYS.isdisjoint(fields.node.entries):
        return {"source": fields.ref}
    return {"source": fields.ref, **outer_extras_of(fields), "extra_inside": tuple(_insides(fields))}


def outer_extras_of(fields: Fields) -> OuterExtras:
    """Read the raw XML and the raw attributes of a link or a robot."""
    attributes = fields.map("extra_attributes")
    texts = ((fields.text_at(node, "extra"), SourceRef(node, None, fields.trail)) for node in fields.items("extra"))
    return {
        "extra_elements": tuple(RawXml(text, source) for text, source in texts if text and text.strip()),
        "extra_attributes": tuple((RawXml(name, attributes.ref), text) for name, text in texts_in(attributes).items())
        if attributes
        else (),
    }


def _insides(fields: Fields) -> Iterator[Inside]:
    """Read the raw XML of elements inside, by tag, or by tag and name with a space between them."""
    for key, inside in fields.each("extra_inside", "element", lambda inside, _: inside):
        tag, _, name = key.partition(" ")
        if inside:
            yield Inside(tag, name.strip() or None, **common_kwargs(inside))


def free_elements(fields: Fields, key: str) -> dict[str, FreePart]:
    """Read the child elements under a key by their tags: a text, a map of children, or a list for a tag that repeats.

    In a map a key `_x` is the attribute `x`, `_text` the text; those of the owner itself are its `extra_attributes`.
    """
    section = fields.map(key)
    if section is None:
        return {}
    for entry in section.node:
        if entry.name.startswith("_"):
            section.report(ATTRIBUTE_OF_OWNER, entry.key, name=entry.name, owner=fields.title)
    return {tag: part for tag, part in _children(section) if not tag.startswith("_")}


def free_texts(fields: Fields, key: str) -> dict[str, str]:
    """Read the texts under a key by their names, for parameters without structure."""
    section = fields.map(key)
    return texts_in(section) if section else {}


def texts_in(section: Fields, *other_keys: str) -> dict[str, str]:
    """Read all fields of an object as texts, except `other_keys`."""
    entries = [entry for entry in section.node if entry.name not in other_keys and not is_absent(entry.value)]
    texts = {entry.name: section.text_at(entry.value, entry.name) for entry in entries}
    return {name: text for name, text in texts.items() if text is not None}


def is_absent(node: YamlNode) -> bool:
    """Whether a key has no value at all; in a free part, a written null is a text."""
    return isinstance(node, YamlScalar) and node.value is None and not node.text


def _children(element: Fields) -> Iterator[tuple[str, FreePart]]:
    for entry in element.node:
        if is_absent(entry.value):
            continue
        is_attribute = entry.name.startswith("_")
        part = element.text_at(entry.value, entry.name) if is_attribute else _part(element, entry.value, entry.name)
        if part is not None:
            yield entry.name, part


def _part(parent: Fields, node: YamlNode, tag: str) -> FreePart | None:
    if isinstance(node, YamlList):
        parts = [_item(parent, item, tag) for item in node if not is_absent(item)]
        return tuple(part for part in parts if part is not None)
    return _item(parent, node, tag)


def _item(parent: Fields, node: YamlNode, tag: str) -> FreePart | None:
    match node:
        case YamlScalar():
            return node.text
        case YamlMap():
            element = parent.map_at(node, tag)
            return dict(_children(element)) if element else None
        case YamlList():
            parent.report(LIST_IN_LIST, node, field=tag)
        case YamlFault():
            pass
    return None
