"""Controllers with what follows from the robot: defaults for its planning groups, joints and interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import JOINT_FIELDS, MANAGER, Controller
from linkforge_compile.core.models.controller_kinds import FORWARD, GRIPPER, STATES, TRAJECTORY, lift_parameters
from linkforge_compile.core.models.manager_parameters import loaded_class
from linkforge_compile.formats.groups import actuated_joints, faulty_groups, joints_by_group

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.ros2_control import Ros2ControlJoint

_COMMANDS = ("position", "velocity", "effort")
_STATES = ("position", "velocity")


def complete_controllers(robot: Robot) -> tuple[Controller, ...]:
    """Return the controllers of a robot, without the manager, each with its joints and interfaces.

    A robot that states none has those of its planning groups, except those whose class the manager states.
    """
    manager = robot.controllers.get(MANAGER)
    loaded = manager.parameters if manager else {}
    hardware, groups = commanded_joints(robot), joints_by_group(robot)
    stated = [one for one in robot.controllers if one.name != MANAGER] or [
        one for one in _default_controllers(robot) if not loaded_class(loaded, one.name)
    ]
    completed = []
    for one in map(lift_parameters, stated):
        members = (joint.name for joint in groups.get(one.group or "", ()))
        joints = one.joints or tuple(name for name in members if name in hardware)
        completed.append(_with_interfaces(one.with_fields(joints=joints), hardware))
    return tuple(completed)


def has_faulty_names(robot: Robot, controller: Controller) -> bool:
    """Return whether a controller names a joint or a group that is missing or faulty, which checks have reported."""
    names = (name for field in JOINT_FIELDS for name in getattr(controller, field))
    if not all(map(robot.has_joint, names)):
        return True
    groups = {group.name for group in robot.semantic.groups} if robot.has_semantic else set()
    return controller.group is not None and controller.group not in groups - faulty_groups(robot)


def commanded_joints(robot: Robot) -> dict[str, Ros2ControlJoint]:
    """Return the joints of ros2_control with a command interface, by name."""
    joints = (joint for system in robot.ros2_controls for joint in system.joints)
    return {joint.name: joint for joint in joints if joint.command_interfaces}


def _default_controllers(robot: Robot) -> Iterator[Controller]:
    """Yield the broadcaster of joint states, and one controller for each group with joints of its own.

    Groups of other groups come last, so that each arm has a controller, and not all of them one.
    """
    yield Controller("joint_state_broadcaster", STATES)
    hardware, groups = commanded_joints(robot), joints_by_group(robot)
    tools = {effector.group for effector in robot.semantic.end_effectors} if groups else frozenset[str]()
    stated = {group.name: group for group in robot.semantic.groups} if groups else {}
    taken: set[str] = set()
    for name in sorted(groups, key=lambda name: bool(stated[name].subgroups)):
        joints = [joint.name for joint in groups[name] if joint.name in hardware]
        if not joints or not taken.isdisjoint(joints):
            continue
        taken.update(joints)
        is_gripper = name in tools and len(joints) == 1 and "position" in hardware[joints[0]].command_interfaces
        controller = Controller(f"{name}_controller", GRIPPER if is_gripper else TRAJECTORY, name)
        yield controller.with_source(stated[name].source)
    if not groups and (joints := [joint.name for joint in actuated_joints(robot) if joint.name in hardware]):
        yield Controller("joint_trajectory_controller", TRAJECTORY, joints=joints)


def _with_interfaces(controller: Controller, hardware: dict[str, Ros2ControlJoint]) -> Controller:
    """Return a controller with the interfaces that its class needs and all of its joints have."""
    if controller.type not in {TRAJECTORY, FORWARD}:
        return controller
    joints = [hardware[name] for name in controller.joints if name in hardware]
    commands = tuple(_common(_COMMANDS, (joint.command_interfaces for joint in joints)))[:1]
    states = tuple(_common(_STATES, (joint.state_interfaces for joint in joints)))
    reads = controller.type == TRAJECTORY
    return controller.with_fields(
        command_interfaces=controller.command_interfaces or commands,
        state_interfaces=controller.state_interfaces or (states if reads else ()),
    )


def _common(names: tuple[str, ...], of_joints: Iterable[Iterable[str]]) -> Iterator[str]:
    """Yield the names that each joint has; none without joints."""
    sets = [frozenset(map(str, interfaces)) for interfaces in of_joints]
    return (name for name in names if sets and all(name in interfaces for interfaces in sets))
