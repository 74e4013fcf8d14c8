"""Gazebo blocks of links, joints and the robot: settings for a simulator, tags of SDFormat, and plugins."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.models.gazebo import ELEMENT_TAGS, GazeboElement, GazeboPlugin
from linkforge_compile.core.models.link import PHYSICS_TAGS
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.model import TAG_TWICE
from linkforge_compile.lower.elements import lower_each, lower_element
from linkforge_compile.lower.extra import free_elements, is_absent
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import ANGLE_OR_LENGTH, BARE, LENGTH, NumberType
from linkforge_compile.lower.positions import joints_of, position_type_of_node
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar
from linkforge_compile.units import Dimension, is_in_full, number_text


def lower_gazebo_elements(file: Fields) -> Iterator[GazeboElement]:
    """Lower the Gazebo blocks of a file: those of its links, of its joints, and of the robot."""
    for section, noun in (("links", "link"), ("joints", "joint")):
        entries = file.node.get(section)
        for entry in entries if isinstance(entries, YamlMap) else ():
            if isinstance(entry.value, YamlMap) and "gazebo" in entry.value.entries:
                owner = Fields(entry.value, f"{noun} '{entry.name}'", file.sink, file.trail, entry.key)
                yield from lower_gazebo(owner, entry.name, {entry.name: entry.value})
    yield from lower_gazebo(file, None, joints_of(file.node))


def lower_gazebo(owner: Fields, reference: str | None, joints: Mapping[str, YamlMap]) -> Iterator[GazeboElement]:
    """Lower the blocks of the link or joint `reference`, None for the robot.

    A block of the robot may name what it refers to, such as a link of a module. `joints` are the nodes of the joints,
    by name, that a block may refer to.
    """
    physics = owner.node.get("physics")
    tags_of_physics = dict(_tags_of_physics(physics)) if isinstance(physics, YamlMap) else {}
    for node in owner.items("gazebo"):
        block = owner.map_at(node, "gazebo")
        if block is None:
            continue
        _report_repeated_tags(block, tags_of_physics)
        target = block.text("reference") if reference is None else reference
        position = position_type_of_node(joints.get(target) if target is not None else None)
        element = lower_element(
            GazeboElement,
            block,
            reference=target,
            properties={**dict(_known_properties(block, position)), **free_elements(block, "properties")},
            plugins=[plugin for plugin in _plugins(block) if plugin],
        )
        if element:
            yield element


def _known_properties(block: Fields, position: NumberType) -> Iterator[tuple[str, FreePart]]:
    """Yield the tags that have keys of their own, in the order written; `position` is that of the joint."""
    for entry in block.node:
        read = _number_of(position) if entry.name == "springReference" else _READ.get(entry.name)
        text = read(block, entry.name) if read else None
        if text is not None:
            yield entry.name, text


def _plugins(block: Fields) -> Iterator[GazeboPlugin | None]:
    """Lower the plugins: a map by their names, or a list of plugins with names."""
    if isinstance(block.node.get("plugins"), YamlMap):
        yield from lower_each(GazeboPlugin, block, "plugins", "plugin").values()
        return
    listed = (block.map_at(node, "plugins") for node in block.items("plugins"))
    yield from (lower_element(GazeboPlugin, plugin) for plugin in listed if plugin)


def _report_repeated_tags(block: Fields, tags_of_physics: Mapping[str, YamlEntry]) -> None:
    first = dict(tags_of_physics)
    for tag, entry in _tags_of_block(block.node):
        earlier = first.setdefault(tag, entry)
        if earlier is not entry:
            notes = [Note("the first is here", earlier.key.span)]
            place = SourceRef(entry.key, None, block.trail)
            block.sink.report(TAG_TWICE.at(place, tag=tag, owner=block.owner, notes=notes))


def _tags_of_physics(physics: YamlMap) -> Iterator[tuple[str, YamlEntry]]:
    for entry in physics:
        tag = PHYSICS_TAGS.get(entry.name)
        if tag and physics.get(entry.name) is not None:
            yield tag, entry


def _tags_of_block(block: YamlMap) -> Iterator[tuple[str, YamlEntry]]:
    for entry in block:
        tag = entry.name if entry.name in _READ else ELEMENT_TAGS.get(entry.name)
        if tag and block.get(entry.name) is not None:
            yield tag, entry
    properties = block.get("properties")
    for entry in properties if isinstance(properties, YamlMap) else ():
        if not is_absent(entry.value):
            yield entry.name, entry


def _number(block: Fields, key: str, accepted: NumberType = BARE) -> str | None:
    """Read a number as text, as it was written unless it needs a conversion."""
    number = block.number(key, accepted)
    if number is None:
        return None
    node = block.get(key)
    return node.text if isinstance(node, YamlScalar) and is_in_full(node.text) else number_text(number)


def _number_of(accepted: NumberType) -> Callable[[Fields, str], str | None]:
    return lambda block, key: _number(block, key, accepted)


def _whole_number(block: Fields, key: str) -> str | None:
    number = block.integer(key)
    return None if number is None else str(number)


def _flag(block: Fields, key: str) -> str | None:
    flag = block.flag(key)
    return None if flag is None else str(flag).lower()


def _vector(block: Fields, key: str) -> str | None:
    vector = block.vector3(key)
    return None if vector is None else " ".join(map(number_text, vector))


_READ: dict[str, Callable[[Fields, str], str | None]] = {
    "mu1": _number,
    "mu2": _number,
    "fdir1": _vector,
    "kp": _number,
    "kd": _number,
    "maxVel": _number_of(NumberType((Dimension.VELOCITY,))),
    "minDepth": _number_of(LENGTH),
    "maxContacts": _whole_number,
    "selfCollide": _flag,
    "gravity": _flag,
    "turnGravityOff": _flag,
    "dampingFactor": _number,
    "laserRetro": _number,
    "springStiffness": _number,
    "springReference": _number_of(ANGLE_OR_LENGTH),
    "fudgeFactor": _number,
    "preserveFixedJoint": _flag,
    "disableFixedJointLumping": _flag,
}
"""The tags of SDFormat's reader of URDF that are keys under their own names, and how each is read."""
