"""What MoveIt misses in the limits of a robot's joints."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics.codes.formats import NO_LIMIT_FOR_MOVEIT, NO_MOVING_JOINT
from linkforge_compile.formats.groups import actuated_joints, faulty_groups, joints_by_group
from linkforge_compile.formats.joint_limits.view import known_limit

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic


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
