"""What keeps MoveIt from planning for a robot, or from executing a plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics.codes.formats import NO_GROUP_TO_PLAN, NOTHING_EXECUTES
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.formats.groups import faulty_groups, joints_by_group
from linkforge_compile.formats.moveit.view import executing_controllers
from linkforge_compile.formats.ros2_controllers.complete import commanded_joints, has_faulty_names

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
    if any(has_faulty_names(robot, one) for one in robot.controllers):
        return
    controlled = {name for one in executing_controllers(robot) for name in one.joints}
    groups, faulty, hardware = joints_by_group(robot), faulty_groups(robot), commanded_joints(robot)
    for group in robot.semantic.groups if groups else ():
        joints = [joint.name for joint in groups[group.name]]
        missing = [name for name in joints if name not in controlled]
        if missing and group.name not in faulty:
            yield NOTHING_EXECUTES.at(group.source, group=group.name, reason=_reason(robot, joints, missing, hardware))


def _reason(robot: Robot, joints: list[str], missing: list[str], hardware: Mapping[str, object]) -> str:
    """Return why no controllers have the joints of a group."""
    if not robot.ros2_controls:
        return "the robot has no `ros2_control`; add it"
    if hardware.keys().isdisjoint(joints):
        return "none of its joints has a command interface in `ros2_control`"
    uncommanded = [name for name in missing if name not in hardware]
    if uncommanded:
        verb = "has" if len(uncommanded) == 1 else "have"
        return f"{listed(uncommanded, 'and')} {verb} no command interface in `ros2_control`"
    return f"no controller of trajectories has {listed(missing, 'and')}"
