"""Where the values of controllers come from that the section `controllers` of a spec does not have."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.controller import MANAGER, Controller
from linkforge_compile.core.models.controller_kinds import PARAMETERS_OF_FIELDS, path_of_field
from linkforge_compile.formats.ros2_controllers.complete import Completed, completed_controllers
from linkforge_compile.formats.ros2_controllers.limits import missing_hardware

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.source import SourceRef


class Origin(NamedTuple):
    """Where a value was written, as a path below a source, or what it follows from.

    `why` it follows from the part `subject`, which was written there; "" for a value that was written itself.
    """

    why: str
    subject: str
    source: SourceRef | None
    path: tuple[str, ...] = ()


class Explained(NamedTuple):
    """A controller with all of its fields, and the origins of those that are not at their places, by name.

    The one of "" is that of a default controller as a whole.
    """

    controller: Controller
    origins: Mapping[str, Origin]


def explained_controllers(robot: Robot) -> tuple[Explained, ...]:
    """Return the controllers of the outputs; none for a robot without hardware, for which there is no file of them."""
    if missing_hardware(robot):
        return ()
    are_stated = any(one.name != MANAGER for one in robot.controllers)
    return tuple(Explained(one.controller, _origins(one, are_stated)) for one in completed_controllers(robot))


def _origins(completed: Completed, are_stated: bool) -> dict[str, Origin]:
    controller = completed.controller
    origins = {
        field: Origin(each.why, each.subject, each.source, each.path) for field, each in completed.derived.items()
    }
    if not are_stated:
        subject = f"planning group '{controller.group}'" if controller.group else ""
        why = "a default, because the spec has no `controllers`"
        origins[""] = Origin(why, subject, controller.source)
    return {**_of_parameters(controller), **origins}


def _of_parameters(controller: Controller) -> dict[str, Origin]:
    """Return where the fields were written that are parameters in the spec."""
    paths = {field: path_of_field(controller, field) for field in PARAMETERS_OF_FIELDS}
    return {field: Origin("", "", controller.source, path) for field, path in paths.items() if path != (field,)}
