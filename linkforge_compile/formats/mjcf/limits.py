"""What MJCF or MuJoCo cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.core.constants import DEFAULT_UPDATE_RATE
from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement, property_path
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface, Ros2ControlJoint
from linkforge_compile.core.models.srdf import VirtualJointType
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.simulators import (
    BASE_STAYS_FIXED,
    FOR_OTHER_PROGRAMS,
    IMPOSSIBLE_FOR_MUJOCO,
    MASSLESS_IN_MUJOCO,
    MESH_FOR_MUJOCO,
    NESTED_TOO_DEEP,
    NO_ACTUATOR,
    NO_GAIN,
    NO_MESSAGES,
    NO_VELOCITY_LIMIT,
    NOT_IN_MJCF,
    ONE_ACTUATOR,
    OPPOSITE_SIGN,
    TAKEN_IN_MUJOCO,
    WORLD_BELOW_JOINT,
)
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.limits import Loss, check_texts, joint_losses, lost_xml
from linkforge_compile.formats.mjcf.bodies import (
    PLUGINS,
    accepted_inertia,
    has_opposite_sign,
    massless_movers,
    sensor_loss,
    sensor_losses,
)
from linkforge_compile.formats.mjcf.joints import (
    GAINS,
    INTERFACES,
    drives,
    free_joint_name,
    has_gain,
    part_names,
)
from linkforge_compile.formats.mjcf.view import INITIAL_VALUE, mesh_files, states_of
from linkforge_compile.formats.parts import doubtful_parts_in, doubtful_parts_of_urdf
from linkforge_compile.source import SourceRef
from linkforge_compile.units import finite_number

MAX_DEPTH = 490
"""MuJoCo's reader of XML refuses elements that are nested deeper than 500."""


def mjcf_limits(robot: Robot, *, is_free: bool) -> Iterator[Diagnostic]:
    """Yield what is omitted or changed in the MJCF of a robot, and what MuJoCo refuses."""
    yield from check_texts(robot, doubtful_parts_of_urdf(robot))
    tree = KinematicTree.of(robot)
    if (depth := tree.depth()) > MAX_DEPTH:
        yield NESTED_TOO_DEEP.at(robot.source, "name", depth=depth, most=MAX_DEPTH)
    for node in tree.nodes:
        if node.joint and node.link.name == WORLD:
            yield WORLD_BELOW_JOINT.at(node.link.source, name=WORLD)
    if is_free and robot.has_link(WORLD):
        yield NOT_IN_MJCF.at(robot.links[WORLD].source, parts="free joint for the world", name=WORLD)
    for link in massless_movers(robot, tree, is_free=is_free):
        yield MASSLESS_IN_MUJOCO.at(link.source, link=link.name)
    yield from check_inertials(robot)
    yield from check_meshes(robot)
    yield from check_actuators(robot)
    yield from check_driven(robot)
    if not is_free and not robot.has_link(WORLD):
        yield from check_base(robot)
    for sensor in robot.sensors:
        if has_opposite_sign(sensor):
            yield OPPOSITE_SIGN.at(sensor.source, "force_torque", sensor=sensor.name)
    yield from check_velocities(robot)
    yield from check_messages(robot)
    yield from check_names(robot, tree, is_free=is_free)
    yield from check_lost_parts(robot)


def check_inertials(robot: Robot) -> Iterator[Diagnostic]:
    """MuJoCo refuses a tensor that no body can have; the world has no mass."""
    for link in robot.links:
        if link.inertial is None:
            continue
        if link.name == WORLD:
            yield NOT_IN_MJCF.at(link.source, "inertial", parts="mass of the world", name=link.name)
        elif accepted_inertia(link) != link.inertia:
            yield IMPOSSIBLE_FOR_MUJOCO.at(link.source, "inertial", "inertia", link=link.name)


def check_meshes(robot: Robot) -> Iterator[Diagnostic]:
    """MuJoCo reads some kinds of meshes, and refuses a model with a file that it cannot find."""
    for mesh, _, fault in mesh_files(robot):
        if fault:
            yield MESH_FOR_MUJOCO.at(mesh.source, "file", file=mesh.resource, reason=fault)


