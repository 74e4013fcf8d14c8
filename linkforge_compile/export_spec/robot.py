"""Write a whole robot as one flat spec, its sections in the order of the language."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.fields import Children, field_specs
from linkforge_compile.core.models.geometry import Material, Vector3
from linkforge_compile.core.models.joint import AXES, Joint, JointType
from linkforge_compile.core.models.link import COLLISION, VISUAL, Collision, Link, LinkPhysics, Visual, shortest_setting
from linkforge_compile.core.models.named_table import NamedTable
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import (
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
)
from linkforge_compile.core.models.srdf_collisions import LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_children, export_element, export_fields, export_geometry
from linkforge_compile.export_spec.gazebo import GazeboPlaces, export_blocks, find_gazebo_places
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import POSITION, Dimension

_States: TypeAlias = Mapping[tuple[str, str], GroupState]
"""The states of a robot, by group and name."""

_MAX_INHERITED = 100
"""Number of states to search for where the positions of one were written; inheritance may be endless."""


def export_semantic(
    builder: SpecBuilder, semantic: SemanticRobotDescription, joints: NamedTable[Joint]
) -> YamlMap | None:
    """Return the semantic part of a robot with these joints, None where it is empty.

    The states of a group are written together, as are the pairs of a first link and the properties of a joint.
    """
    states = {(state.group, state.name): state for state in semantic.group_states}
    positions = ((one.group, one.name, _state(builder, one, joints, states)) for one in semantic.group_states)
    by_hand = {
        "groups": export_children(builder, semantic.groups, _group),
        "group_states": builder.nested("state", positions),
        "passive_joints": _passive_joints(builder, semantic.passive_joints),
        "joint_properties": export_children(builder, semantic.joint_properties, _property),
        "link_sphere_approximations": export_children(builder, semantic.link_sphere_approximations, _spheres),
    }
    others = {
        spec.key or name: export_children(builder, getattr(semantic, name))
        for name, spec in field_specs(SemanticRobotDescription).items()
        if isinstance(spec, Children) and spec.key not in by_hand
    }
    node = export_element(builder, semantic, **by_hand, **others)
    return node if len(node) else None


def _passive_joints(builder: SpecBuilder, joints: Sequence[PassiveJoint]) -> YamlNode | None:
    """Return a list of names, or a map where one of them has more."""
    if any(len(export_element(builder, joint)) for joint in joints):
        return export_children(builder, joints)
    return builder.texts([joint.name for joint in joints])


def _group(builder: SpecBuilder, group: PlanningGroup) -> YamlMap:
    chains = [export_element(builder, chain) for chain in group.chains]
    return builder.element(
        group,
        chain=chains[0] if len(chains) == 1 else None,
        chains=builder.list_of(chains) if len(chains) > 1 else None,
        **export_fields(builder, group, without=("chains",)),
    )


def _state(builder: SpecBuilder, state: GroupState, joints: NamedTable[Joint], states: _States) -> YamlMap:
    """Return the positions by joint: a number, or a list for several degrees of freedom."""
    positions = {}
    sources = dict(_position_sources(state, states))
    for name, values in state.joint_values.items():
        joint = joints.get(name)
        unit = POSITION.dimension(joint.type.motion) if joint else None
        node: YamlNode = builder.quantity(values[0], unit) if len(values) == 1 else builder.numbers(values, unit)
        source, field = sources.get(name, (state.source, name.removeprefix(_prefix_of(state))))
        positions[name] = builder.located(node, source, field)
    return builder.element(state, **positions)


def _position_sources(state: GroupState, states: _States) -> Iterator[tuple[str, tuple[SourceRef, str]]]:
    """Yield the object and key in which each position was written: in the state, or in one that it inherits from."""
    stack, seen = [state], {(state.group, state.name)}
    while stack:
        writer = stack.pop()
        prefix = _prefix_of(writer)
        for entry in writer.source.node if writer.source and isinstance(writer.source.node, YamlMap) else ():
            text = entry.value.text if isinstance(entry.value, YamlScalar) else ""
            inherited = (prefix + entry.name, prefix + text)
            if writer.source and prefix + entry.name in writer.joint_values:
                yield prefix + entry.name, (writer.source, entry.name)
            elif inherited in states and inherited not in seen and len(seen) < _MAX_INHERITED:
                seen.add(inherited)
                stack.append(states[inherited])


def _prefix_of(state: GroupState) -> str:
    """Return the prefix that the names of a state got since its file was written, as the name of its group did."""
    group = state.source.node.child("group") if state.source else None
    return state.group.removesuffix(group.text) if isinstance(group, YamlScalar) else ""


def _property(builder: SpecBuilder, one: JointProperty) -> YamlMap:
    return export_element(builder, one, value=builder.free(one.value))


def _spheres(builder: SpecBuilder, approximation: LinkSphereApproximation) -> YamlMap:
    spheres = builder.list_of(_sphere(builder, sphere) for sphere in approximation.spheres)
    return export_element(builder, approximation, spheres=spheres)


def _sphere(builder: SpecBuilder, sphere: SrdfSphere) -> YamlMap:
    """Return a sphere, whose `center` is three fields of its class."""
    center = builder.numbers((sphere.center_x, sphere.center_y, sphere.center_z), Dimension.LENGTH)
    return export_element(builder, sphere, center=center)


_LANGUAGE_VERSION = 1


def spec_of(robot: Robot, builder: SpecBuilder) -> YamlMap:
    """Return a robot as the tree of a spec without modules, parameters and expressions.

    Compiled, it gives an equal robot and the same URDF and SRDF, except that the states of a group, the collision
    pairs of a first link and the properties of a joint are written together.

    Raises:
        RobotGeneratorError: for two parts with the same name where a spec can hold only one.

    """
    gazebo = find_gazebo_places(robot)
    transmissions = ((one.name, export_transmission(builder, one)) for one in robot.transmissions)
    return builder.element(
        robot,
        linkforge=builder.number(_LANGUAGE_VERSION),
        name=builder.text(robot.name),
        version=builder.text(robot.version) if robot.is_version_written else None,
        description=_description(builder, robot),
        metadata=builder.data(robot.metadata) if robot.metadata else None,
        materials=builder.named(
            "material", ((name, export_element(builder, one)) for name, one in robot.materials.items())
        ),
        **_tree_sections(builder, robot, gazebo),
        sensors=builder.named("sensor", ((one.name, export_element(builder, one)) for one in robot.sensors)),
        transmissions=builder.named("transmission", transmissions),
        ros2_control=builder.named(
            "ros2_control", ((one.name, export_element(builder, one)) for one in robot.ros2_controls)
        ),
        controllers=builder.named(
            "controller", ((one.name, export_element(builder, one)) for one in robot.controllers)
        ),
        gazebo=export_blocks(builder, gazebo.robot, with_reference=True),
        semantic=export_semantic(builder, robot.semantic, robot.joints) if robot.has_semantic else None,
    )


def _description(builder: SpecBuilder, robot: Robot) -> YamlScalar | None:
    """Return the description in the robot's source; Robot has no field for it."""
    description = robot.source.node.child("description") if robot.source else None
    return builder.text(description.text) if isinstance(description, YamlScalar) and description.text else None


