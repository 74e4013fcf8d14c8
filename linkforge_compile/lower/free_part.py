"""Free parts: what a plugin reads, passed on as the text that was written, or as elements where it is nested."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.diagnostics.codes.model import ATTRIBUTE_OF_OWNER, LIST_IN_LIST
from linkforge_compile.lower.fields import Fields
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar


def free_elements(fields: Fields, key: str) -> dict[str, FreePart]:
    """Read the child elements under a key by their tags: a text, a map of children, or a list for a tag that repeats.

    In a map a key `_x` is the attribute `x`, `_text` the text; those of the owner itself are its `extra_attributes`.
    """
    section = fields.map(key)
    if section is None:
        return {}
    for entry in section.node:
        if entry.name.startswith("_"):
            section.tell(ATTRIBUTE_OF_OWNER, entry.key, name=entry.name, owner=fields.title)
    return {tag: part for tag, part in _children(section) if not tag.startswith("_")}


def free_texts(fields: Fields, key: str) -> dict[str, str]:
    """Read the texts under a key by their names, for parameters and attributes that hold nothing else."""
    section = fields.map(key)
    return texts_in(section) if section else {}


def texts_in(section: Fields, *others: str) -> dict[str, str]:
    """Read the texts that stand as fields of an object, without those keys that it knows itself."""
    entries = [entry for entry in section.node if entry.name not in others and not is_unsaid(entry.value)]
    texts = {entry.name: section.text_at(entry.value, entry.name) for entry in entries}
    return {name: text for name, text in texts.items() if text is not None}


def is_unsaid(node: YamlNode) -> bool:
    """Whether nothing was written at all: a null that somebody wrote is a text here."""
    return isinstance(node, YamlScalar) and node.value is None and not node.text


def _children(element: Fields) -> Iterator[tuple[str, FreePart]]:
    for entry in element.node:
        attribute = entry.name.startswith("_")
        if is_unsaid(entry.value):
            continue
        part = element.text_at(entry.value, entry.name) if attribute else _element(element, entry.value, entry.name)
        if part is not None:
            yield entry.name, part


def _element(parent: Fields, node: YamlNode, tag: str) -> FreePart | None:
    if isinstance(node, YamlList):
        parts = [_item(parent, item, tag) for item in node if not is_unsaid(item)]
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
            parent.tell(LIST_IN_LIST, node, field=tag)
        case YamlFault():
            pass
    return None
