"""Read elements that plugins define: attributes and children become keys, where nothing is lost by that."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from itertools import groupby

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.raw_xml import is_name, is_name_as_text, known_tag, with_prefix
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import number_text


def read_text(element: ElementReader) -> YamlScalar:
    """Read an element that contains text only."""
    node = element.draft.word(text_of(element.element), element.span)
    element.take_text()
    element.require_used_up()
    return node


def read_word(element: ElementReader) -> YamlScalar:
    """Read an element that contains text only, and not only blanks."""
    node = read_text(element)
    if not node.text.strip():
        raise element.cannot_represent("it is empty")
    return node


def text_of(element: XmlElement) -> str:
    """Return the text of an element, without the space around it if that has line breaks."""
    text = element.text
    stripped = text.strip()
    around = (text.partition(stripped)[0], text.rpartition(stripped)[2]) if stripped else (text, "")
    return stripped if any("\n" in space for space in around) else text


def read_free(element: ElementReader, around: str | None = None) -> YamlNode:
    """Read a free element: attributes as `_name`, text as `_text`, and children by their tags.

    `around` is the tag around it if names in it take the prefix, else None.
    """
    tag = element.element.tag
    known = known_tag(tag, around)
    is_text_name = is_name_as_text(tag, around, element.element.text, element.draft.shapes)
    if not element.element.values and not element.remaining():
        node = read_text(element)
        return with_prefix(node) if is_text_name else node
    entries: dict[str, YamlNode | None] = {}
    for name in element.element.values:
        attribute = element.attribute(name)
        value = element.draft.word(attribute.value, attribute.span)
        entries[f"_{name}"] = with_prefix(value) if is_name(known, name) else value
    if text := text_of(element.element).strip():
        text_node = element.draft.word(text, element.span)
        entries["_text"] = with_prefix(text_node) if is_text_name else text_node
    element.take_text()
    return element.draft.map_of({**entries, **take_children(element, known)}, element.span)


def is_free(element: XmlElement) -> bool:
    """Whether keys represent an element: no order is lost, and no name has another meaning."""
    is_text_first = not element.text.strip() or not element.children or _begins_with_text(element)
    return "text" not in element.values and is_text_first and has_free_children(element)


def has_free_children(element: XmlElement) -> bool:
    """Whether keys represent the children of an element."""
    tags = [tag for tag, _ in groupby(child.tag for child in element.children)]
    return (
        len(set(tags)) == len(tags)
        and not any(tag.startswith("_") for tag in tags)
        and all(map(is_free, element.children))
    )


def _begins_with_text(element: XmlElement) -> bool:
    """Whether all text of an element is before its children."""
    first, *others = element.content
    return isinstance(first, str) and not any(isinstance(one, str) and one.strip() for one in others)


def take_children(owner: ElementReader, known: str | None = None) -> dict[str, YamlNode | None]:
    """Take all children of a free element by tag; a tag that repeats becomes a list."""
    groups = groupby(owner.remaining(), lambda child: child.tag)
    return {tag: _one_or_list(owner, list(group), known) for tag, group in groups}


def take_free_children(owner: ElementReader) -> dict[str, YamlNode | None]:
    """Take the children with tags of which all elements are free."""
    groups: defaultdict[str, list[XmlElement]] = defaultdict(list)
    for child in owner.remaining():
        groups[child.tag].append(child)
    free = {tag: group for tag, group in groups.items() if not tag.startswith("_") and all(map(is_free, group))}
    return {tag: _one_or_list(owner, group, owner.element.tag) for tag, group in free.items()}


def take_texts(owner: ElementReader, children: Iterable[XmlElement]) -> dict[str, YamlNode | None]:
    """Take those of the children that contain text only and whose tag does not repeat."""
    counts = Counter(child.tag for child in owner.remaining())
    texts = [one for one in children if not one.values and not one.children and counts[one.tag] == 1]
    return {one.tag: owner.read(one, read_text) for one in texts if not one.tag.startswith("_")}


def exact_number(element: XmlElement) -> float | None:
    """Return the number that an element contains, if nothing else is in it and its spelling is normal."""
    if element.values or element.children:
        return None
    text = element.text.strip()
    value = number_of(text)
    return value if value is not None and number_text(value) == text else None


def is_empty(node: YamlNode) -> bool:
    """Whether a node is an empty map."""
    return isinstance(node, YamlMap) and not len(node)


def _one_or_list(owner: ElementReader, group: list[XmlElement], known: str | None) -> YamlNode | None:
    return owner.draft.one_or_list([owner.read(child, lambda element: read_free(element, known)) for child in group])
