"""What MJCF or MuJoCo cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics.codes.formats import (
    IMPOSSIBLE_FOR_MUJOCO,
    MASSLESS_IN_MUJOCO,
    MESH_FOR_MUJOCO,
    NESTED_TOO_DEEP,
    NOT_IN_MJCF,
    WORLD_BELOW_JOINT,
)
from linkforge_compile.formats.mjcf.meshes import mesh_files
from linkforge_compile.formats.mjcf.tree import WORLD, BodyTree, accepted_inertia, massless_movers

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.source import SourceRef

MAX_DEPTH = 490
"""MuJoCo's reader of XML refuses elements that are nested deeper than 500."""


def mjcf_limits(robot: Robot, *, is_free: bool) -> Iterator[Diagnostic]:
    """Yield what is left out or changed in the MJCF of a robot, and what MuJoCo refuses."""
    tree = BodyTree.of(robot)
    if (depth := tree.depth()) > MAX_DEPTH:
        yield NESTED_TOO_DEEP.at(robot.source, "name", depth=depth, most=MAX_DEPTH)
    for node in tree.nodes:
        if node.joint and node.link.name == WORLD:
            yield WORLD_BELOW_JOINT.at(node.link.source, name=WORLD)
    for link in massless_movers(robot, tree, is_free=is_free):
        yield MASSLESS_IN_MUJOCO.at(link.source, link=link.name)
    yield from check_inertials(robot)
    yield from check_meshes(robot)
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


def check_lost_parts(robot: Robot) -> Iterator[Diagnostic]:
    """Yield the parts of a robot for which MJCF has no element."""
    for what, name, source, path in _lost_parts(robot):
        yield NOT_IN_MJCF.at(source, *path, parts=what, name=name)


def _lost_parts(robot: Robot) -> Iterator[tuple[str, str, SourceRef | None, tuple[str, ...]]]:
    """Yield the kind of each such part, its name, and its place."""
    for joint in robot.joints:
        if joint.safety_controller:
            yield "safety controllers", joint.name, joint.source, ("safety_controller",)
    for transmission in robot.transmissions:
        yield "transmissions", transmission.name, transmission.source, ()
    for block in robot.gazebo_elements:
        yield "settings for Gazebo", block.reference or robot.name, block.source, ()
    if robot.extra_elements:
        yield "raw XML of a URDF", robot.name, robot.source, ("extra",)
    for link in robot.links:
        if link.extra_elements:
            yield "raw XML of a URDF", link.name, link.source, ("extra",)
        for visual in link.visuals:
            if visual.material and visual.material.texture:
                yield (
                    "textures on single shapes",
                    visual.material.name or link.name,
                    visual.material.source,
                    ("texture",),
                )
    for joint in robot.joints:
        if joint.extra_elements:
            yield "raw XML of a URDF", joint.name, joint.source, ("extra",)
