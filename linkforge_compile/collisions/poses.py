"""Find the pairs of links that collide in a named state of a group, and how deep."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linkforge_compile.collisions.collider import Collider
from linkforge_compile.collisions.meshes import find_meshes
from linkforge_compile.collisions.pairs import Names, comparable_pairs
from linkforge_compile.collisions.scene import make_scene
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics import Diagnostics


class Collision(NamedTuple):
    """Two links that collide, and how far one must move to be free of the other, None if unknown [m].

    The depth of meshes is that of their convex hulls. `disabled` is why planners ignore the pair, None if they do not.
    """

    links: Names
    depth: float | None
    disabled: str | None


def find_collisions(robot: Robot, states: Iterable[GroupState], sink: Diagnostics) -> list[list[Collision]]:
    """Return the collisions in each of the states, those that planners do not ignore first.

    Joints that a state does not give are in the default pose, and those with `mimic` follow. Nothing is returned if a
    shape is unknown, which is reported.
    """
    paths = find_meshes(robot, sink)
    if sink.has_errors:
        return []
    scene = make_scene(robot, paths)
    collider = Collider(scene, comparable_pairs(scene))
    places = {body.link: place for place, body in enumerate(scene)}
    found = []
    for state in states:
        positions = {
            places[robot.joints[joint].child]: float(values[0])
            for joint, values in state.joint_values.items()
            if robot.has_joint(joint) and len(values) == 1 and isinstance(values[0], int | float)
        }
        depths = collider.depths(collider.positions_with(positions))
        links = {(scene[one].link, scene[other].link): depth for (one, other), depth in depths.items()}
        collisions = [Collision(pair, depth, _why_disabled(robot, pair)) for pair, depth in links.items()]
        found.append(sorted(collisions, key=lambda one: one.disabled is not None))
    return found


def _why_disabled(robot: Robot, links: Names) -> str | None:
    """Return the reason why MoveIt ignores a pair, empty if none is given; None for a pair that it checks."""
    semantic, key = robot.semantic, tuple(sorted(links))
    reason = next((pair.reason or "" for pair in semantic.disabled_collisions if pair.key == key), None)
    if reason is not None:
        return reason
    is_off = not set(links).isdisjoint(semantic.no_default_collision_links)
    is_enabled = any(pair.key == key for pair in semantic.enabled_collisions)
    return "no default collisions" if is_off and not is_enabled else None
