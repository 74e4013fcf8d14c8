"""The view of a robot that the templates of MJCF lay out, with its meshes and keyframes."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.meshes.stl import HEADER, TRIANGLE
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.models.srdf import VirtualJointType
from linkforge_compile.core.naming import unique_name
from linkforge_compile.formats.element import attributes_at, leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.mesh_paths import is_relative, mesh_paths, reason_not_found
from linkforge_compile.formats.mjcf.bodies import body_views, sensor_elements, world_elements
from linkforge_compile.formats.mjcf.contacts import exclusion_elements
from linkforge_compile.formats.mjcf.joints import (
    Drive,
    JointClass,
    actuator_element,
    actuator_settings,
    drives,
    equality_elements,
    joint_settings,
    range_of,
)
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.source import SourceRef
from linkforge_compile.units import finite_number

_ENDINGS = (".stl", ".obj", ".msh")

_MAX_TRIANGLES = 200_000

_CONVERT = "'linkforge explain LF7404' has a command that converts it"


class MeshFile(NamedTuple):
    """A mesh with its file, None for one that is not found, and why MuJoCo cannot read it, None if it can."""

    mesh: Mesh
    path: Path | None
    fault: str | None


class MeshAssets(NamedTuple):
    """The meshes of an MJCF: their elements, their names for geoms, and the folder of their files.

    The folder is None where all paths are relative to the document, as they are in the spec.
    """

    elements: Sequence[Xml]
    names: Mapping[Mesh, str]
    folder: str | None


def mesh_files(robot: Robot) -> Iterator[MeshFile]:
    """Yield each mesh of a robot once."""
    for mesh, path in mesh_paths(robot):
        yield MeshFile(mesh, path, _fault(robot, mesh, path))


def _fault(robot: Robot, mesh: Mesh, path: Path | None) -> str | None:
    ending = Path(mesh.resource).suffix.lower()
    if ending not in _ENDINGS:
        return f"MuJoCo reads STL, OBJ and MSH; {_CONVERT}"
    if path is None:
        return reason_not_found(robot, mesh.resource)
    # The size alone shows a binary STL; no file of a stranger's spec is opened.
    triangles, rest = divmod(path.stat().st_size - HEADER, TRIANGLE)
    if ending == ".stl" and not rest and triangles == 1:
        return "MuJoCo refuses a mesh of one triangle"
    if ending == ".stl" and (rest or not 0 < triangles <= _MAX_TRIANGLES):
        return f"MuJoCo reads binary STL of up to {_MAX_TRIANGLES:,} triangles; {_CONVERT}"
    return None


def mesh_assets(robot: Robot) -> MeshAssets:
    """Return the meshes that MuJoCo can read, each with a name of its own."""
    found = [(one.mesh, one.path) for one in mesh_files(robot) if one.path and not one.fault]
    if all(is_relative(mesh.resource) for mesh, _ in found):
        folder, files = None, [mesh.resource for mesh, _ in found]
    else:
        folder = os.path.commonpath([path.parent for _, path in found])
        files = [path.relative_to(folder).as_posix() for _, path in found]
    names: dict[Mesh, str] = {}
    for mesh, _ in found:
        names[mesh] = unique_name(Path(mesh.resource).stem, set(names.values()))
    elements = [
        leaf_at("mesh", mesh.source, name=names[mesh], file=file, scale=mesh.scale if mesh.is_scale_written else None)
        for (mesh, _), file in zip(found, files, strict=True)
    ]
    return MeshAssets(elements, names, Path(folder).as_posix() if folder else None)


_AT_ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)

_AT_REST: Mapping[str, Sequence[float]] = {
    JointType.FIXED: (),
    JointType.PLANAR: (0.0, 0.0, 0.0),
    JointType.FLOATING: _AT_ORIGIN,
}
"""The positions at rest of joints that have other than one position; a quaternion begins with w."""

INITIAL, INITIAL_VALUE = "initial_positions", "initial_value"
"""The keyframe of the initial positions, and the parameter of an interface that is one."""

Positions: TypeAlias = Mapping[str, Sequence[object]]
"""The positions of joints by name, as SRDF has them."""


class State(NamedTuple):
    """A keyframe: positions of some joints, the virtual one of the base among them; the others are at rest.

    `origin` is what it is made of, in words.
    """

    name: str
    origin: str
    positions: Positions
    source: SourceRef | None


def states_of(robot: Robot) -> Iterator[State]:
    """Yield the initial positions of ros2_control as `initial_positions`, and the states of all groups.

    States of one name in several groups have the name of their group before it.
    """
    initial = tuple(_initial_positions(robot))
    if initial:
        positions = {name: (value,) for name, value, _ in initial}
        yield State(INITIAL, "the initial positions", positions, initial[0][-1])
    states = robot.semantic.group_states if robot.has_semantic else ()
    count = Counter(state.name for state in states)
    for state in states:
        name = state.name if count[state.name] == 1 else f"{state.group}_{state.name}"
        origin = f"state '{state.name}' of group '{state.group}'"
        yield State(name, origin, state.joint_values, state.source)


def _initial_positions(robot: Robot) -> Iterator[tuple[str, float, SourceRef | None]]:
    """Yield the initial position of each joint that hardware gives one, and its place."""
    for hardware in (joint for system in robot.ros2_controls for joint in system.joints):
        if not robot.has_joint(hardware.name) or robot.joints[hardware.name].type not in SINGLE_AXIS:
            continue
        for state in map(Interface.of, hardware.state_interfaces):
            value = finite_number(state.parameters.get(INITIAL_VALUE))
            if state == "position" and value is not None:
                yield hardware.name, value, state.source or hardware.source


def key_elements(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Xml]:
    """Yield the states of a robot as positions of all joints, held by its position actuators."""
    driven = tuple(drives(robot))
    for name, _, stated, source in states_of(robot):
        positions = _positions(tree, stated)
        base = _pose_of_base(robot, tree.nodes[0].link.name, stated) if is_free and _has_free_root(tree) else ()
        ctrl = [_command(drive, positions) for drive in driven]
        yield leaf_at("key", source, name=name, qpos=[*base, *_in_order(tree, positions)], ctrl=ctrl or None)


def _has_free_root(tree: KinematicTree) -> bool:
    return bool(tree.nodes) and tree.nodes[0].link.name != WORLD


def _pose_of_base(robot: Robot, base: str, stated: Positions) -> Sequence[float]:
    """Return the pose that a state gives the floating virtual joint of the base, that of the world without one."""
    virtual_joints = robot.semantic.virtual_joints if robot.has_semantic else ()
    for joint in virtual_joints:
        if joint.child_link == base and joint.type == VirtualJointType.FLOATING and joint.name in stated:
            return _numbers(stated[joint.name], JointType.FLOATING, _AT_ORIGIN)
    return _AT_ORIGIN


def _in_order(tree: KinematicTree, positions: Mapping[str, Sequence[float]]) -> Iterator[float]:
    for node in tree.nodes:
        if node.joint:
            yield from positions[node.joint.name]


def _positions(tree: KinematicTree, stated: Positions) -> dict[str, Sequence[float]]:
    """Return the positions of each joint of the tree; those of joints that mimic others follow."""
    joints = [node.joint for node in tree.nodes if node.joint]
    positions = {joint.name: _of_state(joint, stated) for joint in joints}
    for _ in joints:  # one may mimic another one that does
        changed = {joint.name: _mimicking(joint, positions) for joint in joints}
        if changed == positions:
            break
        positions = changed
    return positions


def _of_state(joint: Joint, stated: Positions) -> Sequence[float]:
    at_rest = _AT_REST.get(joint.type, (_position_at_rest(joint),))
    return _numbers(stated.get(joint.name, ()), joint.type, at_rest)


def _numbers(stated: Sequence[object], kind: str, at_rest: Sequence[float]) -> Sequence[float]:
    """Return the positions of a joint in MuJoCo's order; those at rest unless as many numbers are stated."""
    numbers = [one for one in stated if isinstance(one, int | float)]
    if len(numbers) != len(at_rest):
        return at_rest
    if kind == JointType.FLOATING:  # SRDF has w last
        return (*numbers[:3], numbers[6], *numbers[3:6])
    return tuple(numbers)


