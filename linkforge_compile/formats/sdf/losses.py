"""The parts and settings of a robot that SDF, or Gazebo Sim, has no place for."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING

from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.formats.losses import Loss, joint_losses
from linkforge_compile.formats.lost_xml import lost_xml
from linkforge_compile.formats.parts import doubtful_parts_of_urdf
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.settings import (
    OF_BODY,
    OF_FIXED_JOINT,
    OF_FRAME,
    OF_JOINT,
    OF_MODEL,
    replaced_settings,
)

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


def lost_parts(robot: Robot, layout: Layout) -> Iterator[Loss]:
    """Yield each part that is omitted, under the words for its kind."""
    yield from _losses_of_world(robot, layout)
    for joint in robot.joints:
        yield from _of_joint(joint, robot)
    for transmission in robot.transmissions:
        yield Loss("transmissions", transmission.name, transmission.source)
    for sensor in robot.sensors:
        above = layout.above.get(sensor.link_name)
        if sensor.type == SensorType.FORCE_TORQUE and not (above and layout.is_joint(above)):
            yield Loss("force-torque sensors without a joint", sensor.name, sensor.source, ("link",))
    yield from _lost_settings(robot, layout)
    for reference, setting in replaced_settings(layout.settings):
        words = f"second <surface>, so no place for the setting '{setting.tag}'"
        yield Loss(words, reference, setting.source, setting.path)
    for block in robot.gazebo_elements:
        if block.reference is not None:
            for plugin in block.plugins:
                yield Loss("plugins of links and joints", plugin.name, plugin.source)
    yield from _lost_xml(robot)


def _of_joint(joint: Joint, robot: Robot) -> Iterator[Loss]:
    limits = joint.limits
    if limits and any(value is not None for value in (limits.acceleration, limits.deceleration, limits.jerk)):
        yield Loss("limits of acceleration, deceleration and jerk", joint.name, limits.source)
    yield from joint_losses(joint, robot, loose=(JointType.FLOATING,))


def _losses_of_world(robot: Robot, layout: Layout) -> Iterator[Loss]:
    for link in robot.links:
        if not layout.is_world(link.name):
            continue
        if link.inertial:
            yield Loss("mass of the world", link.name, link.source, ("inertial",))
        if link.shapes:
            yield Loss("shapes of the world", link.name, link.source, ("visual" if link.visuals else "collision",))
        for sensor in robot.sensors:
            if sensor.link_name == link.name:
                yield Loss("sensors on the world", sensor.name, sensor.source, ("link",))


def _lost_settings(robot: Robot, layout: Layout) -> Iterator[Loss]:
    for reference, settings in layout.settings.items():
        held, where = _held_settings(reference, robot, layout)
        for setting in settings:
            if setting.tag not in held:
                is_held_elsewhere = setting.tag in OF_BODY | OF_JOINT
                parts = f"place for the setting '{setting.tag}'{where if is_held_elsewhere else ''}"
                yield Loss(parts, reference or robot.name, setting.source, setting.path)


def _held_settings(reference: str | None, robot: Robot, layout: Layout) -> tuple[Set[str], str]:
    """Return the tags that a part holds in SDF, and words for what it is there if it holds fewer than others."""
    if reference is None:
        return OF_MODEL, ""
    if robot.has_link(reference):
        if layout.is_world(reference):
            return frozenset(), " of the world"
        return (OF_FRAME, " of a frame") if reference in layout.frames else (OF_BODY, "")
    if not robot.has_joint(reference):
        return frozenset(), ""
    joint = robot.joints[reference]
    if not layout.is_joint(joint):
        return frozenset(KEEP_FIXED_JOINT if joint.type == JointType.FIXED else ()), " of a frame"
    return (OF_FIXED_JOINT, " of a fixed joint") if joint.type == JointType.FIXED else (OF_JOINT, "")


def _lost_xml(robot: Robot) -> Iterator[Loss]:
    parts = (
        held
        for held in doubtful_parts_of_urdf(robot).with_extras
        if not any(isinstance(part, _NOT_RAW_URDF) for part in (*held.around, held.part))
    )
    for name, source, path in lost_xml(robot, parts):
        yield Loss("raw XML of a URDF", name, source, path)


_NOT_RAW_URDF = (Sensor, GazeboElement, Ros2Control, Transmission)
"""What is SDF with all that is in it, is read from the URDF, or is reported as a whole."""
