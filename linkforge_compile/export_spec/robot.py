"""Write a whole robot as one flat spec, its sections in the order of the language."""

from __future__ import annotations

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_element
from linkforge_compile.export_spec.gazebo import GazeboPlaces, export_blocks, find_gazebo_places
from linkforge_compile.export_spec.joint import export_joint
from linkforge_compile.export_spec.link import export_frame, export_link, find_frames
from linkforge_compile.export_spec.srdf import export_semantic
from linkforge_compile.export_spec.transmission import export_transmission
from linkforge_compile.syntax import YamlMap, YamlScalar

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
        version=builder.text(robot.version) if robot.version_stated else None,
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
