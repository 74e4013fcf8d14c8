"""What Gazebo's tags cannot say of a sensor."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.gazebo import keeps_fixed_joint
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.backends import (
    FOREIGN_INFO,
    FRAME_OF_PLUGIN,
    NO_JOINT_TO_SENSE,
    NOISELESS_CONTACT,
    SENSOR_ON_MERGED_JOINT,
)
from linkforge_compile.formats.urdf.sensor import INFOS, Gazebo

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


def sensor_limits(robot: Robot, gazebo: Gazebo) -> Iterator[Diagnostic]:
    """Yield what is left out of a sensor, or written and then lost."""
    for sensor in robot.sensors:
        yield from check_force_torque(sensor, robot)
        yield from check_contact(sensor)
        yield from check_frame(sensor, gazebo)
        yield from check_infos(sensor)


def check_force_torque(sensor: Sensor, robot: Robot) -> Iterator[Diagnostic]:
    """Gazebo senses forces in a joint: the one above the sensor's link.

    It merges links that a fixed joint holds together, unless the joint's Gazebo block says otherwise, and such a
    joint's sensor is gone.
    """
    if sensor.type != SensorType.FORCE_TORQUE:
        return
    joint = robot.get_parent_joint(sensor.link_name)
    if joint is None:
        yield NO_JOINT_TO_SENSE.at(sensor.source, "link", link=sensor.link_name)
    elif joint.type == JointType.FIXED and not keeps_fixed_joint(robot.get_gazebo_elements(joint.name)):
        yield SENSOR_ON_MERGED_JOINT.at(sensor.source, "link", joint=joint.name)


def check_contact(sensor: Sensor) -> Iterator[Diagnostic]:
    """SDFormat has no noise for contact sensors."""
    if sensor.contact_info and sensor.contact_info.noise:
        yield NOISELESS_CONTACT.at(sensor.contact_info.noise.source or sensor.source)


def check_frame(sensor: Sensor, gazebo: Gazebo) -> Iterator[Diagnostic]:
    """In Gazebo Classic the plugin that publishes says in which frame."""
    if gazebo == "classic" and sensor.frame is not None:
        yield FRAME_OF_PLUGIN.at(sensor.source, "frame", frame=sensor.frame)


def check_infos(sensor: Sensor) -> Iterator[Diagnostic]:
    """A sensor writes the info of its type and no other."""
    own = INFOS[SensorType(sensor.type)]
    for info in dict.fromkeys(INFOS.values()):
        if info != own and getattr(sensor, f"{info}_info") is not None:
            yield FOREIGN_INFO.at(sensor.source, info, type=sensor.type, info=info)
