"""What MJCF or MuJoCo cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.constants import DEFAULT_UPDATE_RATE
from linkforge_compile.core.models.joint import SINGLE_AXIS
from linkforge_compile.core.models.srdf import VirtualJointType
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
    WORLD_BELOW_JOINT,
)
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.limits import check_texts
from linkforge_compile.formats.mjcf.actuators import GAINS, drives, has_gain
from linkforge_compile.formats.mjcf.losses import OF_OTHER_PROGRAMS, lost_parts
from linkforge_compile.formats.mjcf.masses import accepted_inertia, massless_movers
from linkforge_compile.formats.mjcf.meshes import mesh_files
from linkforge_compile.formats.mjcf.names import check_names
from linkforge_compile.formats.mjcf.sensors import has_opposite_sign, sensor_loss
from linkforge_compile.formats.parts import doubtful_parts_of_urdf

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

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