def check_actuators(robot: Robot) -> Iterator[Diagnostic]:
    """A joint has one actuator, and its gain is not in the URDF."""
    for drive in drives(robot):
        where, name, interface = drive.hardware.source, drive.joint.name, str(drive.interface)
        if drive.others:
            others = " and ".join(f"'{other}'" for other in drive.others)
            yield ONE_ACTUATOR.at(where, "command_interfaces", joint=name, interface=interface, others=others)
        if not has_gain(drive):
            yield NO_GAIN.at(where, "command_interfaces", joint=name, interface=interface, gain=GAINS[interface][0])


def check_driven(robot: Robot) -> Iterator[Diagnostic]:
    """A robot with joints that move has an actuator."""
    if any(joint.type in SINGLE_AXIS for joint in robot.joints) and not any(drives(robot)):
        yield NO_ACTUATOR.at(robot.source, "name", robot=robot.name)


def check_base(robot: Robot) -> Iterator[Diagnostic]:
    """A robot that moves in the world needs a free base."""
    for joint in robot.semantic.virtual_joints if robot.has_semantic else ():
        if joint.type != VirtualJointType.FIXED:
            yield BASE_STAYS_FIXED.at(joint.source, "type", joint=joint.name, type=joint.type)


def check_lost_parts(robot: Robot) -> Iterator[Diagnostic]:
    """Yield the parts of a robot for which MJCF has no element."""
    for loss in lost_parts(robot):
        code = FOR_OTHER_PROGRAMS if loss.parts in OF_OTHER_PROGRAMS else NOT_IN_MJCF
        yield code.at(loss.source, *loss.path, parts=loss.parts, name=loss.name)


def check_velocities(robot: Robot) -> Iterator[Diagnostic]:
    """MuJoCo limits the command of a velocity actuator, and no velocity."""
    commanded = {drive.joint.name for drive in drives(robot) if drive.interface == "velocity"}
    for joint in robot.joints:
        if joint.type in SINGLE_AXIS and joint.limits and joint.limits.velocity and joint.name not in commanded:
            yield NO_VELOCITY_LIMIT.at(joint.limits.source or joint.source, "velocity", joint=joint.name)


def check_messages(robot: Robot) -> Iterator[Diagnostic]:
    """MuJoCo measures at every step, and sends no messages."""
    for sensor in robot.sensors:
        is_usual = sensor.update_rate == DEFAULT_UPDATE_RATE and not sensor.topic and not sensor.frame
        if sensor_loss(sensor) is None and not is_usual:
            yield NO_MESSAGES.at(sensor.source, sensor=sensor.name)


class Named(NamedTuple):
    """A name in the MJCF, what has it, in words, and its place; `is_own` if it is that of the robot, too."""

    name: str
    owner: str
    source: SourceRef | None
    is_own: bool = False


def check_names(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Diagnostic]:
    """MuJoCo refuses two joints of one name, and two keyframes; some of their names are made of others."""
    yield from _taken("joints", sorted(_joint_names(tree, is_free=is_free), key=lambda named: named.is_own))
    yield from _taken("keyframes", [Named(one.name, one.origin, one.source) for one in states_of(robot)])


def _joint_names(tree: KinematicTree, *, is_free: bool) -> Iterator[Named]:
    for link, joint, _ in tree.nodes:
        if joint is None:
            if is_free and link.name != WORLD:
                yield Named(free_joint_name(link.name), f"the free joint of link '{link.name}'", link.source)
            continue
        for name in part_names(joint):
            is_own = name == joint.name
            yield Named(name, f"a part of {joint.type} joint '{joint.name}'", joint.source, is_own)


def _taken(parts: str, names: Iterable[Named]) -> Iterator[Diagnostic]:
    first: dict[str, Named] = {}
    for named in names:
        other = first.setdefault(named.name, named)
        if other is not named:
            yield TAKEN_IN_MUJOCO.at(named.source, "name", parts=parts, name=named.name, owner=other.owner)


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
                if finite_number(state.parameters.get(INITIAL_VALUE)) and not is_kept:
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
    """Return raw XML and attributes, but for those of parts that are omitted as a whole."""
    kept = doubtful_parts_in(tuple(robot.materials.values()), robot.links, robot.joints, robot.ros2_controls)
    semantic = doubtful_parts_in(robot.semantic if robot.has_semantic else ())
    return lost_xml(robot, (*kept.with_extras, *semantic.with_extras))
