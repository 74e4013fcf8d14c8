"""Keyframes in MJCF: the states of groups as positions of all joints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.mjcf.actuators import Drive, drives
from linkforge_compile.formats.mjcf.joints import is_locked
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

_AT_ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)

_AT_REST: Mapping[str, Sequence[float]] = {
    JointType.FIXED: (),
    JointType.PLANAR: (0.0, 0.0, 0.0),
    JointType.FLOATING: _AT_ORIGIN,
}
"""The positions of joints at rest where they are not one 0; a quaternion begins with w."""


def key_elements(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Xml]:
    """Yield the states of all groups; joints that a state does not mention are at 0.

    Position actuators hold the state. States of one name in several groups have the name of their group before it.
    """
    if not robot.has_semantic:
        return
    states = robot.semantic.group_states
    count = Counter(state.name for state in states)
    driven = tuple(drives(robot))
    for state in states:
        name = state.name if count[state.name] == 1 else f"{state.group}_{state.name}"
        positions = _positions(robot, tree, state.joint_values)
        qpos = [*(_AT_ORIGIN if is_free and _has_free_root(tree) else ()), *_in_order(tree, positions)]
        ctrl = [_command(drive, positions) for drive in driven]
        yield leaf_at("key", state.source, name=name, qpos=qpos, ctrl=ctrl or None)


def _has_free_root(tree: KinematicTree) -> bool:
    return bool(tree.nodes) and tree.nodes[0].link.name != WORLD


def _in_order(tree: KinematicTree, positions: Mapping[str, Sequence[float]]) -> Iterator[float]:
    for node in tree.nodes:
        if node.joint:
            yield from positions[node.joint.name]


def _positions(robot: Robot, tree: KinematicTree, stated: Mapping[str, Sequence[object]]) -> dict[str, Sequence[float]]:
    """Return the positions of each joint of the tree; those of joints that mimic others follow."""
    joints = [node.joint for node in tree.nodes if node.joint]
    positions = {joint.name: _of_state(joint, stated) for joint in joints}
    for _ in joints:  # one may mimic another one that does
        changed = {joint.name: _mimicking(joint, positions) for joint in joints}
        if changed == positions:
            break
        positions = changed
    return positions


def _of_state(joint: Joint, stated: Mapping[str, Sequence[object]]) -> Sequence[float]:
    at_rest = _AT_REST.get(joint.type, (_locked_at(joint),))
    numbers = [one for one in stated.get(joint.name, ()) if isinstance(one, int | float)]
    if len(numbers) != len(at_rest):
        return at_rest
    if joint.type == JointType.FLOATING:  # SRDF has w last
        return (*numbers[:3], numbers[6], *numbers[3:6])
    return tuple(numbers)


def _locked_at(joint: Joint) -> float:
    return joint.limits.lower or 0.0 if joint.limits and is_locked(joint.limits) else 0.0


def _mimicking(joint: Joint, positions: Mapping[str, Sequence[float]]) -> Sequence[float]:
    own, mimic = positions[joint.name], joint.mimic
    other = positions.get(mimic.joint, ()) if mimic else ()
    if not mimic or len(own) != 1 or len(other) != 1:
        return own
    return (mimic.offset + mimic.multiplier * other[0],)


def _command(drive: Drive, positions: Mapping[str, Sequence[float]]) -> float:
    return positions[drive.joint.name][0] if str(drive.interface) == "position" else 0.0
