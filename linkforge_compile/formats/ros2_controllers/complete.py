"""Controllers with what follows from the robot: defaults for its planning groups, joints and interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.controller import (
    DEFAULT_BROADCASTER,
    DEFAULT_TRAJECTORY,
    JOINT_FIELDS,
    MANAGER,
    Controller,
    default_name,
    loaded_class,
)
from linkforge_compile.core.models.controller_kinds import (
    FORWARD,
    GRIPPER,
    KINDS,
    OTHER_CLASSES,
    PARAMETERS_OF_FIELDS,
    STATES,
    TRAJECTORY,
    lift_parameters,
    path_of_field,
)
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2ControlJoint
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import NO_HARDWARE
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.formats.groups import actuated_joints, faulty_groups, joints_by_group
from linkforge_compile.source import SourceRef

_COMMANDS = ("position", "velocity", "effort")
_STATES = ("position", "velocity")


class Origin(NamedTuple):
    """Where a value was written, as a path below a source, or what it follows from.

    `why` it follows from the part `subject`, which was written there; "" for a value that was written itself.
    """

    why: str
    subject: str
    source: SourceRef | None
    path: tuple[str, ...] = ()


class Completed(NamedTuple):
    """A controller with all of its fields, and the origins of those that are not at their places, by name.

    The one of "" is that of a default controller as a whole.
    """

    controller: Controller
    origins: Mapping[str, Origin]

    def with_field(self, field: str, names: tuple[str, ...], origin: Origin) -> Completed:
        return Completed(self.controller.with_fields(**{field: names}), {**self.origins, field: origin})


def missing_hardware(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no controllers; None if it has some."""
    if robot.ros2_controls or any(one.name != MANAGER for one in robot.controllers):
        return None
    return NO_HARDWARE.at(robot.source, "name", robot=robot.name)


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
    return completed.with_field("joints", joints, Origin(why, f"planning group '{group.name}'", group.source))


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
        of_hardware = Origin(why, f"joint '{joints[0]}' of `ros2_control`", hardware[joints[0]].source)
        all_joints = Completed(Controller(DEFAULT_TRAJECTORY, TRAJECTORY), {})
        yield all_joints.with_field("joints", tuple(joints), of_hardware)


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
    for field, (names, which) in found.items():
        if names and not getattr(controller, field):
            why, subject = f"{which} that all of its joints have in `ros2_control`", f"joint '{joints[0].name}'"
            origin = Origin(why, f"{subject} of `ros2_control`", joints[0].source, (field,))
            completed = completed.with_field(field, names, origin)
    return completed


def _common(names: tuple[str, ...], of_joints: Iterable[Iterable[str]]) -> Iterator[str]:
    """Yield the names that each joint has; none without joints."""
    sets = [frozenset(map(str, interfaces)) for interfaces in of_joints]
    return (name for name in names if sets and all(name in interfaces for interfaces in sets))


_TYPING_ERRORS = 2
"""By how many letters a misspelled class is shorter or longer; other packages have longer names."""


def misspelled_class(type_: str | None) -> str | None:
    """Return the class of ros2_controllers that a type misspells; None for a class of another package."""
    if not type_ or type_ in KINDS or type_ in OTHER_CLASSES:
        return None
    near = nearest(type_, (*KINDS, *OTHER_CLASSES))
    if near is None:
        return None
    is_of_package = type_.split("/")[0] == near.split("/")[0]
    return near if is_of_package or abs(len(type_) - len(near)) <= _TYPING_ERRORS else None


def explained_controllers(robot: Robot) -> tuple[Completed, ...]:
    """Return the controllers of the outputs; none for a robot without hardware, for which there is no file of them."""
    if missing_hardware(robot):
        return ()
    are_stated = any(one.name != MANAGER for one in robot.controllers)
    return tuple(_with_all_origins(one, are_stated) for one in completed_controllers(robot))


def _with_all_origins(completed: Completed, are_stated: bool) -> Completed:
    """Add where the fields were written that are parameters in the spec, and why there is a default controller."""
    controller = completed.controller
    paths = {field: path_of_field(controller, field) for field in PARAMETERS_OF_FIELDS}
    origins = {field: Origin("", "", controller.source, path) for field, path in paths.items() if path != (field,)}
    origins |= completed.origins
    if not are_stated:
        subject = f"planning group '{controller.group}'" if controller.group else ""
        origins[""] = Origin("a default, because the spec has no `controllers`", subject, controller.source)
    return Completed(controller, origins)
