"""A whole robot as a spec: one flat file, its sections in the language's order."""

from __future__ import annotations

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.frames import frames_of, written_frame
from linkforge_compile.export_spec.gazebo import GazeboPlaces, gazebo_places, written_blocks
from linkforge_compile.export_spec.joint import written_joint
from linkforge_compile.export_spec.link import written_link
from linkforge_compile.export_spec.material import written_material
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.export_spec.ros2_control import written_ros2_control
from linkforge_compile.export_spec.sensor import written_sensor
from linkforge_compile.export_spec.srdf import written_semantic
from linkforge_compile.export_spec.transmission import written_transmission
from linkforge_compile.syntax import YamlMap, YamlScalar

_LANGUAGE_VERSION = 1


def spec_of(robot: Robot, pen: Pen) -> YamlMap:
    """Return a robot as the tree of a spec without modules, parameters and expressions.

    Compiled, it gives an equal robot and the same URDF and SRDF; only states of one group, collision pairs of one
    first link and properties of one joint come together where others stood between them.

    Raises:
        RobotGeneratorError: for two parts of one name where a spec can hold only one.

    """
    gazebo = gazebo_places(robot)
    return pen.element(
        robot,
        linkforge=pen.number(_LANGUAGE_VERSION),
        name=pen.text(robot.name),
        version=pen.text(robot.version) if robot.version_stated else None,
        description=_description(pen, robot),
        metadata=pen.data(robot.metadata) if robot.metadata else None,
        materials=pen.named("material", ((name, written_material(pen, one)) for name, one in robot.materials.items())),
        **_tree_sections(pen, robot, gazebo),
        sensors=pen.named("sensor", ((sensor.name, written_sensor(pen, sensor)) for sensor in robot.sensors)),
        transmissions=pen.named(
            "transmission", ((one.name, written_transmission(pen, one)) for one in robot.transmissions)
        ),
        ros2_control=pen.named(
            "ros2_control", ((one.name, written_ros2_control(pen, one)) for one in robot.ros2_controls)
        ),
        gazebo=written_blocks(pen, gazebo.robot, beside=False),
        semantic=written_semantic(pen, robot.semantic, robot.joints) if robot.has_semantic else None,
    )


def _description(pen: Pen, robot: Robot) -> YamlScalar | None:
    """Return what a spec says of its robot to people; a Robot has no field for it, its source does."""
    said = robot.source.node.child("description") if robot.source else None
    return pen.text(said.text) if isinstance(said, YamlScalar) and said.text else None


def _tree_sections(pen: Pen, robot: Robot, gazebo: GazeboPlaces) -> dict[str, YamlMap | None]:
    """Return links, joints and frames, with what a simulator is told about each beside it."""
    frames = [] if pen.full else frames_of(robot)
    links, joints = robot.links[: len(robot.links) - len(frames)], robot.joints[: len(robot.joints) - len(frames)]
    written_links = (
        (one.name, written_link(pen, one, robot.materials, written_blocks(pen, gazebo.links.get(one.name, ()))))
        for one in links
    )
    written_joints = (
        (one.name, written_joint(pen, one, written_blocks(pen, gazebo.joints.get(one.name, ())))) for one in joints
    )
    written_frames = ((link.name, written_frame(pen, link, joint)) for link, joint in frames)
    return {
        "links": pen.named("link", written_links),
        "joints": pen.named("joint", written_joints),
        "frames": pen.named("frame", written_frames),
    }
