"""The limits of joints that joint_limits.yaml holds, and those that MoveIt misses."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.core.models.joint import Joint, JointLimits
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import NO_LIMIT_FOR_MOVEIT, NO_MOVING_JOINT
from linkforge_compile.formats.element import placed
from linkforge_compile.formats.groups import actuated_joints, faulty_groups, joints_by_group
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.views import View


def missing_joints(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no limits to write; None if it has some."""
    return None if actuated_joints(robot) else NO_MOVING_JOINT.at(robot.source, "name", robot=robot.name)


def check_limits(robot: Robot) -> Iterator[Diagnostic]:
    """MoveIt times no trajectory of a group with a joint whose velocity or acceleration has no limit."""
    if faulty_groups(robot):
        return  # which joints are planned is unknown
    planned = {joint.name for joints in joints_by_group(robot).values() for joint in joints}
    for joint in actuated_joints(robot):
        if planned and joint.name not in planned:
            continue
        for kind in ("velocity", "acceleration"):
            if known_limit(joint, kind) is None:
                yield NO_LIMIT_FOR_MOVEIT.at(joint.source, "limits", kind, joint=joint.name, limit=kind)


_KINDS = ("velocity", "acceleration", "deceleration", "jerk")
_OFTEN_UNKNOWN = ("deceleration", "jerk")
"""Limits that are omitted where they are unknown; MoveIt takes an acceleration for a deceleration."""


def limits_view(robot: Robot) -> View:
    """Return what templates see of the joints; `bound` is a number [SI], None for a limit that is unknown.

    A deceleration is negative, as Pilz's planner requires.
    """
    joints = actuated_joints(robot)
    return View(joints=[View(name=placed(one.name, one.source), limits=tuple(_limits(one))) for one in joints])


def _limits(joint: Joint) -> Iterator[View]:
    for kind in _KINDS:
        bound = known_limit(joint, kind)
        if bound is not None or kind not in _OFTEN_UNKNOWN:
            place = origin_of(joint.source, "limits", kind)
            yield View(kind=kind, bound=-bound if bound and kind == "deceleration" else bound, place=place)


def known_limit(joint: Joint, kind: str) -> float | None:
    """Return a limit of a joint, None for one that is unknown, or 0, which a URDF has for no limit."""
    limit: float | None = getattr(joint.limits or JointLimits(velocity=0.0), kind)
    return float(limit) if limit else None
