"""Pairs of bodies that do not collide in MJCF."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.source import SourceRef


def exclusion_elements(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Sequence[Xml]:
    """Return the pairs of `disabled_collisions`, and those of joints that MuJoCo does not exclude by itself.

    It lets no body collide with its parent, unless that is fixed to the world.
    """
    pairs: dict[tuple[str, str], SourceRef | None] = {}
    if robot.has_semantic:
        for pair in robot.semantic.disabled_collisions:
            if robot.has_link(pair.link1) and robot.has_link(pair.link2):
                pairs.setdefault(pair.key, pair.source)
    for parent, child, source in _joints_of_static_bodies(robot, tree, is_free=is_free):
        pairs.setdefault((min(parent, child), max(parent, child)), source)
    return [leaf_at("exclude", source, body1=one, body2=other) for (one, other), source in pairs.items()]


def _joints_of_static_bodies(
    robot: Robot, tree: KinematicTree, *, is_free: bool
) -> Iterator[tuple[str, str, SourceRef | None]]:
    """Yield the links and source of each joint that moves a link with collisions against one that never moves."""
    static: set[str] = set()
    for link, joint, _ in tree.nodes:
        if joint is None:
            is_static = not is_free or link.name == WORLD
        else:
            is_static = joint.type == JointType.FIXED and joint.parent in static
            touches = link.collisions and robot.links[joint.parent].collisions
            # A floating base is to stay on the ground.
            is_loose = joint.type in (JointType.FLOATING, JointType.PLANAR)
            if touches and joint.parent in static and not is_static and not is_loose:
                yield joint.parent, link.name, joint.source
        if is_static:
            static.add(link.name)
