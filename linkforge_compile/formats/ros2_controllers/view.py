"""The controllers that the template of controllers.yaml lays out."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from linkforge_compile.core.models.controller import MANAGER, Controller
from linkforge_compile.core.models.controller_kinds import kind_of, path_of_field
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import place_of_parameter
from linkforge_compile.formats.element import placed
from linkforge_compile.formats.ros2_controllers.complete import Completed, completed_controllers
from linkforge_compile.formats.ros2_controllers.parameters import ANY, PARAMETERS, Type, convert, names_below, type_of
from linkforge_compile.formats.views import View
from linkforge_compile.source import SourceRef

UPDATE_RATE = 100
"""The rate of a controller manager [Hz] that is not stated; its own default."""


def controllers_view(robot: Robot) -> View:
    """Return what templates see: the parameters of the manager, and the controllers with `type` and `parameters`.

    What the manager has of a controller is in `manager_parameters` of that one, without its type.
    """
    manager = robot.controllers.get(MANAGER)
    stated = typed_parameters(manager) if manager else {}
    controllers = [_view(one, stated.get(one.controller.name)) for one in completed_controllers(robot)]
    elsewhere = {one.name for one in controllers}
    own = {key: value for key, value in stated.items() if key not in elsewhere}
    return View(
        manager=own if "update_rate" in own else {"update_rate": UPDATE_RATE, **own},
        controllers=controllers,
    )


def _view(completed: Completed, of_manager: object) -> View:
    controller, _ = completed
    in_manager = of_manager if isinstance(of_manager, Mapping) else {}
    parameters = {**dict(_of_fields(completed)), **typed_parameters(controller)}
    return View(
        name=placed(controller.name, controller.source),
        type=placed(controller.type or "", controller.source, "type"),
        parameters=parameters,
        manager_parameters={key: value for key, value in in_manager.items() if key != "type"},
    )


def _of_fields(completed: Completed) -> Iterator[tuple[str, object]]:
    """Yield the parameters that the fields of a controller become."""
    controller, derived = completed
    kind = kind_of(controller.type)
    for field, name in kind.parameters.items():
        value = getattr(controller, field)
        if value:
            is_list = not isinstance(value, str)
            written = value[0] if is_list and field in kind.single else list(value) if is_list else value
            if origin := derived.get(field):
                yield placed(name, origin.source, *origin.path), written
            else:
                yield placed(name, controller.source, *path_of_field(controller, field)), written


def typed_parameters(controller: Controller) -> dict[str, object]:
    """Return the parameters; where the type of one is known, quantities in SI units and numbers with decimals."""
    values = _placed(controller.parameters, controller.source, "parameters")
    declared = PARAMETERS.get(MANAGER if controller.name == MANAGER else controller.type or "")
    return values if declared is None else _converted(values, declared, controller.joints)


def _converted(values: dict[str, object], declared: Mapping[str, Type], joints: Collection[str]) -> dict[str, object]:
    converted: dict[str, object] = {}
    for name, value in values.items():
        type_ = type_of(name, declared, (*joints, *values)) or ANY
        if isinstance(type_, str):
            converted[name] = convert(value, type_)
        else:
            inner = (*joints, *names_below(name, joints))
            converted[name] = _converted(value, type_, inner) if isinstance(value, dict) else value
    return converted


def _placed(values: Mapping[str, object], source: SourceRef | None, *path: str) -> dict[str, object]:
    """Return parameters with the places of their names; lists have items of one type, and nothing is null."""
    found: dict[str, object] = {}
    for name, value in values.items():
        if isinstance(value, Mapping):
            if value:
                found[placed(name, *place_of_parameter(source, *path, name))] = _placed(value, source, *path, name)
        elif value is not None:
            found[placed(name, *place_of_parameter(source, *path, name))] = _of_one_type(value)
    return found


def _of_one_type(value: object) -> object:
    """Return a list of integers and doubles with doubles alone; anything else as it is."""
    if not isinstance(value, list | tuple):
        return value
    is_mixed = any(isinstance(item, float) for item in value)
    return [
        float(item) if is_mixed and isinstance(item, int) and not isinstance(item, bool) else item for item in value
    ]
