"""The links of a robot as a tree of bodies: which joint holds each, and what fixed joints hold together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_depth_first, walk_down
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot

WORLD = "world"
"""The body that simulators have by themselves; a root link of this name is that body."""


class Node(NamedTuple):
    """A link in the tree, the joint above it, None for a root, and how many bodies hold it."""

    link: Link
    joint: Joint | None
    depth: int


class KinematicTree(NamedTuple):
    """The links of a robot, each before those below it, depth first.

    `above` has the joint that holds a link, `fixed` the fixed joints by parent. A joint to a link that has one already
    is omitted. The world is no body, so it is not among the nodes that hold others.
    """

    nodes: Sequence[Node]
    above: Mapping[str, Joint]
    fixed: Mapping[str, Sequence[Joint]]

    @classmethod
    def of(cls, robot: Robot) -> KinematicTree:
        above = parent_joints(robot.joints)
        below = child_joints(joint for joint in above.values() if robot.has_link(joint.child))
        roots = [link.name for link in robot.links if link.name not in above]
        nodes, in_world = [], 0
        for visit in walk_depth_first(roots, below):
            if visit.joint is None:
                in_world = int(visit.link == WORLD)
            nodes.append(Node(robot.links[visit.link], visit.joint, max(visit.depth - in_world, 0)))
        return cls(nodes, above, child_joints(fixed_joints(robot)))

    def depth(self) -> int:
        """Return how many bodies are inside each other at most."""
        return max((node.depth + 1 for node in self.nodes), default=0)

    def held_by(self, link: str) -> Iterator[str]:
        """Yield a link and all that fixed joints hold to it from below."""
        yield link
        yield from (joint.child for joint in walk_down((link,), self.fixed))

    def fixed_to(self, link: str) -> Iterator[str]:
        """Yield the links that a fixed joint connects with a link directly, the one above it first."""
        joint = self.above.get(link)
        if joint and joint.type == JointType.FIXED:
            yield joint.parent
        yield from (joint.child for joint in self.fixed.get(link, ()))


def fixed_joints(robot: Robot) -> Iterator[Joint]:
    """Yield the fixed joints whose child is a link of the robot."""
    return (joint for joint in robot.joints if joint.type == JointType.FIXED and robot.has_link(joint.child))


def leader_of(joint: Joint, robot: Robot) -> Joint | None:
    """Return the joint that a joint mimics; None where one of them has other than one axis, as for LF5502."""
    if joint.mimic is None or joint.type not in SINGLE_AXIS or not robot.has_joint(joint.mimic.joint):
        return None
    leader = robot.joints[joint.mimic.joint]
    return leader if leader.type in SINGLE_AXIS else None
