"""What a controller manager refuses of a robot's controllers, and joints that none of them commands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import JOINT_FIELDS, MANAGER
from linkforge_compile.core.models.controller_kinds import (
    KINDS,
    PARAMETERS_OF_FIELDS,
    STATES,
    TRAJECTORY,
    kind_of,
    written_names,
)
from linkforge_compile.diagnostics.codes.formats import (
    CONTROLLER_LACKS,
    MISSPELLED_CLASS,
    NO_CONTROLLER_FOR_JOINT,
    NO_GAINS,
    NO_HARDWARE,
    NOT_OF_CONTROLLER,
)
from linkforge_compile.formats.groups import faulty_groups
from linkforge_compile.formats.ros2_controllers.check_parameters import check_parameters
from linkforge_compile.formats.ros2_controllers.class_names import misspelled_class
from linkforge_compile.formats.ros2_controllers.complete import (
    commanded_joints,
    complete_controllers,
    has_faulty_names,
)
from linkforge_compile.formats.ros2_controllers.interfaces import check_interfaces
from linkforge_compile.formats.ros2_controllers.refused import check_refused

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic


def missing_hardware(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no controllers; None if it has some."""
    if robot.ros2_controls or any(one.name != MANAGER for one in robot.controllers):
        return None
    return NO_HARDWARE.at(robot.source, "name", robot=robot.name)


def check_controllers(robot: Robot) -> Iterator[Diagnostic]:
    """A controller has what its class needs and nothing else; each commanded joint has a controller."""
    controllers, hardware = complete_controllers(robot), commanded_joints(robot)
    yield from check_refused(robot, controllers)
    if manager := robot.controllers.get(MANAGER):
        names = {one.name for one in controllers}
        maps = {key: value for key, value in manager.parameters.items() if isinstance(value, Mapping)}
        others = {key: value for key, value in manager.parameters.items() if key not in {*maps, *names}}  # LF7621
        loaded = {name for name, value in maps.items() if "type" in value}
        yield from check_parameters(manager.with_fields(parameters={**maps, **others}), MANAGER, names | loaded)
    for controller in controllers:
        if intended := misspelled_class(controller.type):
            yield MISSPELLED_CLASS.at(controller.source, "type", type=controller.type, intended=intended)
    sound = [one for one in controllers if not has_faulty_names(robot, one)]
    for controller in sound:
        yield from _check_gains(controller)
        yield from _check_fields(controller)
        yield from check_parameters(controller, controller.type or "", _joints(controller))
        yield from check_interfaces(robot, controller)
    has_states_alone = all(one.name == MANAGER for one in robot.controllers)
    commanding = [one for one in controllers if one.type != STATES]
    used = {name for one in commanding for name in _joints(one)}
    is_known = has_states_alone or all(one.type in KINDS for one in controllers)
    for joint in hardware.values() if is_known and sound == list(controllers) and not faulty_groups(robot) else ():
        if joint.name not in used:
            yield NO_CONTROLLER_FOR_JOINT.at(joint.source, joint=joint.name)


def _check_gains(controller: Controller) -> Iterator[Diagnostic]:
    """Report joints of a trajectory controller that nothing moves without gains."""
    commands, parameters = tuple(map(str, controller.command_interfaces)), controller.parameters
    is_open = commands == ("velocity",) and parameters.get("open_loop_control")
    if controller.type != TRAJECTORY or commands not in {("effort",), ("velocity",)} or is_open:
        return
    gains = parameters.get("gains")
    for joint in controller.joints:
        # A name with dots is nested maps.
        if not isinstance(gains, Mapping) or joint.partition(".")[0] not in gains:
            yield NO_GAINS.at(controller.source, controller=controller.name, joint=joint, interface=commands[0])


def _check_fields(controller: Controller) -> Iterator[Diagnostic]:
    """Report fields that a class needs, and those that it does not have."""
    kind, name = kind_of(controller.type), controller.name
    given = {parameter for field, parameter in kind.parameters.items() if getattr(controller, field)}
    given |= controller.parameters.keys()
    lacks = [one for one in kind.required if given.isdisjoint((one, kind.instead.get(one)))]
    if "joints" in kind.parameters and not controller.joints:
        # The interfaces follow from the joints.
        lacks = [one for one in lacks if not one.endswith(("_interfaces", "interface_name"))]
    for parameter in lacks:
        field = next((key for key, value in kind.parameters.items() if value == parameter), "")
        if _has_faulty_items(controller, field):
            continue
        way_out = f"`{field}`{_why(controller, field)}" if field else f"`{parameter}` in `parameters`"
        if parameter in kind.instead:
            way_out += f" or `{kind.instead[parameter]}` in `parameters`"
        yield CONTROLLER_LACKS.at(controller.source, controller=name, type=controller.type, parameter=way_out)
    if controller.type in KINDS:
        for field in PARAMETERS_OF_FIELDS:
            if field not in kind.parameters and getattr(controller, field):
                yield NOT_OF_CONTROLLER.at(controller.source, field, controller=name, type=controller.type, field=field)


def _has_faulty_items(controller: Controller, field: str) -> bool:
    """Return whether a field without value is written as a list with items, which are reported then."""
    node = controller.source.node.child(field) if controller.source else None
    return node is not None and node.child(0) is not None


def _why(controller: Controller, field: str) -> str:
    """Return why a field does not follow from the robot, "" where it never does."""
    if field == "joints" and controller.group:
        return f"; no joint of group '{controller.group}' has a command interface in `ros2_control`"
    if field.endswith("_interfaces") and len(controller.joints) > 1:
        return "; its joints have none in common"
    return ""


def _joints(controller: Controller) -> tuple[str, ...]:
    return tuple(name for field in JOINT_FIELDS for name in written_names(controller, field))