def _tree_sections(builder: SpecBuilder, robot: Robot, gazebo: GazeboPlaces) -> dict[str, YamlMap | None]:
    """Return links, joints and frames, with the Gazebo blocks about each."""
    frames = [] if builder.full else find_frames(robot)
    links, joints = robot.links[: len(robot.links) - len(frames)], robot.joints[: len(robot.joints) - len(frames)]
    link_nodes = (
        (one.name, export_link(builder, one, robot.materials, export_blocks(builder, gazebo.links.get(one.name, ()))))
        for one in links
    )
    joint_nodes = (
        (one.name, export_joint(builder, one, export_blocks(builder, gazebo.joints.get(one.name, ()))))
        for one in joints
    )
    frame_nodes = ((link.name, export_frame(builder, link, joint)) for link, joint in frames)
    return {
        "links": builder.named("link", link_nodes),
        "joints": builder.named("joint", joint_nodes),
        "frames": builder.named("frame", frame_nodes),
    }


def export_link(
    builder: SpecBuilder, link: Link, materials: Mapping[str, Material], gazebo: YamlNode | None
) -> YamlMap:
    """Return a link with the Gazebo blocks about it; `materials` are the robot's, which visuals name."""
    visuals = [
        _shape(builder, one, material=_visual_material(builder, one.material, materials)) for one in link.visuals
    ]
    shapes = {VISUAL: _one_or_list(builder, visuals), COLLISION: _collisions(builder, link)}
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
    is_empty = link.name == joint.child and link == Link(link.name)
    return is_empty and joint == Joint(joint.name, JointType.FIXED, joint.parent, joint.child, joint.origin)


def export_joint(builder: SpecBuilder, joint: Joint, gazebo: YamlNode | None) -> YamlMap:
    """Return a joint with the Gazebo blocks about it."""
    return export_element(builder, joint, joint.type.motion, axis=_axis(builder, joint), gazebo=gazebo)


def _axis(builder: SpecBuilder, joint: Joint) -> YamlNode | None:
    """Return the vector that was written, else the axis as a word, such as `-z`, else as a unit vector."""
    if joint.axis is None:
        return None
    written = joint.axis_as_written
    if written and _direction(written) == joint.axis:
        return builder.numbers(written)
    word = next((word for word, axis in AXES.items() if axis == joint.axis), None)
    return builder.numbers(joint.axis) if word is None else builder.text(word)


def _direction(vector: Vector3) -> Vector3 | None:
    length = math.hypot(*vector)
    return Vector3(*(component / length for component in vector)) if length else None


def export_transmission(builder: SpecBuilder, transmission: Transmission) -> YamlMap:
    """Return a transmission."""
    joints = ((joint.name, _end(builder, joint)) for joint in transmission.joints)
    actuators = ((actuator.name, _end(builder, actuator)) for actuator in transmission.actuators)
    return export_element(
        builder,
        transmission,
        joints=builder.named("transmission joint", joints, with_origins=False),
        actuators=builder.named("actuator", actuators, with_origins=False),
    )


def _end(builder: SpecBuilder, end: TransmissionJoint | TransmissionActuator) -> YamlMap:
    is_default = tuple(end.hardware_interfaces) == (HW_IF_POSITION,) and not builder.full
    interfaces = None if is_default else builder.texts(end.hardware_interfaces)
    return export_element(
        builder,
        end,
        hardware_interfaces=interfaces if end.interfaces_stated else builder.list_of(()),
        # Written even if it is 1: without it there is no reduction in the URDF.
        mechanical_reduction=builder.number(end.mechanical_reduction),
    )
