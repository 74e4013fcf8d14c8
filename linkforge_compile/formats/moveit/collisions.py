"""Adjacent links that MoveIt would report as colliding, because no pair disables their check."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.diagnostics.codes.collisions import ADJACENT_CHECKED

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic


def check_adjacent_links(robot: Robot) -> Iterator[Diagnostic]:
    """Two links with collisions that a joint connects are a pair of the self-collision matrix.

    Neighbors usually touch, so that every state of the robot would be in collision. A pair in `enabled_collisions`, and
    links without default collisions, are decided already.
    """
    if not robot.has_semantic:
        return
    semantic = robot.semantic
    decided = {
        frozenset((pair.link1, pair.link2)) for pair in (*semantic.disabled_collisions, *semantic.enabled_collisions)
    }
    off = frozenset(semantic.no_default_collision_links)
    with_shapes = {link.name for link in robot.links if link.collisions}
    for parent, child in _adjacent_links(robot, with_shapes):
        if frozenset((parent, child)) not in decided and off.isdisjoint((parent, child)):
            place = (robot.source, "semantic", "disabled_collisions")
            yield ADJACENT_CHECKED.at(*place, pair=f"{parent} and {child}")


def _adjacent_links(robot: Robot, with_shapes: set[str]) -> Iterator[tuple[str, str]]:
    """Yield each link with collisions after the nearest one above it that has some, unless it can float away."""
    above = {joint.child: joint for joint in robot.joints}
    for link in robot.links:
        joint = above.get(link.name) if link.name in with_shapes else None
        while joint and joint.type not in (JointType.FLOATING, JointType.PLANAR):
            if joint.parent in with_shapes:
                yield joint.parent, link.name
                break
            joint = above.get(joint.parent)
