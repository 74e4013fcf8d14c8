"""The view of a robot that the templates of URDF lay out."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.geometry import Capsule
from linkforge_compile.formats.element import attributes, elements
from linkforge_compile.formats.markup import Xml
from linkforge_compile.formats.urdf.joint import JointView, joint_views
from linkforge_compile.formats.urdf.link import LinkView, MaterialView, link_views, material_view, says_physics

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.urdf.gazebo import GazeboView
    from linkforge_compile.formats.urdf.ros2_control import Ros2ControlView
    from linkforge_compile.formats.urdf.sensor import SensorView
    from linkforge_compile.formats.urdf.transmission import TransmissionView

# The version of URDF that brought <capsule>; urdfdom reads one only in files that state it or a later one.
_CAPSULE_VERSION = "1.1"


class RobotView(NamedTuple):
    """`<robot>`, every string ready for its place in the templates."""

    attributes: Xml
    materials: tuple[MaterialView, ...]
    links: tuple[LinkView, ...]
    materials_after_links: tuple[MaterialView, ...]
    joints: tuple[JointView, ...]
    transmissions: tuple[TransmissionView, ...]
    ros2_controls: tuple[Ros2ControlView, ...]
    gazebo: tuple[GazeboView, ...]
    sensors: tuple[SensorView, ...]
    elements: Xml


def stated_version(robot: Robot) -> str | None:
    """Return the `version` that the file states: the author's, else the one that its capsules need, else None."""
    if robot.version_stated:
        return robot.version
    return _CAPSULE_VERSION if any(capsules(robot)) else None


def capsules(robot: Robot) -> Iterator[Capsule]:
    """Yield the capsules of all links in the order in which they are written."""
    for link in robot.links:
        for shape in link.shapes:
            if isinstance(shape.geometry, Capsule):
                yield shape.geometry


def robot_view(robot: Robot, gazebo: str) -> RobotView:
    """Return what templates see of a robot in URDF.

    Raises:
        RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.

    """
    materials = {material.name: material for material in robot.materials.values() if material.name}
    version = stated_version(robot)
    return RobotView(
        attributes(robot, name=robot.name, version=version),
        tuple([material_view(one) for one in materials.values() if not one.after_links]),
        link_views(robot.links, materials, version),
        tuple([material_view(one) for one in materials.values() if one.after_links]),
        joint_views(robot.joints, version),
        _transmissions(robot),
        _ros2_controls(robot),
        _gazebo(robot),
        _sensors(robot, gazebo),
        elements(robot),
    )


# What an arm on a table does not have is not imported for it either: a command's first line of work waits for it.


def _transmissions(robot: Robot) -> tuple[TransmissionView, ...]:
    if not robot.transmissions:
        return ()
    from linkforge_compile.formats.urdf.transmission import transmission_views

    return transmission_views(robot.transmissions)


def _ros2_controls(robot: Robot) -> tuple[Ros2ControlView, ...]:
    if not robot.ros2_controls:
        return ()
    from linkforge_compile.formats.urdf.ros2_control import ros2_control_views

    return ros2_control_views(robot.ros2_controls)


def _gazebo(robot: Robot) -> tuple[GazeboView, ...]:
    if not (robot.gazebo_elements or any(says_physics(link) for link in robot.links)):
        return ()
    from linkforge_compile.formats.urdf.gazebo import gazebo_views, physics_views

    return (*physics_views(robot.links), *gazebo_views(robot.gazebo_elements))


def _sensors(robot: Robot, gazebo: str) -> tuple[SensorView, ...]:
    if not robot.sensors:
        return ()
    from linkforge_compile.formats.urdf.sensor import sensor_views

    return sensor_views(robot, gazebo)
