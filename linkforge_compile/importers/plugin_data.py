"""Read what plugins define: Gazebo blocks, and free elements, where nothing is lost by keys."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import groupby
from typing import NamedTuple

from linkforge_compile.core.fields import Number, Spec, field_specs
from linkforge_compile.core.models.gazebo import ELEMENT_TAGS, GazeboElement
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import TAGS_GROUPED
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.raw_xml import is_name, is_name_as_text, known_tag, with_prefix
from linkforge_compile.importers.spec_draft import CannotRepresentError, number_of
from linkforge_compile.importers.texts import exact_number, is_flag, is_normal, is_text, read_text, read_word, text_of
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import is_in_full, number_text


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
    """Whether keys represent an element: its text is first, and no name has another meaning."""
    is_text_first = not element.text.strip() or not element.children or _begins_with_text(element)
    return "text" not in element.values and is_text_first and has_free_children(element)


def has_free_children(element: XmlElement) -> bool:
    """Whether keys represent the children of an element; plugins read them by tag, so the order of tags is lost."""
    return all(not _is_no_key(child.tag) and is_free(child) for child in element.children)


def _is_no_key(tag: str) -> bool:
    """Whether a key of this name would be an attribute, a condition or a repetition."""
    return tag.startswith("_") or tag in ("for", "when")


def _begins_with_text(element: XmlElement) -> bool:
    """Whether all text of an element is before its children."""
    first, *others = element.content
    return isinstance(first, str) and not any(isinstance(one, str) and one.strip() for one in others)


def take_children(owner: ElementReader, known: str | None = None) -> dict[str, YamlNode | None]:
    """Take all children of a free element by tag; a tag that repeats becomes a list."""
    return {tag: _one_or_list(owner, group, known) for tag, group in _by_tag(owner).items()}


def take_free_children(owner: ElementReader) -> dict[str, YamlNode | None]:
    """Take the children with tags of which all elements are free."""
    groups = _by_tag(owner)
    free = {tag: group for tag, group in groups.items() if not _is_no_key(tag) and all(map(is_free, group))}
    return {tag: _one_or_list(owner, group, owner.element.tag) for tag, group in free.items()}


def _by_tag(owner: ElementReader) -> Mapping[str, list[XmlElement]]:
    groups: defaultdict[str, list[XmlElement]] = defaultdict(list)
    for child in owner.remaining():
        groups[child.tag].append(child)
    if found := tags_grouped(owner.element, owner.remaining()):
        owner.draft.diagnostics.append(found)
    return groups


def tags_grouped(element: XmlElement, children: Iterable[XmlElement]) -> Diagnostic | None:
    """Return the note that children are grouped by tag; None if their order stays the same."""
    runs = Counter(tag for tag, _ in groupby(child.tag for child in children))
    repeated = [tag for tag, count in runs.items() if count > 1]
    return TAGS_GROUPED.at(element.span, tag=element.tag, repeated=">, <".join(repeated)) if repeated else None


def _one_or_list(owner: ElementReader, group: list[XmlElement], known: str | None) -> YamlNode | None:
    return owner.draft.one_or_list([owner.read(child, lambda element: read_free(element, known)) for child in group])


class Blocks:
    """The Gazebo blocks of a robot, until the links and joints that they are about take them."""

    def __init__(self, robot: ElementReader) -> None:
        """Take the blocks of a robot, except those about an unknown part."""
        self._draft = robot.draft
        self._blocks: list[tuple[str | None, YamlNode]] = []
        names = {child.get("name") for child in robot.element.children if child.tag in ("link", "joint")}
        names |= robot.draft.outside
        for child in robot.remaining("gazebo"):
            node = robot.try_read(child, lambda block: _read_block(block, names))
            if node is not None:
                self._blocks.append((child.get("reference"), node))

    def take(self, name: str) -> YamlNode | None:
        """Return and remove the blocks about a link or joint."""
        nodes = [node for reference, node in self._blocks if reference == name]
        self._blocks = [block for block in self._blocks if block[0] != name]
        return self._draft.one_or_list(nodes)

    def take_rest(self) -> YamlNode | None:
        """Return the blocks that were not taken, with their references."""
        draft, nodes = self._draft, []
        for reference, block in self._blocks:
            node = block
            if reference is not None and isinstance(block, YamlMap):
                entries = {entry.name: entry.value for entry in block}
                node = draft.map_of({"reference": draft.text(reference, block.span), **entries}, block.span)
                draft.note_same_source(node, block)
            nodes.append(node)
        return draft.one_or_list(nodes)


def _read_block(block: ElementReader, names: Collection[str | None]) -> YamlMap:
    if "reference" in block.element.values:
        reference = block.attribute("reference")
        if reference.value not in names:
            raise CannotRepresentError(f"there is no link or joint named '{reference.value}'", reference.span)
    tags = _take_tags(block)
    plugins = _take_plugins(block)
    properties = take_free_children(block)
    return block.map(
        **tags,
        properties=block.draft.map_of(properties, block.span) if properties else None,
        plugins=plugins,
    )


def _take_tags(block: ElementReader) -> dict[str, YamlNode | None]:
    """Take the tags that are keys, if their texts are in normal form."""
    children = block.remaining()
    counts = Counter(child.tag for child in children)
    nodes: dict[str, YamlNode | None] = {}
    for child in children:
        tag = _TAGS.get(child.tag)
        if tag and counts[child.tag] == 1 and tag.is_normal(child):
            nodes[tag.key] = block.read(child, tag.read)
    return nodes


def _take_plugins(block: ElementReader) -> YamlNode | None:
    """Take the plugins by name, or as a list where a name repeats."""
    children = block.remaining("plugin")
    names = [child.get("name") for child in children]
    is_list = len(set(names)) < len(names)
    plugins: dict[str, YamlNode | None] = {}
    nodes: list[YamlNode] = []
    for child in children:
        node = block.try_read(child, lambda plugin: _read_plugin(plugin, is_named=is_list))
        if node is not None:
            nodes.append(node)
            plugins[child.get("name") or ""] = node
    if not nodes:
        return None
    return block.draft.list_of(nodes, nodes[0].span) if is_list else block.draft.map_of(plugins, block.span)


def _read_plugin(plugin: ElementReader, *, is_named: bool) -> YamlMap:
    name, filename = plugin.required_text("name"), plugin.required_text("filename")
    for attribute in (name, filename):
        if not attribute.text.strip():
            raise CannotRepresentError("its name and its filename cannot be empty", attribute.span)
    has_parameters = plugin.remaining() and has_free_children(plugin.element)
    parameters = plugin.draft.map_of(take_children(plugin), plugin.span) if has_parameters else None
    return plugin.map(name=name if is_named else None, filename=filename, parameters=parameters)


def _is_number(child: XmlElement) -> bool:
    is_full = is_text(child) and is_in_full(child.text.strip()) and number_of(child.text) is not None
    return is_full or exact_number(child) is not None


def _is_whole_number(child: XmlElement) -> bool:
    value = exact_number(child)
    return value is not None and value.is_integer() and child.text.strip().lstrip("-").isdigit()


def _is_vector(child: XmlElement) -> bool:
    values = [number_of(part) for part in child.text.split()] if is_text(child) else []
    return len(values) == 3 and [None if one is None else number_text(one) for one in values] == child.text.split()


class _Tag(NamedTuple):
    """A tag that is a key of a block: whether its text comes back as it is, and how to read it."""

    key: str
    is_normal: Callable[[XmlElement], bool]
    read: Callable[[ElementReader], YamlNode]


def _tag_of_field(key: str, spec: Spec) -> _Tag:
    """Return the tag that is a field of GazeboElement."""
    read = ElementReader.text_number if isinstance(spec, Number) else read_word
    return _Tag(key, lambda child: is_normal(child, spec), read)


_NUMBERS = (
    *("mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "dampingFactor", "laserRetro"),
    *("springStiffness", "springReference", "fudgeFactor"),
)
_FLAGS = ("selfCollide", "gravity", "turnGravityOff", "preserveFixedJoint", "disableFixedJointLumping")

_TAGS: Mapping[str, _Tag] = {
    **{tag: _tag_of_field(key, field_specs(GazeboElement)[key]) for key, tag in ELEMENT_TAGS.items()},
    "fdir1": _Tag("fdir1", _is_vector, ElementReader.text_numbers),
    "maxContacts": _Tag("maxContacts", _is_whole_number, ElementReader.text_number),
    **{tag: _Tag(tag, _is_number, ElementReader.text_number) for tag in _NUMBERS},
    **{tag: _Tag(tag, is_flag, read_word) for tag in _FLAGS},
}
