"""Gazebo blocks of URDF, each beside the link or joint that it is about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError, number_of
from linkforge_compile.importers.urdf.free_part import (
    exact_number,
    free_children,
    has_free_children,
    read_word,
    take_free,
)
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import is_in_full, number_text


class Blocks:
    """The Gazebo blocks of a robot, until the entries beside which they stand take them."""

    def __init__(self, robot: ElementReader) -> None:
        """Take the blocks of a robot; one that is about nothing in it is left."""
        self._robot = robot
        self._blocks: list[tuple[str | None, YamlNode]] = []
        names = {child.get("name") for child in robot.element.children if child.tag in ("link", "joint")}
        for child in [child for child in robot.remaining() if child.tag == "gazebo"]:
            node = robot.try_read(child, lambda block: _block(block, names))
            if node is not None:
                self._blocks.append((child.get("reference"), node))

    def beside(self, name: str) -> YamlNode | None:
        """Return the blocks about a link or joint; nobody else gets them."""
        nodes = [node for reference, node in self._blocks if reference == name]
        self._blocks = [block for block in self._blocks if block[0] != name]
        return self._robot.draft.one_or_list(nodes)

    def rest(self) -> YamlNode | None:
        """Return the blocks that nobody got, each with what it is about."""
        draft, nodes = self._robot.draft, []
        for reference, block in self._blocks:
            node = block
            if reference is not None and isinstance(node, YamlMap):
                said = {entry.name: entry.value for entry in node}
                whole = draft.map_of({"reference": draft.text(reference, node.span), **said}, node.span)
                draft.note_same_source(whole, block)
                node = whole
            nodes.append(node)
        return draft.one_or_list(nodes)


def _block(block: ElementReader, names: Collection[str | None]) -> YamlMap:
    if "reference" in block.element.values:
        reference = block.attribute("reference")
        if reference.value not in names:
            raise CannotRepresentError(f"there is no link or joint named '{reference.value}'", reference.span)
    tags = _tags(block)
    plugins = _plugins(block)
    properties = take_free(block)
    return block.map(
        **tags,
        properties=block.draft.map_of(properties, block.span) if properties else None,
        plugins=plugins,
    )


def _tags(block: ElementReader) -> dict[str, YamlNode | None]:
    """Take the tags that are keys, where they come back as they are spelled."""
    children = block.remaining()
    times = Counter(child.tag for child in children)
    said: dict[str, YamlNode | None] = {}
    for child in children:
        key, spelled_so, read = _KEYS.get(child.tag, _NO_KEY)
        if times[child.tag] == 1 and spelled_so(child):
            said[key] = block.read(child, read)
    return said


def _plugins(block: ElementReader) -> YamlNode | None:
    """Take the plugins: by their names, or as a list where a name repeats."""
    names = [child.get("name") for child in block.remaining() if child.tag == "plugin"]
    are_listed = len(set(names)) < len(names)
    plugins: dict[str, YamlNode | None] = {}
    nodes: list[YamlNode] = []
    for child in [child for child in block.remaining() if child.tag == "plugin"]:
        node = block.try_read(child, lambda plugin: _plugin(plugin, is_named=are_listed))
        if node is not None:
            nodes.append(node)
            plugins[child.get("name") or ""] = node
    if not nodes:
        return None
    return block.draft.list_of(nodes, nodes[0].span) if are_listed else block.draft.map_of(plugins, block.span)


def _plugin(plugin: ElementReader, *, is_named: bool) -> YamlMap:
    name, filename = plugin.required_text(), plugin.required_text("filename")
    for attribute in (name, filename):
        if not attribute.text.strip():
            raise CannotRepresentError("its name and its filename cannot be empty", attribute.span)
    return plugin.map(name=name if is_named else None, filename=filename, parameters=_parameters(plugin))


def _parameters(plugin: ElementReader) -> YamlNode | None:
    """Take all that a plugin is told, or nothing, where keys would tell it otherwise."""
    if not plugin.remaining() or not has_free_children(plugin.element):
        return None
    return plugin.draft.map_of(free_children(plugin), plugin.span)


def _is_number(child: XmlElement) -> bool:
    is_in_full_here = _is_text(child) and is_in_full(child.text.strip()) and number_of(child.text) is not None
    return exact_number(child) is not None or is_in_full_here


def _is_share(child: XmlElement) -> bool:
    value = exact_number(child)
    return value is not None and 0 <= value <= 1


def _is_not_negative(child: XmlElement) -> bool:
    value = exact_number(child)
    return value is not None and value >= 0


def _is_whole_number(child: XmlElement) -> bool:
    value = exact_number(child)
    return value is not None and value.is_integer() and child.text.strip().lstrip("-").isdigit()


def _is_flag(child: XmlElement) -> bool:
    return _is_text(child) and child.text.strip() in ("true", "false")


def _is_text(child: XmlElement) -> bool:
    return not child.values and not child.children and bool(child.text.strip())


def _is_vector(child: XmlElement) -> bool:
    values = [number_of(part) for part in child.text.split()] if _is_text(child) else []
    return len(values) == 3 and [None if one is None else number_text(one) for one in values] == child.text.split()


def _never(_child: XmlElement) -> bool:
    return False


def _vector(child: ElementReader) -> YamlNode:
    return child.text_numbers()


def _number(child: ElementReader) -> YamlNode:
    return child.text_number()


_Key = tuple[str, Callable[[XmlElement], bool], Callable[[ElementReader], YamlNode]]
_NO_KEY: _Key = ("", _never, read_word)
_KEYS: Mapping[str, _Key] = {
    "material": ("material", _is_text, read_word),
    "static": ("static", _is_flag, read_word),
    "stopCfm": ("stop_cfm", _is_not_negative, _number),
    "stopErp": ("stop_erp", _is_share, _number),
    "provideFeedback": ("provide_feedback", _is_flag, read_word),
    "implicitSpringDamper": ("implicit_spring_damper", _is_flag, read_word),
    "fdir1": ("fdir1", _is_vector, _vector),
    "maxContacts": ("maxContacts", _is_whole_number, _number),
    **{
        tag: (tag, _is_number, _number)
        for tag in (
            *("mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "dampingFactor", "laserRetro"),
            *("springStiffness", "springReference", "fudgeFactor"),
        )
    },
    **{
        tag: (tag, _is_flag, read_word)
        for tag in ("selfCollide", "gravity", "turnGravityOff", "preserveFixedJoint", "disableFixedJointLumping")
    },
}
"""The tags that are keys of a block, and how they must be spelled to come back so."""
