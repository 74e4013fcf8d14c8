"""Find the pairs of links that collide in a named state of a group, and how deep."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from linkforge_compile.collisions.collider import Collider
from linkforge_compile.collisions.meshes import find_meshes
from linkforge_compile.collisions.scene import Body, Names, Pose, Scene, comparable_pairs, make_scene
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics import Diagnostics

LEAST_DEPTH = 1e-6
"""Links less deep in each other only touch, as far as numbers can tell [m]."""


class Collision(NamedTuple):
    """Two links that collide, and how far one must move to be free of the other, None if unknown [m].

    The depth of meshes is that of their convex hulls. `disabled` is why planners ignore the pair, None if they do not.
    """

    links: Names
    depth: float | None
    disabled: str | None


def find_collisions(robot: Robot, states: Iterable[GroupState], sink: Diagnostics) -> list[list[Collision]]:
    """Return the collisions in each of the states, those that planners do not ignore first.

    Joints that a state does not give are in the default pose, and those with `mimic` follow. Links that touch do not
    collide. Nothing is returned if a shape is unknown, which is reported.
    """
    paths = find_meshes(robot, sink)
    if sink.has_errors:
        return []
    scene = make_scene(robot, paths)
    placed, collider = scene, Collider(scene, comparable_pairs(scene))
    places = {body.link: place for place, body in enumerate(scene)}
    found = []
    for state in states:
        positions = {
            places[robot.joints[joint].child]: float(values[0])
            for joint, values in state.joint_values.items()
            if robot.has_joint(joint) and len(values) == 1 and isinstance(values[0], int | float)
        }
        before, placed = placed, _place_free_bodies(scene, robot, state)
        if placed != before:
            collider = Collider(placed, comparable_pairs(placed))
        depths = collider.depths(collider.positions_with(positions))
        links = {(scene[one].link, scene[other].link): depth for (one, other), depth in depths.items()}
        deep = {pair: depth for pair, depth in links.items() if depth is None or depth > LEAST_DEPTH}
        collisions = [Collision(pair, depth, _why_disabled(robot, pair)) for pair, depth in deep.items()]
        found.append(sorted(collisions, key=lambda one: one.disabled is not None))
    return found


def _place_free_bodies(scene: Scene, robot: Robot, state: GroupState) -> Scene:
    """Return a scene in which the bodies below planar and floating joints are where a state has them.

    Without values, they are where the joint is, as in MoveIt's default pose.
    """
    values = {robot.joints[joint].child: of for joint, of in state.joint_values.items() if robot.has_joint(joint)}

    def placed(body: Body) -> Body:
        is_free = scene[body.island] is body and body.parent is not None
        return body._replace(island=0, pose=_moved(body.pose, values.get(body.link, ())) if is_free else body.pose)

    return tuple(map(placed, scene))


def _moved(pose: Pose, values: Sequence[float | str]) -> Pose:
    """Return a pose moved by a joint: x, y and an angle, or a position and a quaternion x, y, z, w, as in MoveIt."""
    numbers = [float(value) for value in values if isinstance(value, int | float)]
    match numbers:
        case [x, y, angle]:
            move = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, angle), np.array([x, y, 0.0]))
        case [x, y, z, *quaternion] if len(quaternion) == 4 and any(quaternion):
            turn = pin.Quaternion(np.array(quaternion)).normalized()
            move = pin.SE3(turn.toRotationMatrix(), np.array([x, y, z]))
        case _:
            return pose
    at = pin.SE3(pin.rpy.rpyToMatrix(np.array(pose.rpy)), np.array(pose.xyz)) * move
    x, y, z = at.translation.tolist()
    roll, pitch, yaw = pin.rpy.matrixToRpy(at.rotation).tolist()
    return Pose((x, y, z), (roll, pitch, yaw))


def _why_disabled(robot: Robot, links: Names) -> str | None:
    """Return the reason why MoveIt ignores a pair, empty if none is given; None for a pair that it checks."""
    semantic, key = robot.semantic, tuple(sorted(links))
    reason = next((pair.reason or "" for pair in semantic.disabled_collisions if pair.key == key), None)
    if reason is not None:
        return reason
    is_off = not set(links).isdisjoint(semantic.no_default_collision_links)
    is_enabled = any(pair.key == key for pair in semantic.enabled_collisions)
    return "no default collisions" if is_off and not is_enabled else None
