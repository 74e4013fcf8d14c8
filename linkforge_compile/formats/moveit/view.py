"""The groups, controllers and positions that the templates of MoveIt's configuration lay out."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.core.models.controller import Controller
from linkforge_compile.core.models.controller_kinds import EFFORT_GRIPPER, GRIPPER, OLD_GRIPPER, TRAJECTORY
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface, Ros2ControlJoint
from linkforge_compile.core.models.srdf import PlanningGroup
from linkforge_compile.formats.element import placed
from linkforge_compile.formats.groups import chain_groups
from linkforge_compile.formats.ros2_controllers.complete import commanded_joints, complete_controllers
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.views import View
from linkforge_compile.units import finite_number

_SOLVER = {
    "kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
    "kinematics_solver_search_resolution": 0.005,
    "kinematics_solver_timeout": 0.005,
}
"""What the MoveIt Setup Assistant writes."""

SOLVER_PARAMETERS = (*_SOLVER, "kinematics_solver_attempts", "kinematics_solver_ik_links")
"""The parameters of a group that MoveIt itself reads; all others are those of a solver."""

_DECIMALS = frozenset(_SOLVER) | {"epsilon", "orientation_vs_position"}
"""Parameters that the loader of solvers, and KDL's, declare as numbers with decimals."""

_ACTIONS = {
    TRAJECTORY: ("FollowJointTrajectory", "follow_joint_trajectory"),
    GRIPPER: ("ParallelGripperCommand", "gripper_cmd"),
    OLD_GRIPPER: ("GripperCommand", "gripper_cmd"),
    EFFORT_GRIPPER: ("GripperCommand", "gripper_cmd"),
}
"""The type of MoveIt's handle for a class of controllers, and the name of its action."""


def moveit_view(robot: Robot) -> View:
    """Return what templates see: the groups with solvers, the controllers with actions, and the initial positions."""
    return View(
        groups=list(_groups(robot)),
        controllers=list(_controllers(robot)),
        initial_positions=list(_initial_positions(robot)),
    )


def _groups(robot: Robot) -> Iterator[View]:
    """Yield the groups with a solver: those that state one, and those that are one chain and no end effector."""
    chains = chain_groups(robot)
    tools = {effector.group for effector in robot.semantic.end_effectors} if chains else frozenset[str]()
    for group in robot.semantic.groups if robot.has_semantic else ():
        is_arm = group.name in chains and group.name not in tools
        if is_arm or group.kinematics:
            yield View(name=placed(group.name, group.source), parameters=dict(_solver(group)))


def _solver(group: PlanningGroup) -> Iterator[tuple[str, object]]:
    for name, value in {**_SOLVER, **group.kinematics}.items():
        is_whole = isinstance(value, int) and not isinstance(value, bool)
        number = float(value) if is_whole and name in _DECIMALS else value
        yield placed(name, group.source, "kinematics", name), number


def executing_controllers(robot: Robot) -> tuple[Controller, ...]:
    """Return the controllers that MoveIt can send motions to."""
    return tuple(one for one in complete_controllers(robot) if one.type in _ACTIONS and one.joints)


def _controllers(robot: Robot) -> Iterator[View]:
    """Yield the controllers with their actions; of those with a joint in common, the first is the default."""
    taken: set[str] = set()
    for one in executing_controllers(robot):
        kind, action = _ACTIONS[one.type or ""]
        name, joints = placed(one.name, one.source), list(one.joints)
        yield View(name=name, type=kind, action=action, joints=joints, is_default=taken.isdisjoint(joints))
        taken.update(joints)


def _initial_positions(robot: Robot) -> Iterator[View]:
    """Yield the positions of the commanded joints: that of the hardware, of the first state of a group, or 0."""
    for name, hardware in commanded_joints(robot).items():
        joint = robot.get_joint(name)
        if joint is not None:
            position, place = _initial_position(robot, joint, hardware)
            yield View(joint=placed(name, hardware.source), position=position, place=place)


def _initial_position(robot: Robot, joint: Joint, hardware: Ros2ControlJoint) -> tuple[float, str]:
    """Return a position, and the attribute for its place."""
    for interface in map(Interface.of, hardware.state_interfaces):
        number = finite_number(interface.parameters.get("initial_value")) if interface == "position" else None
        if number is not None:
            return number, origin_of(interface.source, "initial_value")
    for state in robot.semantic.group_states if robot.has_semantic else ():
        positions = state.joint_values.get(joint.name, ())
        if len(positions) == 1:
            return float(positions[0]), origin_of(state.source, joint.name)
    limits = joint.limits if joint.type is not JointType.CONTINUOUS else None
    lower, upper = (limits.lower, limits.upper) if limits else (None, None)
    nearest = max(0.0, lower) if lower is not None else 0.0
    return float(min(nearest, upper) if upper is not None else nearest), ""
