"""Gazebo: what a simulator is told about a link, a joint or the robot, and its plugins."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.models.gazebo import ELEMENT_TAGS, GazeboElement, GazeboPlugin
from linkforge_compile.core.models.link import PHYSICS_TAGS
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.model import TAG_TWICE
from linkforge_compile.lower.extra import common_kwargs, free_elements, is_absent
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import joints_of, position_type_of_node
from linkforge_compile.lower.numbers import AMOUNT, ANGLE_OR_LENGTH, BARE, FRACTION, LENGTH, NumberType
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar
from linkforge_compile.units import Dimension, is_in_full, number_text


def lower_gazebo_elements(file: Fields) -> Iterator[GazeboElement]:
    """Lower the Gazebo blocks of a file: those of its links, of its joints, and of the robot."""
    for section, kind in (("links", "link"), ("joints", "joint")):
        entries = file.node.get(section)
        for entry in entries if isinstance(entries, YamlMap) else ():
            if isinstance(entry.value, YamlMap) and "gazebo" in entry.value.entries:
                owner = Fields(entry.value, f"{kind} '{entry.name}'", file.sink, file.trail, entry.key)
                yield from lower_gazebo(owner, entry.name, {entry.name: entry.value})
    yield from lower_gazebo(file, None, joints_of(file.node))


def lower_gazebo(owner: Fields, reference: str | None, written: Mapping[str, YamlMap]) -> Iterator[GazeboElement]:
    """Lower the blocks that stand beside what they are about: the link or joint `reference`, None for the robot.

    At the robot a block may say itself what it refers to, such as a link of a module. `written` are the joints, by
    name, that may be meant.
    """
    physics = owner.node.get("physics")
    said_by_physics = dict(_tags_of_physics(physics)) if isinstance(physics, YamlMap) else {}
    for node in owner.items("gazebo"):
        block = owner.map_at(node, "gazebo")
        if block is None:
            continue
        _refuse_repeated_tags(block, said_by_physics)
        about = block.text("reference") if reference is None else reference
        element = _element(block, about, position_type_of_node(written.get(about) if about is not None else None))
        if element:
            yield element


def lower_plugin(plugin: Fields) -> GazeboPlugin | None:
    """Lower a plugin that says its name itself."""
    return _plugin(plugin, plugin.text("name", required="controller"))


def _element(block: Fields, reference: str | None, position: NumberType) -> GazeboElement | None:
    return block.build(
        lambda: GazeboElement(
            reference,
            {**dict(_known_properties(block, position)), **free_elements(block, "properties")},
            [plugin for plugin in _plugins(block) if plugin],
            block.text("material"),
            block.flag("static"),
            block.number("stop_cfm", AMOUNT),
            block.number("stop_erp", FRACTION),
            block.flag("provide_feedback"),
            block.flag("implicit_spring_damper"),
            **common_kwargs(block),
        )
    )


def _known_properties(block: Fields, position: NumberType) -> Iterator[tuple[str, FreePart]]:
    """Yield the tags that have keys of their own, in the order written; `position` is what the joint goes by."""
    for entry in block.node:
        read = _of(position) if entry.name == "springReference" else _READ.get(entry.name)
        text = read(block, entry.name) if read else None
        if text is not None:
            yield entry.name, text


def _plugins(block: Fields) -> Iterator[GazeboPlugin | None]:
    """Lower the plugins: a map by their names, or a list of those that say their names."""
    if isinstance(block.node.get("plugins"), YamlMap):
        yield from (plugin for _, plugin in block.each("plugins", "plugin", _plugin))
        return
    listed = (block.map_at(node, "plugins") for node in block.items("plugins"))
    yield from (lower_plugin(plugin) for plugin in listed if plugin)


def _plugin(plugin: Fields, name: str | None) -> GazeboPlugin | None:
    filename, parameters = plugin.text("filename", required="libcontroller.so"), free_elements(plugin, "parameters")
    if name is None or filename is None:
        return None
    return plugin.build(lambda: GazeboPlugin(name, filename, parameters, **common_kwargs(plugin)))


def _refuse_repeated_tags(block: Fields, said_by_physics: Mapping[str, YamlEntry]) -> None:
    first = dict(said_by_physics)
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


def _number(block: Fields, key: str, kind: NumberType = BARE) -> str | None:
    """Read a number of Gazebo's as text: in the spelling of its author where that is written out, as URDFs have it."""
    number = block.number(key, kind)
    if number is None:
        return None
    node = block.get(key)
    return node.text if isinstance(node, YamlScalar) and is_in_full(node.text) else number_text(number)


def _of(kind: NumberType) -> Callable[[Fields, str], str | None]:
    return lambda block, key: _number(block, key, kind)


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
    "maxVel": _of(NumberType((Dimension.VELOCITY,))),
    "minDepth": _of(LENGTH),
    "maxContacts": _whole_number,
    "selfCollide": _flag,
    "gravity": _flag,
    "turnGravityOff": _flag,
    "dampingFactor": _number,
    "laserRetro": _number,
    "springStiffness": _number,
    "springReference": _of(ANGLE_OR_LENGTH),
    "fudgeFactor": _number,
    "preserveFixedJoint": _flag,
    "disableFixedJointLumping": _flag,
}
"""The tags of SDFormat's reader of URDF that are keys under their own names, and what each of them takes."""
