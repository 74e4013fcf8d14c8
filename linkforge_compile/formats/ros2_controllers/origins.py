"""Where the values of controllers come from that the section `controllers` of a spec does not have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER, Controller
from linkforge_compile.core.models.controller_kinds import PARAMETERS_OF_FIELDS, path_of_field
from linkforge_compile.formats.ros2_controllers.complete import Completed, Derived, completed_controllers
from linkforge_compile.formats.ros2_controllers.limits import missing_hardware

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


def controllers_with_origins(robot: Robot) -> tuple[Completed, ...]:
    """Return the completed controllers, each with where its derived fields come from, and "" for a default one.

    There are none for a robot without hardware, for which there is no file of controllers.
    """
    if missing_hardware(robot):
        return ()
    are_stated = any(one.name != MANAGER for one in robot.controllers)
    return tuple(
        Completed(one.controller, {**_lifted(one.controller), **one.derived, **_of_default(one.controller, are_stated)})
        for one in completed_controllers(robot)
    )


def _of_default(controller: Controller, are_stated: bool) -> dict[str, Derived]:
    """Return where a controller itself comes from, unless the spec states it."""
    if are_stated:
        return {}
    subject = f"planning group '{controller.group}'" if controller.group else ""
    return {"": Derived((), "a default, because the spec has no `controllers`", subject, controller.source)}


def _lifted(controller: Controller) -> dict[str, Derived]:
    """Return where the fields that are parameters in the spec come from."""
    paths = {field: path_of_field(controller, field) for field in PARAMETERS_OF_FIELDS}
    return {
        field: Derived((), f"its parameter '{path[-1]}'", "the parameter", controller.source, path)
        for field, path in paths.items()
        if path != (field,)
    }
