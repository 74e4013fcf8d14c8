"""What keeps MoveIt from planning for a robot, or from executing a plan."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics.codes.formats import NO_GROUP_TO_PLAN, NOTHING_EXECUTES
from linkforge_compile.formats.groups import joints_by_group
from linkforge_compile.formats.moveit.view import executing_controllers

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic


def missing_groups(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no configuration; None if it has one."""
    if any(joints_by_group(robot).values()):
        return None
    return NO_GROUP_TO_PLAN.at(robot.source, "name", robot=robot.name)


def check_execution(robot: Robot) -> Iterator[Diagnostic]:
    """The joints of each planning group are those of controllers that MoveIt can send motions to."""
    controlled = {name for one in executing_controllers(robot) for name in one.joints}
    groups = joints_by_group(robot)
    for group in robot.semantic.groups if groups else ():
        if any(joint.name not in controlled for joint in groups[group.name]):
            yield NOTHING_EXECUTES.at(group.source, group=group.name)
