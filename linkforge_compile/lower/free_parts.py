"""Parts of a spec without a schema: what plugins read, as texts, and data whose values keep their types."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from linkforge_compile.core.part import FreePart
from linkforge_compile.diagnostics.codes.model import ATTRIBUTE_OF_OWNER, LIST_IN_LIST
from linkforge_compile.diagnostics.entry_fixes import add_entry, leave_out, together
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.lower.fields import Fields
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Quantity

PlainData: TypeAlias = "None | bool | int | float | str | list[PlainData] | dict[str, PlainData]"


def typed_data(fields: Fields, key: str) -> dict[str, object]:
    """Read the values under a key by their names, with their types."""
    section = fields.map(key)
    if section is None:
        return {}
    return {entry.name: typed_value(entry.value) for entry in section.node if not is_absent(entry.value)}


def typed_value(node: YamlNode) -> PlainData:
    """Return the value of a node with its type; a quantity in SI units, None for a faulty value, or a list with one."""
    match node:
        case YamlScalar(value=value):
            return value.value if isinstance(value, Quantity) else value
        case YamlList():
            if any(isinstance(item, YamlFault) for item in node):
                return None
            return [typed_value(item) for item in node]
        case YamlMap():
            return {entry.name: typed_value(entry.value) for entry in node if not is_absent(entry.value)}
        case YamlFault():
            return None


def free_elements(fields: Fields, key: str) -> dict[str, FreePart]:
    """Read the child elements under a key by their tags: a text, a map of children, or a list for a tag that repeats.

    In a map a key `_x` is the attribute `x`, `_text` the text; those of the owner itself are its `extra_attributes`.
    """
    section = fields.map(key)
    if section is None:
        return {}
    for entry in section.node:
        if entry.name.startswith("_"):
            fix = _as_attribute(fields, section, entry)
            section.report(ATTRIBUTE_OF_OWNER, entry.key, fixes=[fix], name=entry.name, owner=fields.title)
    return {tag: part for tag, part in _free_children(section) if not tag.startswith("_")}


def _as_attribute(fields: Fields, section: Fields, entry: YamlEntry) -> Fix | None:
    """Return the fix that writes an entry of free parts as an attribute of the object that has them."""
    if not isinstance(entry.value, YamlScalar) or fields.get("extra_attributes") is not None:
        return None
    new = f"extra_attributes: {{{entry.name.removeprefix('_')}: {entry.value.span.text}}}"
    return together(f"write '{new}'", add_entry(fields.ref, entry=new), leave_out(section.ref, entry.name))


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


def _free_children(element: Fields) -> Iterator[tuple[str, FreePart]]:
    for entry in element.node:
        if is_absent(entry.value):
            continue
        is_attribute = entry.name.startswith("_")
        part = (
            element.text_at(entry.value, entry.name) if is_attribute else _free_part(element, entry.value, entry.name)
        )
        if part is not None:
            yield entry.name, part


def _free_part(parent: Fields, node: YamlNode, tag: str) -> FreePart | None:
    if isinstance(node, YamlList):
        parts = [_free_item(parent, item, tag) for item in node if not is_absent(item)]
        return tuple(part for part in parts if part is not None)
    return _free_item(parent, node, tag)


def _free_item(parent: Fields, node: YamlNode, tag: str) -> FreePart | None:
    match node:
        case YamlScalar():
            return node.text
        case YamlMap():
            element = parent.map_at(node, tag)
            return dict(_free_children(element)) if element else None
        case YamlList():
            parent.report(LIST_IN_LIST, node, field=tag)
        case YamlFault():
            pass
    return None
