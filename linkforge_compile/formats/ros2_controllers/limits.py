"""What a controller manager refuses of a robot's controllers, and joints that none of them commands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.diagnostics.codes.formats import (
    CONTROLLER_LACKS,
    MISSPELLED_CLASS,
    NO_CONTROLLER_FOR_JOINT,
    NO_GAINS,
    NO_HARDWARE,
    NOT_OF_CONTROLLER,
    UNKNOWN_PARAMETER,
    WRONG_PARAMETER,
)
from linkforge_compile.formats.groups import faulty_groups
from linkforge_compile.formats.ros2_controllers.complete import (
    commanded_joints,
    complete_controllers,
    has_faulty_names,
)
from linkforge_compile.formats.ros2_controllers.interfaces import check_interfaces
from linkforge_compile.formats.ros2_controllers.kinds import (
    JOINT_FIELDS,
    KINDS,
    STATES,
    TRAJECTORY,
    kind_of,
    misspelled_class,
)
from linkforge_compile.formats.ros2_controllers.parameters import PARAMETERS, find_misfits
from linkforge_compile.formats.ros2_controllers.refused import check_refused, has_one_type
from linkforge_compile.formats.ros2_controllers.view import place_of, place_of_key

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

_FIELDS = ("joints", "left_wheels", "right_wheels", "sensor", "frame", "command_interfaces", "state_interfaces")


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
        loaded = (name for name, value in manager.parameters.items() if isinstance(value, Mapping) and "type" in value)
        yield from _check_types(manager, MANAGER, {*loaded, *(one.name for one in controllers)})
    sound = [one for one in controllers if not has_faulty_names(robot, one)]
    for controller in sound:
        yield from _check_class(controller)
        yield from _check_parameters(controller)
        yield from _check_types(controller, controller.type or "", _joints(controller))
        yield from check_interfaces(robot, controller)
    has_states_alone = all(one.name == MANAGER for one in robot.controllers)
    commanding = [one for one in controllers if one.type != STATES]
    used = {name for one in commanding for name in _joints(one)}
    is_known = has_states_alone or all(one.type in KINDS for one in controllers)
    for joint in hardware.values() if is_known and sound == list(controllers) and not faulty_groups(robot) else ():
        if joint.name not in used:
            yield NO_CONTROLLER_FOR_JOINT.at(joint.source, joint=joint.name)


def _check_class(controller: Controller) -> Iterator[Diagnostic]:
    """Report a misspelled class, and joints of a trajectory controller that nothing moves without gains."""
    if intended := misspelled_class(controller.type):
        yield MISSPELLED_CLASS.at(controller.source, "type", type=controller.type, intended=intended)
    commands, parameters = tuple(map(str, controller.command_interfaces)), controller.parameters
    is_open = commands == ("velocity",) and parameters.get("open_loop_control")
    if controller.type != TRAJECTORY or commands not in {("effort",), ("velocity",)} or is_open:
        return
    gains = parameters.get("gains")
    with_gains = {name.split(".")[0] for name in gains} if isinstance(gains, Mapping) else set()
    dotted = {name.split(".")[1] for name in parameters if name.startswith("gains.")}
    for joint in controller.joints:
        if joint not in with_gains | dotted:
            yield NO_GAINS.at(controller.source, controller=controller.name, joint=joint, interface=commands[0])


def _check_parameters(controller: Controller) -> Iterator[Diagnostic]:
    kind, name = kind_of(controller.type), controller.name
    given = {kind.parameters[field] for field in _FIELDS if field in kind.parameters and getattr(controller, field)}
    given |= controller.parameters.keys()
    lacks = [one for one in kind.required if given.isdisjoint((one, kind.instead.get(one)))]
    if kind.parameters.get("joints") in lacks:
        # The interfaces follow from the joints.
        lacks = [one for one in lacks if not one.endswith(("_interfaces", "interface_name"))]
    for parameter in lacks:
        field = next((key for key, value in kind.parameters.items() if value == parameter), "")
        way_out = f"`{field}`{_why(controller, field)}" if field else f"`{parameter}` in `parameters`"
        if parameter in kind.instead:
            way_out += f" or `{kind.instead[parameter]}` in `parameters`"
        yield CONTROLLER_LACKS.at(controller.source, controller=name, type=controller.type, parameter=way_out)
    if controller.type in KINDS:
        for field in _FIELDS:
            if field not in kind.parameters and getattr(controller, field):
                yield NOT_OF_CONTROLLER.at(controller.source, field, controller=name, type=controller.type, field=field)


def _why(controller: Controller, field: str) -> str:
    """Return why a field does not follow from the robot, "" where it never does."""
    if field == "joints" and controller.group:
        return f"; no joint of group '{controller.group}' has a command interface in `ros2_control`"
    if field.endswith("_interfaces") and len(controller.joints) > 1:
        return "; its joints have none in common"
    return ""


def _check_types(controller: Controller, declared_by: str, named: Iterable[str]) -> Iterator[Diagnostic]:
    """Report the parameters that a class does not declare, or declares with another type."""
    owner = "the controller manager" if declared_by == MANAGER else f"a {declared_by}"
    declared = PARAMETERS.get(declared_by)
    misfits = find_misfits(controller.parameters, declared, named) if declared is not None else ()
    for path, expected, value, near in misfits:
        if isinstance(value, list | tuple) and not has_one_type(value):
            continue  # an error by itself
        *outer, name = path
        if expected is None:
            inside = f" in '{'.'.join(outer)}'" if outer else ""
            place = place_of_key(controller.source, "parameters", *path)
            yield UNKNOWN_PARAMETER.at(*place, name=name, owner=owner, inside=inside, near=near)
        else:
            name, found = ".".join(path), _shown(value)
            place = place_of(controller.source, "parameters", *path)
            yield WRONG_PARAMETER.at(*place, name=name, owner=owner, expected=expected, found=found)


def _joints(controller: Controller) -> tuple[str, ...]:
    """Return the joints of a controller, wheels and those that are a parameter as well."""
    stated = controller.parameters.get("joints")
    fields = (name for field in JOINT_FIELDS for name in getattr(controller, field))
    return (*fields, *map(str, stated if isinstance(stated, list | tuple) else ()))


def _shown(value: object) -> str:
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value) if isinstance(value, int | float) else "a map" if isinstance(value, Mapping) else "a list"
