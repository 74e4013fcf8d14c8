"""Controllers: the joints, groups, links and sensors that they name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.checks.names import Reference, report_unknown
from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.core.models.manager_parameters import (
    CONTROLLER,
    HARDWARE,
    SourcedText,
    is_name_of_controller,
    listed_names,
)
from linkforge_compile.diagnostics.codes.names import (
    UNKNOWN_GROUP,
    UNKNOWN_HARDWARE_SENSOR,
    UNKNOWN_JOINT,
    UNKNOWN_LINK,
    UNKNOWN_OF_MANAGER,
)

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
    from linkforge_compile.source import SourceRef

_JOINTS = ("joints", "left_wheels", "right_wheels")


def check_names_in_controllers(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The joints, the planning group, the sensor and the frame of a controller are of this robot.

    The controller manager refuses to start a controller with a joint or a sensor that no hardware has. Correct the
    name.
    """
    if not robot.controllers:
        return
    groups = [group.name for group in robot.semantic.groups] if robot.has_semantic else []
    yield from report_unknown(_references(robot, *_JOINTS), UNKNOWN_JOINT, robot.joints.names, unresolved)
    yield from report_unknown(_references(robot, "frame"), UNKNOWN_LINK, robot.links.names, unresolved)
    yield from report_unknown(_references(robot, "group"), UNKNOWN_GROUP, groups, unresolved, hint="")
    if robot.ros2_controls:
        # A gpio or a joint may have the interfaces of a sensor as well.
        sensors = [sensor.name for system in robot.ros2_controls for sensor in system.sensors]
        gpios = [gpio.name for system in robot.ros2_controls for gpio in system.gpios]
        known = [*sensors, *gpios, *robot.joints.names]
        references = _references(robot, "sensor")
        yield from report_unknown(references, UNKNOWN_HARDWARE_SENSOR, known, unresolved, offered=sensors)


def check_names_of_manager(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The hardware and the controllers in the parameters of the controller manager are of this robot.

    The controller manager logs a warning for unknown hardware, which it then activates as all others, and refuses to
    start a controller with an unknown one as its fallback. Correct the name.
    """
    manager = robot.controllers.get(MANAGER)
    if manager is None:
        return
    loaded = (name for name, value in manager.parameters.items() if is_name_of_controller(name, value))
    stated = [one.name for one in robot.controllers if one.name != MANAGER]
    known = {
        HARDWARE: [system.name for system in robot.ros2_controls],
        CONTROLLER: [*stated, *(name.partition(".")[0] for name in loaded)] if stated else [],
    }
    for kind, names in known.items():
        listed = [name for its, name in listed_names(manager.parameters) if its == kind]
        references = [Reference(name, "the controller manager", _source_of(name)) for name in listed]
        yield from report_unknown(references if names else (), UNKNOWN_OF_MANAGER, names, unresolved, kind=kind)


def _source_of(name: str) -> SourceRef | None:
    return name.source if isinstance(name, SourcedText) else None


def _references(robot: Robot, *keys: str) -> Iterator[Reference]:
    """Yield the names in some fields of the controllers: one, or a list of them."""
    for controller in robot.controllers:
        user = f"controller '{controller.name}'"
        for key in keys:
            value = getattr(controller, key)
            if isinstance(value, str):
                yield Reference(value, user, controller.source, (key,))
            else:
                places = enumerate(value or ())
                yield from (Reference(name, user, controller.source, (key, place)) for place, name in places)
