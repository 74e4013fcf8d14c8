"""Write links, their shapes and materials, and the frames among them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.core.models.geometry import Material
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import COLLISION, VISUAL, Collision, Link, LinkPhysics, Visual, shortest_setting
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_element, export_fields
from linkforge_compile.export_spec.geometry import export_geometry
from linkforge_compile.syntax import YamlMap, YamlNode


def export_link(
    builder: SpecBuilder, link: Link, materials: Mapping[str, Material], gazebo: YamlNode | None
) -> YamlMap:
    """Return a link with the Gazebo blocks about it; `materials` are the robot's, which visuals name."""
    shapes = {VISUAL: _visuals(builder, link, materials), COLLISION: _collisions(builder, link)}
    kinds = [VISUAL if isinstance(shape, Visual) else COLLISION for shape in link.shapes]
    order = shortest_setting(kinds)
    return builder.element(
        link,
        # The order of these keys is the order of the output.
        **dict(reversed(shapes.items()) if kinds[:1] == [COLLISION] else shapes),
        shape_order=builder.text(order) if order is None or isinstance(order, str) else builder.texts(order),
        inertial=export_element(builder, link.inertial) if link.inertial else None,
        physics=_physics(builder, link.physics),
        gazebo=gazebo,
    )


def _visuals(builder: SpecBuilder, link: Link, materials: Mapping[str, Material]) -> YamlNode | None:
    return _one_or_list(
        builder,
        [_shape(builder, one, material=_visual_material(builder, one.material, materials)) for one in link.visuals],
    )


def _collisions(builder: SpecBuilder, link: Link) -> YamlNode | None:
    copies = [Collision(visual.geometry, visual.origin) for visual in link.visuals]
    if copies and copies == list(link.collisions) and not builder.full:
        return builder.text("visual")
    return _one_or_list(builder, [_shape(builder, collision) for collision in link.collisions])


def _shape(builder: SpecBuilder, shape: Visual | Collision, **entries: YamlNode | None) -> YamlNode:
    return builder.element(
        shape,
        name=builder.text(shape.name),
        **export_geometry(builder, shape.geometry),
        **export_fields(builder, shape, given=entries, without=("name",)),
    )


def _one_or_list(builder: SpecBuilder, shapes: Sequence[YamlNode]) -> YamlNode | None:
    if not shapes:
        return None
    return shapes[0] if len(shapes) == 1 and not builder.full else builder.list_of(shapes)


def _visual_material(
    builder: SpecBuilder, material: Material | None, materials: Mapping[str, Material]
) -> YamlNode | None:
    """Return the name of a material that the robot declares so, all of any other."""
    if material is None:
        return None
    if materials.get(material.name) == material:
        return builder.text(material.name)
    name = builder.text(material.name, default="")
    return builder.element(material, name=name, **export_fields(builder, material, without=("after_links",)))


def _physics(builder: SpecBuilder, physics: LinkPhysics) -> YamlNode | None:
    node = builder.map_of(export_fields(builder, physics))
    return builder.located(node, physics.source) if len(node) else None


def find_frames(robot: Robot) -> list[tuple[Link, Joint]]:
    """Return the links at the end of the robot that are frames, with their joints.

    A frame is an empty link on a fixed joint, without Gazebo blocks. Frames are written after all other links and
    joints, so an empty link among those stays a link.
    """
    references = {element.reference for element in robot.gazebo_elements}
    frames: list[tuple[Link, Joint]] = []
    for link, joint in zip(reversed(tuple(robot.links)), reversed(tuple(robot.joints)), strict=False):
        if not _is_frame(link, joint) or references & {link.name, joint.name}:
            break
        frames.append((link, joint))
    return frames[::-1]


def export_frame(builder: SpecBuilder, link: Link, joint: Joint) -> YamlMap:
    """Return a frame, with the name of its joint if that is not `LINK_joint`."""
    entries = export_fields(builder, joint)
    name = builder.text(joint.name, default=f"{link.name}_joint")
    node = builder.map_of({"parent": entries["parent"], "origin": entries["origin"], "joint": name})
    return builder.located(node, link.source or joint.source)


def _is_frame(link: Link, joint: Joint) -> bool:
    if link.name != joint.child or link != Link(link.name):
        return False
    return joint == Joint(joint.name, JointType.FIXED, joint.parent, joint.child, joint.origin)
