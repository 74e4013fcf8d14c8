"""Controllers: the joints, groups, links and sensors that they name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.checks.names import Reference, report_unknown
from linkforge_compile.diagnostics.codes.names import (
    UNKNOWN_GROUP,
    UNKNOWN_HARDWARE_SENSOR,
    UNKNOWN_JOINT,
    UNKNOWN_LINK,
)

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames

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