def _position_at_rest(joint: Joint) -> float:
    """Return 0, or the middle of a range without it, as joint_state_publisher and MoveIt do."""
    if joint.limits is None or joint.type == JointType.CONTINUOUS:
        return 0.0
    lower, upper = range_of(joint.limits)
    return 0.0 if lower <= 0 <= upper else (lower + upper) / 2


def _mimicking(joint: Joint, positions: Mapping[str, Sequence[float]]) -> Sequence[float]:
    own, mimic = positions[joint.name], joint.mimic
    other = positions.get(mimic.joint, ()) if mimic else ()
    if not mimic or len(own) != 1 or len(other) != 1:
        return own
    return (mimic.offset + mimic.multiplier * other[0],)


def _command(drive: Drive, positions: Mapping[str, Sequence[float]]) -> float:
    return positions[drive.joint.name][0] if str(drive.interface) == "position" else 0.0


def robot_view(robot: Robot, *, is_free: bool) -> View:
    """Return what templates see of a robot in MJCF; one that `is_free` has six degrees of freedom more."""
    tree, meshes = KinematicTree.of(robot), mesh_assets(robot)
    driven = tuple(drives(robot))
    joints = (joint_settings(joint) for joint in robot.joints if joint.type in SINGLE_AXIS)
    joint_class = JointClass.of((*joints, *map(actuator_settings, driven)))
    return View(
        attributes=attributes_at(robot.source, "name", model=robot.name),
        mesh_folder=meshes.folder,
        meshes=meshes.elements,
        joint_class=joint_class.elements(),
        world=world_elements(robot, meshes.names),
        bodies=tuple(body_views(robot, tree, meshes.names, joint_class, is_free=is_free)),
        exclusions=exclusion_elements(robot, tree, is_free=is_free),
        equalities=equality_elements(robot),
        actuators=[actuator_element(drive, joint_class) for drive in driven],
        sensors=tuple(sensor_elements(robot)),
        keys=tuple(key_elements(robot, tree, is_free=is_free)),
    )
