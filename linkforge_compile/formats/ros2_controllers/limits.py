"""What a controller manager refuses of a robot's controllers, and joints that none of them commands."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.controller import JOINT_FIELDS, MANAGER, Controller
from linkforge_compile.core.models.controller_kinds import (
    KINDS,
    PARAMETERS_OF_FIELDS,
    STATES,
    TRAJECTORY,
    kind_of,
    path_of_field,
    stated_field,
    written_names,
)
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2ControlJoint
from linkforge_compile.core.part import place_of_parameter, place_of_parameter_name
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import (
    CONTROLLER_LACKS,
    LIST_OF_SEVERAL_TYPES,
    MISSPELLED_CLASS,
    NO_CONTROLLER_FOR_JOINT,
    NO_GAINS,
    NO_NAME_OF_A_NODE,
    NOT_OF_CONTROLLER,
    NOT_OF_HARDWARE,
    ONE_OF_SEVERAL,
    STATED_TWICE,
    UNKNOWN_PARAMETER,
    WRONG_PARAMETER,
)
from linkforge_compile.formats.groups import faulty_groups
from linkforge_compile.formats.ros2_controllers.complete import (
    commanded_joints,
    complete_controllers,
    has_faulty_names,
    misspelled_class,
)
from linkforge_compile.formats.ros2_controllers.parameters import PARAMETERS, find_misfits
from linkforge_compile.formats.ros2_controllers.view import typed_parameters
from linkforge_compile.source import Key


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


_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
"""The names of nodes that rmw accepts."""


def check_refused(robot: Robot, completed: Iterable[Controller]) -> Iterator[Diagnostic]:
    """ROS 2 reads the names and parameters of all controllers, which are written as the spec states them."""
    for controller in robot.controllers:
        yield from check_lists(controller)
        if controller.name != MANAGER:
            yield from _check_stated_once(controller)
    manager = robot.controllers.get(MANAGER)
    for controller in completed:
        yield from _check_name(controller)
        if manager:
            yield from _check_names_of_values(manager, controller)
            yield from _check_loaded_class(manager, controller)
        if not has_faulty_names(robot, controller):
            yield from _check_single_fields(controller)


def _check_name(controller: Controller) -> Iterator[Diagnostic]:
    """The name of a controller is that of its node."""
    if not _NODE.fullmatch(controller.name):
        yield NO_NAME_OF_A_NODE.at(controller.source, controller=controller.name)


def _check_single_fields(controller: Controller) -> Iterator[Diagnostic]:
    """A field of which a class has one name, such as the joint of a gripper, has no others."""
    for field in sorted(kind_of(controller.type).single):
        first, *others = getattr(controller, field) or ("",)
        for place, item in enumerate(others, start=1):
            if item == first:
                continue  # LF4160
            facts = {"type": controller.type, "field": field, "item": item, "controller": controller.name}
            yield ONE_OF_SEVERAL.at(controller.source, *path_of_field(controller, field), place, **facts)


def _check_stated_once(controller: Controller) -> Iterator[Diagnostic]:
    """A field is not a parameter as well, of which one would have no effect."""
    for field, name in kind_of(controller.type).parameters.items():
        stated = stated_field(controller, field)
        if stated and name in controller.parameters:
            notes = [Note(f"`{stated}` is here", controller.source.at(stated))] if controller.source else []
            facts = {"controller": controller.name, "parameter": name, "owner": "", "conflict": _and_field(stated)}
            yield STATED_TWICE.at(controller.source, "parameters", Key(name), notes=notes, **facts)


def _and_field(field: str) -> str:
    return f"and `{field}` for the same; remove one of them"


def _check_names_of_values(manager: Controller, controller: Controller) -> Iterator[Diagnostic]:
    """The manager has a map under the name of a controller, and no value, for which there is no place in the file."""
    for key, value in manager.parameters.items():
        if key == controller.name and value is not None and not isinstance(value, Mapping):
            notes = [Note("the controller is here", controller.source.span)] if controller.source else []
            place = place_of_parameter(manager.source, "parameters", key)
            conflict = "which is a value and no map of its parameters; remove it, or rename the controller"
            owner = f" of '{MANAGER}'"
            yield STATED_TWICE.at(*place, notes=notes, controller=key, parameter=key, owner=owner, conflict=conflict)


def _check_loaded_class(manager: Controller, controller: Controller) -> Iterator[Diagnostic]:
    """The class of a controller is not another one in the parameters of the manager."""
    stated = manager.parameters.get(controller.name)
    for key, value in stated.items() if isinstance(stated, Mapping) else ():
        if key == "type" and value != controller.type:
            notes = [Note("`type` is here", controller.source.at("type"))] if controller.source else []
            place = place_of_parameter(manager.source, "parameters", controller.name, key)
            owner, conflict = f" of '{MANAGER}'", _and_field("type")
            yield STATED_TWICE.at(
                *place, notes=notes, controller=controller.name, parameter="type", owner=owner, conflict=conflict
            )


def check_parameters(controller: Controller, declared_by: str, named: Iterable[str]) -> Iterator[Diagnostic]:
    """Report the parameters that a class does not declare, or declares with another type."""
    owner = "the controller manager" if declared_by == MANAGER else f"a {declared_by}"
    declared = PARAMETERS.get(declared_by)
    misfits = find_misfits(controller.parameters, declared, named) if declared is not None else ()
    for path, expected, value, near in misfits:
        if isinstance(value, list | tuple) and not _has_one_type(value):
            continue  # an error by itself
        *outer, name = path
        if expected is None:
            inside = f" in '{'.'.join(outer)}'" if outer else ""
            place = place_of_parameter_name(controller.source, "parameters", *path)
            yield UNKNOWN_PARAMETER.at(*place, name=name, owner=owner, inside=inside, near=near)
        else:
            name, found = ".".join(path), _shown(value)
            place = place_of_parameter(controller.source, "parameters", *path)
            yield WRONG_PARAMETER.at(*place, name=name, owner=owner, expected=expected, found=found)


def _shown(value: object) -> str:
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value) if isinstance(value, int | float) else "a map" if isinstance(value, Mapping) else "a list"


def check_lists(controller: Controller) -> Iterator[Diagnostic]:
    """A list has items of one type, and no lists or maps: the parser of rcl refuses the whole file."""
    for path, value in _values(typed_parameters(controller), ()):
        if isinstance(value, list) and not _has_one_type(value):
            place, name = place_of_parameter(controller.source, "parameters", *path), ".".join(path)
            yield LIST_OF_SEVERAL_TYPES.at(*place, controller=controller.name, parameter=name)


def _has_one_type(items: Sequence[object]) -> bool:
    """Whether a list is one that ROS 2 has a type for."""
    integers = all(isinstance(item, int) and not isinstance(item, bool) for item in items)
    return integers or any(all(isinstance(item, type_) for item in items) for type_ in (str, bool, float))


def _values(parameters: Mapping[str, object], path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], object]]:
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            yield from _values(value, (*path, name))
        else:
            yield (*path, name), value


class _Claim(NamedTuple):
    """The "command" or "state" interfaces that a controller claims of each of its joints.

    `is_stated` is whether its field for them has them; otherwise they follow from its class.
    """

    what: str
    names: tuple[str, ...]
    is_stated: bool

    @property
    def field(self) -> str:
        return f"{self.what}_interfaces"

    def of_joint(self, joint: Ros2ControlJoint | None) -> tuple[str, ...]:
        return tuple(map(str, getattr(joint, self.field))) if joint else ()


def check_interfaces(robot: Robot, controller: Controller) -> Iterator[Diagnostic]:
    """The joints of a controller of a known class have the interfaces that it claims."""
    hardware = {joint.name: joint for system in robot.ros2_controls for joint in system.joints}
    joints: list[tuple[tuple[str | int, ...], str]] = [
        ((*path_of_field(controller, field), place), name)
        for field in JOINT_FIELDS
        for place, name in enumerate(written_names(controller, field))
    ]
    for claim in _claims(controller):
        for place, name in joints:
            yield from _check_joint(controller, claim, name, place, claim.of_joint(hardware.get(name)))


def _claims(controller: Controller) -> Iterator[_Claim]:
    """Yield what a controller of a known class claims; not what its `parameters` have, or other controllers."""
    kind = KINDS.get(controller.type or "")
    for what, by_class in (("command", kind.commands), ("state", kind.states)) if kind else ():
        stated = written_names(controller, f"{what}_interfaces")
        parameter = kind.parameters.get(f"{what}_interfaces") if kind else None
        is_elsewhere = parameter in controller.parameters or "command_joints" in controller.parameters
        if not is_elsewhere and (stated or by_class or (parameter and what == "command")):
            yield _Claim(what, stated or by_class, bool(stated))


def _check_joint(
    controller: Controller, claim: _Claim, joint: str, place: tuple[str | int, ...], own: tuple[str, ...]
) -> Iterator[Diagnostic]:
    """Report the interfaces that a joint lacks: at their names in the controller, or at the joint."""
    source, name = controller.source, controller.name
    if claim.what == "command" and not own:
        yield NOT_OF_HARDWARE.at(source, *place, controller=name, joint=joint, what="command interface")
        return
    for index, interface in enumerate(claim.names):
        if interface not in own:
            where: tuple[str | int, ...] = (
                (*path_of_field(controller, claim.field), index) if claim.is_stated else place
            )
            what = f"{claim.what} interface '{interface}'"
            facts = {"controller": name, "joint": joint, "what": what, "name": interface}
            yield NOT_OF_HARDWARE.at(source, *where, near=own, notes=(), **facts)
