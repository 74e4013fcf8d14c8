"""How far the links of a robot may get, and where they are while every joint is at 0."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.geometry import IDENTITY
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_depth_first
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.poses import Pose

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

AT_REST = Pose.of(IDENTITY)
"""The pose of a frame in itself."""


class Reach(NamedTuple):
    """The greatest distance of a link's origin from that of a start link has this upper bound [m].

    It is the sum of the lengths between the joints that move, on the way from `start` to `link`, with prismatic joints
    at the end of their range that is farther. The true distance may be less, as limits may keep the robot from
    stretching out.
    """

    bound: float
    start: str
    link: str


class _Span(NamedTuple):
    """The greatest distance of the last joint that moves [m], and the pose of a link in its frame."""

    bound: float
    fixed: Pose

    @property
    def end(self) -> float:
        return self.bound + math.hypot(*self.fixed.xyz)


def zero_poses(robot: Robot) -> dict[str, Pose]:
    """Return the pose of each link in the frame of the root above it, with every joint at 0."""
    above, below = parent_joints(robot.joints), child_joints(robot.joints)
    poses: dict[str, Pose] = {}
    for visit in walk_depth_first((link.name for link in robot.links if link.name not in above), below):
        if not visit.is_again:
            joint = visit.joint
            poses[visit.link] = poses[joint.parent].times(Pose.of(joint.origin)) if joint else AT_REST
    return poses


def reaches_from(robot: Robot, start: str) -> dict[str, Reach]:
    """Return the reach of each link below a start link, without those that planar and floating joints carry."""
    spans: dict[str, _Span] = {start: _Span(0.0, AT_REST)}
    for visit in walk_depth_first((start,), child_joints(robot.joints)):
        joint = visit.joint
        if joint and not visit.is_again and joint.parent in spans:
            span = _next_span(robot, spans[joint.parent], joint)
            if span:
                spans[visit.link] = span
    return {link: Reach(span.end, start, link) for link, span in spans.items()}


def _next_span(robot: Robot, span: _Span, joint: Joint) -> _Span | None:
    pose = span.fixed.times(Pose.of(joint.origin))
    match joint.type:
        case JointType.FIXED:
            return _Span(span.bound, pose)
        case JointType.REVOLUTE | JointType.CONTINUOUS:
            return _Span(span.bound + math.hypot(*pose.xyz), AT_REST)
        case JointType.PRISMATIC if joint.axis:
            axis = pose.turn.turned(joint.axis.to_tuple())
            if not all(map(math.isfinite, _range(robot, joint))):
                return None
            ends = (tuple(a + end * b for a, b in zip(pose.xyz, axis, strict=True)) for end in _range(robot, joint))
            return _Span(span.bound + max(math.hypot(*end) for end in ends), AT_REST)
    return None


def _range(robot: Robot, joint: Joint, followers: Sequence[str] = ()) -> tuple[float, float]:
    """Return the positions between which a joint is, as one that follows another one is driven; 0 for no limit.

    A continuous joint turns without an end.
    """
    if joint.type is JointType.CONTINUOUS:
        return -math.inf, math.inf
    limits = joint.limits
    lower, upper = (limits.lower or 0.0, limits.upper or 0.0) if limits else (0.0, 0.0)
    mimic, leader = joint.mimic, robot.get_joint(joint.mimic.joint) if joint.mimic else None
    if not mimic or not leader or joint.name in followers:
        return lower, upper
    driven = [mimic.multiplier * end + mimic.offset for end in _range(robot, leader, (*followers, joint.name))]
    return min(lower, *driven), max(upper, *driven)


def farthest(reaches: Mapping[str, Reach]) -> Reach:
    """Return the reach of the link that may get farthest, the first of several."""
    return max(reaches.values(), key=lambda reach: reach.bound)
