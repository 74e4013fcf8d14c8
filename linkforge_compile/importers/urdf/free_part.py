"""What plugins read: child elements as keys, where an element made of these keys is the same again."""

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
    """Read an element that holds text and nothing else."""
    node = element.draft.word(text_of(element.element), element.span)
    element.take_text()
    element.require_used_up()
    return node


def read_word(element: ElementReader) -> YamlScalar:
    """Read an element that holds some text, and nothing else."""
    node = read_text(element)
    if not node.text.strip():
        raise element.cannot_represent("it is empty")
    return node


def text_of(element: XmlElement) -> str:
    """Return the text of an element; where it stands on lines of its own, without the space around it."""
    text = element.text
    stripped = text.strip()
    around = (text.partition(stripped)[0], text.rpartition(stripped)[2]) if stripped else (text, "")
    return stripped if any("\n" in space for space in around) else text


def read_free(element: ElementReader, around: str | None = None) -> YamlNode:
    """Read a free element: attributes as `_name`, its text as `_text`, and its children by their tags.

    `around` is the tag around it where names may stand that take the prefix, None elsewhere.
    """
    tag = element.element.tag
    place = known_tag(tag, around)
    is_name_here = is_name_as_text(tag, around, element.element.text, element.draft.shapes)
    if not element.element.values and not element.remaining():
        node = read_text(element)
        return with_prefix(node) if is_name_here else node
    entries: dict[str, YamlNode | None] = {}
    for name in element.element.values:
        taken = element.attribute(name)
        value = element.draft.word(taken.value, taken.span)
        entries[f"_{name}"] = with_prefix(value) if is_name(place, name) else value
    if text := text_of(element.element).strip():
        said = element.draft.word(text, element.span)
        entries["_text"] = with_prefix(said) if is_name_here else said
    element.take_text()
    return element.draft.map_of({**entries, **free_children(element, place)}, element.span)


def is_free(element: XmlElement) -> bool:
    """Whether an element made of keys would be the same: no order lost, and no name that means something else."""
    is_text_first = not element.text.strip() or not element.children or _begins_with_text(element)
    return "text" not in element.values and is_text_first and has_free_children(element)


def has_free_children(element: XmlElement) -> bool:
    """Whether the children of an element can be keys."""
    tags = [tag for tag, _ in groupby(child.tag for child in element.children)]
    return (
        len(set(tags)) == len(tags)
        and not any(tag.startswith("_") for tag in tags)
        and all(map(is_free, element.children))
    )


def _begins_with_text(element: XmlElement) -> bool:
    """Whether all text of an element stands before its children."""
    first, *others = element.content
    return isinstance(first, str) and not any(isinstance(one, str) and one.strip() for one in others)


def free_children(owner: ElementReader, place: str | None = None) -> dict[str, YamlNode | None]:
    """Take all children of a free element, each tag a key; a tag that repeats is a list."""
    groups = [(tag, list(group)) for tag, group in groupby(owner.remaining(), lambda child: child.tag)]
    return {tag: _one_or_several(owner, group, place) for tag, group in groups}


def take_free(owner: ElementReader) -> dict[str, YamlNode | None]:
    """Take the children whose tag is of none but free elements, each tag a key; all others are left."""
    groups: defaultdict[str, list[XmlElement]] = defaultdict(list)
    for child in owner.remaining():
        groups[child.tag].append(child)
    free = {tag: group for tag, group in groups.items() if not tag.startswith("_") and all(map(is_free, group))}
    return {tag: _one_or_several(owner, group, owner.element.tag) for tag, group in free.items()}


def take_texts(owner: ElementReader, children: Iterable[XmlElement]) -> dict[str, YamlNode | None]:
    """Take those of the children that hold text and nothing else, each tag a key; all others are left."""
    several = _tags_that_repeat(owner.remaining())
    plain = [one for one in children if not one.values and not one.children and one.tag not in several]
    return {one.tag: owner.read(one, read_text) for one in plain if not one.tag.startswith("_")}


def exact_number(element: XmlElement) -> float | None:
    """Return the number that an element holds, if it holds nothing else and is spelled as we would spell it."""
    if element.values or element.children:
        return None
    text = element.text.strip()
    value = number_of(text)
    return value if value is not None and number_text(value) == text else None


def _one_or_several(owner: ElementReader, group: list[XmlElement], place: str | None) -> YamlNode | None:
    nodes = [owner.read(child, lambda element: read_free(element, place)) for child in group]
    if len(nodes) == 1:
        return nodes[0]
    return owner.draft.list_of(nodes, nodes[0].span)


def _tags_that_repeat(children: list[XmlElement]) -> set[str]:
    return {tag for tag, count in Counter(child.tag for child in children).items() if count > 1}


def is_empty(node: YamlNode) -> bool:
    return isinstance(node, YamlMap) and not len(node)
