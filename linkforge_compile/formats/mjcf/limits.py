"""What MJCF or MuJoCo cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement
from linkforge_compile.diagnostics.codes.formats import (
    IMPOSSIBLE_FOR_MUJOCO,
    MASSLESS_IN_MUJOCO,
    MESH_FOR_MUJOCO,
    NESTED_TOO_DEEP,
    NO_GAIN,
    NOT_IN_MJCF,
    ONE_ACTUATOR,
    OPPOSITE_SIGN,
    WORLD_BELOW_JOINT,
)
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.mjcf.actuators import GAINS, drives, has_gain
from linkforge_compile.formats.mjcf.masses import accepted_inertia, massless_movers
from linkforge_compile.formats.mjcf.meshes import mesh_files
from linkforge_compile.formats.mjcf.sensors import has_opposite_sign, sensor_loss
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

MAX_DEPTH = 490
"""MuJoCo's reader of XML refuses elements that are nested deeper than 500."""


def mjcf_limits(robot: Robot, *, is_free: bool) -> Iterator[Diagnostic]:
    """Yield what is left out or changed in the MJCF of a robot, and what MuJoCo refuses."""
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
    for sensor in robot.sensors:
        if has_opposite_sign(sensor):
            yield OPPOSITE_SIGN.at(sensor.source, "force_torque", sensor=sensor.name)
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
            yield NO_GAIN.at(where, "command_interfaces", joint=name, interface=interface, gain=GAINS[interface])


def check_lost_parts(robot: Robot) -> Iterator[Diagnostic]:
    """Yield the parts of a robot for which MJCF has no element."""
    for what, name, source, path in _lost_parts(robot):
        yield NOT_IN_MJCF.at(source, *path, parts=what, name=name)


Loss: TypeAlias = tuple[str, str, SourceRef | None, tuple[str, ...]]
"""What kind of part is left out, the name of the part, and its place."""


def _lost_parts(robot: Robot) -> Iterator[Loss]:
    for sensor in robot.sensors:
        if loss := sensor_loss(sensor):
            yield loss, sensor.name, sensor.source, ("type",)
    for transmission in robot.transmissions:
        yield "transmissions", transmission.name, transmission.source, ()
    for block in filter(_has_settings, robot.gazebo_elements):
        yield "settings for Gazebo", block.reference or robot.name, block.source, ()
    for joint in robot.joints:
        if joint.safety_controller:
            yield "safety controllers", joint.name, joint.source, ("safety_controller",)
    yield from _lost_textures(robot)
    yield from _lost_xml(robot)


def _has_settings(block: GazeboElement) -> bool:
    """Whether a block has more than what keeps a fixed joint, as MJCF keeps them all."""
    others = block.properties.keys() - set(KEEP_FIXED_JOINT)
    return bool(others) or replace(block, properties={}) != GazeboElement(block.reference)


def _lost_textures(robot: Robot) -> Iterator[Loss]:
    for link in robot.links:
        for material in (visual.material for visual in link.visuals):
            if material and material.texture:
                yield "textures on single shapes", material.name or link.name, material.source, ("texture",)


def _lost_xml(robot: Robot) -> Iterator[Loss]:
    parts: tuple[Robot | Link | Joint, ...] = (robot, *robot.links, *robot.joints)
    for part in parts:
        if part.extra_elements:
            yield "raw XML of a URDF", part.name, part.source, ("extra",)
