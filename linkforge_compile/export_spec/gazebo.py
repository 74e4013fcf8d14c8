"""What a simulator is told, as a spec writes it: beside what it is about, or at the end of the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.link import PHYSICS_TAGS, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.syntax import YamlMap, YamlNode, scalar_value
from linkforge_compile.units import is_in_full, number_text

if TYPE_CHECKING:
    from linkforge_compile.core.frozen_map import FreePart


class GazeboPlaces(NamedTuple):
    """Where each block stands: beside a link, beside a joint, or at the robot, where it says its reference itself."""

    links: dict[str, list[GazeboElement]]
    joints: dict[str, list[GazeboElement]]
    robot: list[GazeboElement]


def gazebo_places(robot: Robot) -> GazeboPlaces:
    """Return where each block stands so that their order is kept: the links' come out first, then the joints'.

    A block that repeats its link's physics cannot stand beside them.
    """
    places = GazeboPlaces({}, {}, [])
    links = {name: (0, place) for place, name in enumerate(robot.links.names)}
    joints = {name: (1, place) for place, name in enumerate(robot.joints.names)}
    latest = (0, 0)
    for element in robot.gazebo_elements:
        reference = element.reference or ""
        at = next((known[reference] for known in (links, joints) if known.get(reference, (-1, -1)) >= latest), None)
        if places.robot or at is None or (not at[0] and _repeats(robot.link(reference).physics, element)):
            places.robot.append(element)
            continue
        latest = at
        (places.joints if at[0] else places.links).setdefault(reference, []).append(element)
    return places


def _repeats(physics: LinkPhysics, element: GazeboElement) -> bool:
    """Whether a block says a tag that the physics of its link say, which no entry may do."""
    return any(tag in element.properties and physics.is_written(field) for field, tag in PHYSICS_TAGS.items())


def written_blocks(builder: SpecBuilder, blocks: Iterable[GazeboElement], *, beside: bool = True) -> YamlNode | None:
    """Return one block or a list of them, None for none; those `beside` what they are about do not name it."""
    nodes = [_block(builder, block, beside) for block in blocks]
    if not nodes:
        return None
    return nodes[0] if len(nodes) == 1 and not builder.full else builder.list_of(nodes)


def written_plugin(builder: SpecBuilder, plugin: GazeboPlugin, *, named: bool) -> YamlMap:
    """Return a plugin, which says its name itself where it is `named`; content that was read as XML is its `extra`."""
    if plugin.raw_xml is not None:
        plugin = replace(plugin, parameters={}, extra_elements=(plugin.raw_xml, *plugin.extra_elements))
    return builder.element(
        plugin,
        name=builder.text(plugin.name) if named else None,
        filename=builder.text(plugin.filename),
        parameters=builder.free_map(plugin.parameters),
    )


def _block(builder: SpecBuilder, block: GazeboElement, beside: bool) -> YamlMap:
    tags = _leading_tags(block.properties)
    rest = {tag: part for tag, part in block.properties.items() if tag not in tags}
    return builder.element(
        block,
        reference=None if beside else builder.text(block.reference),
        material=builder.text(block.material),
        static=builder.flag(block.static),
        stop_cfm=builder.number(block.stop_cfm),
        stop_erp=builder.number(block.stop_erp),
        provide_feedback=builder.flag(block.provide_feedback),
        implicit_spring_damper=builder.flag(block.implicit_spring_damper),
        **{tag: builder.free(part) for tag, part in tags.items()},
        properties=builder.free_map(rest),
        plugins=_plugins(builder, block),
    )


def _plugins(builder: SpecBuilder, block: GazeboElement) -> YamlNode | None:
    """Return the plugins by their names, or as a list where a name repeats."""
    names = [plugin.name for plugin in block.plugins]
    if len(set(names)) < len(names):
        return builder.list_of(written_plugin(builder, plugin, named=True) for plugin in block.plugins)
    return builder.named("plugin", ((one.name, written_plugin(builder, one, named=False)) for one in block.plugins))


def _leading_tags(properties: Mapping[str, FreePart]) -> dict[str, FreePart]:
    """Return the properties that may stand as keys of their own, which come out before all others.

    A key reads its value and spells it anew, so a property keeps its text only if that is how it would be spelled.
    """
    tags: dict[str, FreePart] = {}
    for tag, part in properties.items():
        spelled_so = _SPELLED_SO.get(tag)
        if spelled_so is None or not isinstance(part, str) or not spelled_so(part):
            break
        tags[tag] = part
    return tags


def _is_number(text: str) -> bool:
    value = scalar_value(text)
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return number_text(float(value)) == text or is_in_full(text)


def _is_whole_number(text: str) -> bool:
    return _is_number(text) and not is_in_full(text) and float(text).is_integer()


def _is_flag(text: str) -> bool:
    return text in ("true", "false")


_SPELLED_SO: Mapping[str, Callable[[str], bool]] = {
    **dict.fromkeys(("mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "dampingFactor", "laserRetro"), _is_number),
    **dict.fromkeys(("springStiffness", "springReference", "fudgeFactor"), _is_number),
    "maxContacts": _is_whole_number,
    **dict.fromkeys(("selfCollide", "gravity", "turnGravityOff"), _is_flag),
    **dict.fromkeys(("preserveFixedJoint", "disableFixedJointLumping"), _is_flag),
}
"""The tags that are keys of a block under their own names, and how their text must be spelled to come back."""
