"""The parts of a robot that MJCF has no element for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement, property_path
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.formats.losses import Loss, joint_losses
from linkforge_compile.formats.lost_xml import lost_xml
from linkforge_compile.formats.mjcf.actuators import INTERFACES, drives, number_of
from linkforge_compile.formats.mjcf.keyframes import INITIAL_VALUE
from linkforge_compile.formats.mjcf.sensors import PLUGINS, sensor_losses
from linkforge_compile.formats.parts import doubtful_parts_in

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.ros2_control import Ros2ControlJoint


_GAZEBO, _TRANSMISSIONS, _GPIOS, _HARDWARE = "settings for Gazebo", "transmissions", "gpios", "sensors of hardware"

OF_OTHER_PROGRAMS = (_GAZEBO, _TRANSMISSIONS, _GPIOS, _HARDWARE, PLUGINS)
"""The kinds of parts that only other programs than MuJoCo read."""


def lost_parts(robot: Robot) -> Iterator[Loss]:
    """Yield each part that is omitted, under the words for its kind."""
    for sensor in robot.sensors:
        for parts, path in sensor_losses(sensor):
            yield Loss(parts, sensor.name, sensor.source, path)
    for transmission in robot.transmissions:
        yield Loss(_TRANSMISSIONS, transmission.name, transmission.source)
    for block in robot.gazebo_elements:
        yield from _of_gazebo(block, robot)
    for joint in robot.joints:
        yield from _of_joint(joint, robot)
    yield from _of_links(robot)
    yield from _of_hardware(robot)
    yield from _raw_xml(robot)


def _of_gazebo(block: GazeboElement, robot: Robot) -> Iterator[Loss]:
    """Yield a loss for what a block has besides friction, and what keeps a fixed joint, as MJCF keeps them all."""
    friction = ("mu1", "mu2") if block.properties.get("mu1") == block.properties.get("mu2") else ("mu1",)
    lost = [tag for tag in block.properties if tag not in (*KEEP_FIXED_JOINT, *friction)]
    if lost or replace(block, properties={}) != GazeboElement(block.reference):
        path = property_path(block, lost[0]) if lost else ()
        yield Loss(_GAZEBO, block.reference or robot.name, block.source, path)


def _of_joint(joint: Joint, robot: Robot) -> Iterator[Loss]:
    limits = joint.limits
    if limits and (limits.acceleration or limits.deceleration or limits.jerk):
        yield Loss("limits of acceleration and jerk", joint.name, limits.source or joint.source)
    yield from joint_losses(joint, robot, loose=(JointType.FLOATING, JointType.PLANAR))


def _of_links(robot: Robot) -> Iterator[Loss]:
    for link in robot.links:
        physics = link.physics
        if physics.is_written("mu2") and physics.mu2 != physics.mu:
            yield Loss("second coefficient of friction (mu2)", link.name, physics.source or link.source)
        if physics.is_written("kp") or physics.is_written("kd"):
            yield Loss("stiffness and damping of contacts (kp, kd)", link.name, physics.source or link.source)
        if physics.is_written("self_collide") and not physics.self_collide:
            yield Loss("`self_collide: false`", link.name, physics.source or link.source)
        for material in (visual.material for visual in link.visuals):
            if material and material.texture:
                yield Loss("textures on single shapes", material.name or link.name, material.source, ("texture",))


def _of_hardware(robot: Robot) -> Iterator[Loss]:
    driven = {drive.joint.name for drive in drives(robot)}
    for system in robot.ros2_controls:
        for pin in system.gpios:
            yield Loss(_GPIOS, pin.name, pin.source)
        for sensor in system.sensors:
            yield Loss(_HARDWARE, sensor.name, sensor.source)
        for hardware in system.joints:
            if not robot.has_joint(hardware.name):
                continue
            joint = robot.joints[hardware.name]
            if joint.name not in driven:
                yield from _undriven(hardware, joint)
            for state in map(Interface.of, hardware.state_interfaces):
                is_kept = state == "position" and joint.type in SINGLE_AXIS
                if number_of(state.parameters.get(INITIAL_VALUE)) and not is_kept:
                    yield Loss(f"initial {state}", hardware.name, state.source or hardware.source)


def _undriven(hardware: Ros2ControlJoint, joint: Joint) -> Iterator[Loss]:
    names = [str(Interface.of(name)) for name in hardware.command_interfaces]
    if not names:
        return
    if joint.type not in SINGLE_AXIS:
        what = f"actuators of {joint.type} joints"
    elif joint.mimic and any(name in INTERFACES for name in names):
        what = "actuators of joints that mimic others"
    else:
        what = f"actuators for the command interface '{names[0]}'"
    yield Loss(what, joint.name, hardware.source, ("command_interfaces",))


def _raw_xml(robot: Robot) -> Iterator[Loss]:
    """Yield raw XML and attributes, but for those of parts that are omitted as a whole."""
    kept = doubtful_parts_in(tuple(robot.materials.values()), robot.links, robot.joints, robot.ros2_controls)
    semantic = doubtful_parts_in(robot.semantic if robot.has_semantic else ())
    for name, source, path in lost_xml(robot, (*kept.with_extras, *semantic.with_extras)):
        yield Loss("raw XML of a URDF", name, source, path)
