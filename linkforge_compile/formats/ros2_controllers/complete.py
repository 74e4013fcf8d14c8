"""Controllers with what follows from the robot: defaults for its planning groups, joints and interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.controller import (
    DEFAULT_BROADCASTER,
    DEFAULT_TRAJECTORY,
    JOINT_FIELDS,
    MANAGER,
    Controller,
    default_name,
)
from linkforge_compile.core.models.controller_kinds import FORWARD, GRIPPER, STATES, TRAJECTORY, lift_parameters
from linkforge_compile.core.models.manager_parameters import loaded_class
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.formats.groups import actuated_joints, faulty_groups, joints_by_group

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.ros2_control import Ros2ControlJoint
    from linkforge_compile.source import SourceRef

_COMMANDS = ("position", "velocity", "effort")
_STATES = ("position", "velocity")


class Derived(NamedTuple):
    """The value of a field that follows from the robot, and why.

    `subject` is the part that it follows from, and `source` and `path` are where that was written.
    """

    value: tuple[str, ...]
    why: str
    subject: str
    source: SourceRef | None
    path: tuple[str, ...] = ()


class Completed(NamedTuple):
    """A controller with all of its fields, and those of them that follow from the robot, by name."""

    controller: Controller
    derived: Mapping[str, Derived]


def complete_controllers(robot: Robot) -> tuple[Controller, ...]:
    """Return the controllers of a robot, without the manager, each with its joints and interfaces.

    A robot that states none has those of its planning groups, except those whose class the manager states.
    """
    return tuple(completed.controller for completed in completed_controllers(robot))


def completed_controllers(robot: Robot) -> tuple[Completed, ...]:
    """Return the controllers of `complete_controllers`, each with where its derived fields come from."""
    manager = robot.controllers.get(MANAGER)
    loaded = manager.parameters if manager else {}
    stated = [Completed(lift_parameters(one), {}) for one in robot.controllers if one.name != MANAGER] or [
        one for one in _default_controllers(robot) if not loaded_class(loaded, one.controller.name)
    ]
    hardware, groups = commanded_joints(robot), joints_by_group(robot)
    return tuple(_with_interfaces(_with_joints(one, robot, hardware, groups), hardware) for one in stated)


def _with_joints(
    completed: Completed,
    robot: Robot,
    hardware: Mapping[str, Ros2ControlJoint],
    groups: Mapping[str, tuple[Joint, ...]],
) -> Completed:
    """Return a controller with the joints of its group, unless it has its own."""
    controller = completed.controller
    members = (joint.name for joint in groups.get(controller.group or "", ()))
    joints = tuple(name for name in members if name in hardware)
    if controller.joints or not joints:
        return completed
    group = next(group for group in robot.semantic.groups if group.name == controller.group)
    why = f"the joints of planning group '{group.name}' that have a command interface in `ros2_control`"
    return _with_derived(completed, joints=Derived(joints, why, f"planning group '{group.name}'", group.source))


def _with_derived(completed: Completed, **derived: Derived) -> Completed:
    values = {field: each.value for field, each in derived.items()}
    return Completed(completed.controller.with_fields(**values), {**completed.derived, **derived})


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


def _default_controllers(robot: Robot) -> Iterator[Completed]:
    """Yield the broadcaster of joint states, and one controller for each group with joints of its own.

    Groups of other groups come last, so that each arm has a controller, and not all of them one.
    """
    yield Completed(Controller(DEFAULT_BROADCASTER, STATES), {})
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
        controller = Controller(default_name(name), GRIPPER if is_gripper else TRAJECTORY, name)
        yield Completed(controller.with_source(stated[name].source), {})
    joints = [joint.name for joint in actuated_joints(robot) if joint.name in hardware]
    if joints and not groups:
        why = "the joints that have a command interface in `ros2_control`"
        of_hardware = Derived(tuple(joints), why, f"joint '{joints[0]}' of `ros2_control`", hardware[joints[0]].source)
        all_joints = Completed(Controller(DEFAULT_TRAJECTORY, TRAJECTORY), {})
        yield _with_derived(all_joints, joints=of_hardware)


def _with_interfaces(completed: Completed, hardware: Mapping[str, Ros2ControlJoint]) -> Completed:
    """Return a controller with the interfaces that its class needs and all of its joints have."""
    controller = completed.controller
    if controller.type not in {TRAJECTORY, FORWARD}:
        return completed
    joints = [hardware[name] for name in controller.joints if name in hardware]
    commands = tuple(_common(_COMMANDS, (joint.command_interfaces for joint in joints)))[:1]
    states = tuple(_common(_STATES, (joint.state_interfaces for joint in joints)))
    reads = controller.type == TRAJECTORY
    found = {
        "command_interfaces": (commands, f"the first of {listed(_COMMANDS, 'and')}"),
        "state_interfaces": (states if reads else (), f"those of {listed(_STATES, 'and')}"),
    }
    derived = {
        field: Derived(
            names,
            f"{which} that all of its joints have in `ros2_control`",
            f"joint '{joints[0].name}' of `ros2_control`",
            joints[0].source,
            (field,),
        )
        for field, (names, which) in found.items()
        if names and not getattr(controller, field)
    }
    return _with_derived(completed, **derived)


def _common(names: tuple[str, ...], of_joints: Iterable[Iterable[str]]) -> Iterator[str]:
    """Yield the names that each joint has; none without joints."""
    sets = [frozenset(map(str, interfaces)) for interfaces in of_joints]
    return (name for name in names if sets and all(name in interfaces for interfaces in sets))
