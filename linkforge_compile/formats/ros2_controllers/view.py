"""The controllers that the template of controllers.yaml lays out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.formats.element import placed
from linkforge_compile.formats.ros2_controllers.complete import complete_controllers
from linkforge_compile.formats.ros2_controllers.kinds import kind_of
from linkforge_compile.formats.views import View
from linkforge_compile.units import parse_quantity

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.ros2_controllers.kinds import Kind
    from linkforge_compile.source import SourceRef

UPDATE_RATE = 100
"""The rate of a controller manager [Hz] that is not stated; its own default."""


def controllers_view(robot: Robot) -> View:
    """Return what templates see: the parameters of the manager, and the controllers with `type` and `parameters`."""
    manager = robot.controllers.get(MANAGER)
    stated = _placed(manager.parameters, manager.source, "parameters") if manager else {}
    return View(
        manager={"update_rate": UPDATE_RATE} | stated,
        controllers=[_view(one) for one in complete_controllers(robot)],
    )


def _view(controller: Controller) -> View:
    kind = kind_of(controller.type)
    parameters = {**dict(_of_fields(controller, kind)), **_typed(controller, kind)}
    return View(
        name=placed(controller.name, controller.source),
        type=placed(controller.type or "", controller.source, "type"),
        parameters=parameters,
    )


def _of_fields(controller: Controller, kind: Kind) -> Iterator[tuple[str, object]]:
    """Yield the parameters that the fields of a controller become."""
    for field, name in kind.parameters.items():
        value = getattr(controller, field)
        if value:
            is_list = not isinstance(value, str)
            written = value[0] if is_list and field in kind.single else list(value) if is_list else value
            yield placed(name, controller.source, field), written


def _typed(controller: Controller, kind: Kind) -> dict[str, object]:
    """Return the parameters; for a class that is known, quantities in SI units, and decimals where it expects them."""
    values = _placed(controller.parameters, controller.source, "parameters")
    whole = kind.whole
    return values if whole is None else {name: _number(value, name in whole) for name, value in values.items()}


def _number(value: object, is_whole: bool) -> object:
    if isinstance(value, int) and not isinstance(value, bool):
        return value if is_whole else float(value)
    if isinstance(value, str) and (quantity := parse_quantity(value)):
        return quantity.value
    if isinstance(value, dict):
        return {key: _number(item, is_whole) for key, item in value.items()}
    if isinstance(value, list):
        return [_number(item, is_whole) for item in value]
    return value


def _placed(values: Mapping[str, object], source: SourceRef | None, *path: str) -> dict[str, object]:
    """Return parameters with the places of their names; lists have items of one type, and nothing is null."""
    found: dict[str, object] = {}
    for name, value in values.items():
        if isinstance(value, Mapping):
            if value:
                found[placed(name, source, *path, name)] = _placed(value, source, *path, name)
        elif value is not None:
            found[placed(name, source, *path, name)] = _of_one_type(value)
    return found


def _of_one_type(value: object) -> object:
    """Return a list of whole numbers and others with decimals alone; anything else as it is."""
    if not isinstance(value, list | tuple):
        return value
    is_mixed = any(isinstance(item, float) for item in value)
    return [
        float(item) if is_mixed and isinstance(item, int) and not isinstance(item, bool) else item for item in value
    ]
