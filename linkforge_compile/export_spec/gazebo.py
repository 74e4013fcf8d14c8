"""Write Gazebo blocks at the link or joint that they are about, or at the end of the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.link import PHYSICS_TAGS, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import FreePart
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_fields, export_plugin
from linkforge_compile.syntax import YamlMap, YamlNode, scalar_value
from linkforge_compile.units import is_in_full, number_text


class GazeboPlaces(NamedTuple):
    """The blocks to write at each link, at each joint, and at the robot, where they state their reference."""

    links: dict[str, list[GazeboElement]]
    joints: dict[str, list[GazeboElement]]
    robot: list[GazeboElement]


def find_gazebo_places(robot: Robot) -> GazeboPlaces:
    """Return where to write each block so that the order of the output stays: links' first, then joints'.

    A block that repeats a tag of its link's physics cannot stand at the link.
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
    """Whether a block has a tag that the physics of its link write, which a spec refuses."""
    return any(tag in element.properties and physics.is_written(field) for field, tag in PHYSICS_TAGS.items())


def export_blocks(
    builder: SpecBuilder, blocks: Iterable[GazeboElement], *, with_reference: bool = False
) -> YamlNode | None:
    """Return one block or a list of them, None for none."""
    nodes = [_export_block(builder, block, with_reference=with_reference) for block in blocks]
    if not nodes:
        return None
    return nodes[0] if len(nodes) == 1 and not builder.full else builder.list_of(nodes)


def _export_block(builder: SpecBuilder, block: GazeboElement, *, with_reference: bool) -> YamlMap:
    tags = _leading_tags(block.properties)
    rest = {tag: part for tag, part in block.properties.items() if tag not in tags}
    return builder.element(
        block,
        reference=builder.text(block.reference) if with_reference else None,
        **export_fields(builder, block, without=("reference", "properties", "plugins")),
        **{tag: builder.free(part) for tag, part in tags.items()},
        properties=builder.free_map(rest),
        plugins=_export_plugins(builder, block),
    )


def _export_plugins(builder: SpecBuilder, block: GazeboElement) -> YamlNode | None:
    """Return the plugins by name, or as a list where a name repeats."""
    names = [plugin.name for plugin in block.plugins]
    if len(set(names)) < len(names):
        return builder.list_of(export_plugin(builder, plugin, is_named=True) for plugin in block.plugins)
    return builder.named("plugin", ((one.name, export_plugin(builder, one, is_named=False)) for one in block.plugins))


def _leading_tags(properties: Mapping[str, FreePart]) -> dict[str, FreePart]:
    """Return the properties before the others that can be keys of the block.

    Compiling a key normalizes its text, so only a property that is in normal form already can be one.
    """
    tags: dict[str, FreePart] = {}
    for tag, part in properties.items():
        is_normal = _IS_NORMAL.get(tag)
        if is_normal is None or not isinstance(part, str) or not is_normal(part):
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


_IS_NORMAL: Mapping[str, Callable[[str], bool]] = {
    **dict.fromkeys(("mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "dampingFactor", "laserRetro"), _is_number),
    **dict.fromkeys(("springStiffness", "springReference", "fudgeFactor"), _is_number),
    "maxContacts": _is_whole_number,
    **dict.fromkeys(("selfCollide", "gravity", "turnGravityOff"), _is_flag),
    **dict.fromkeys(("preserveFixedJoint", "disableFixedJointLumping"), _is_flag),
}
"""The tags that are keys of a block, and the test whether a text is in normal form."""
