"""Controllers: the joints, groups, links and sensors that they name."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from linkforge_compile.checks.names import Reference, report_unknown
from linkforge_compile.core.models.controller import (
    CONTROLLER,
    DEFAULT_BROADCASTER,
    DEFAULT_TRAJECTORY,
    HARDWARE,
    JOINT_FIELDS,
    MANAGER,
    default_name,
    is_of_controller,
    listed_names,
)
from linkforge_compile.core.models.controller_kinds import lift_parameters, path_of_field
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import SourcedText
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import (
    UNKNOWN_GROUP,
    UNKNOWN_HARDWARE_SENSOR,
    UNKNOWN_JOINT,
    UNKNOWN_LINK,
    UNKNOWN_OF_MANAGER,
)
from linkforge_compile.source import SourceRef


def check_names_in_controllers(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The joints, the planning group, the sensor and the frame of a controller are of this robot.

    The controller manager refuses to start a controller with a joint or a sensor that no hardware has. Correct the
    name.
    """
    if not robot.controllers:
        return
    groups = [group.name for group in robot.semantic.groups] if robot.has_semantic else []
    joints, links = robot.joints.names, robot.links.names
    yield from report_unknown(_references(robot, *JOINT_FIELDS, known=joints), UNKNOWN_JOINT, joints, unresolved)
    yield from report_unknown(_references(robot, "frame", known=links), UNKNOWN_LINK, links, unresolved)
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
    loaded = [name for name, value in manager.parameters.items() if is_of_controller(value)]
    groups = [group.name for group in robot.semantic.groups] if robot.has_semantic else []
    defaults = (DEFAULT_BROADCASTER, DEFAULT_TRAJECTORY, *map(default_name, groups))
    stated = [one.name for one in robot.controllers if one.name != MANAGER]
    known = {
        HARDWARE: [system.name for system in robot.ros2_controls],
        CONTROLLER: [*(stated or defaults), *loaded],
    }
    for kind, names in known.items():
        listed = [name for its, name in listed_names(manager.parameters) if its == kind]
        references = [Reference(name, "the controller manager", _source_of(name)) for name in listed]
        yield from report_unknown(references if names else (), UNKNOWN_OF_MANAGER, names, unresolved, kind=kind)


def _source_of(name: str) -> SourceRef | None:
    return name.source if isinstance(name, SourcedText) else None


def _references(robot: Robot, *fields: str, known: Collection[str] = ()) -> Iterator[Reference]:
    """Yield the names in some fields of the controllers: one, or a list of them.

    Without those in `parameters` that lack the prefix of their module, which are reported where it gets the prefix:
    with it, they are `known`.
    """
    for controller in map(lift_parameters, robot.controllers):
        user = f"controller '{controller.name}'"
        prefix = Reference(controller.name, "", controller.source).prefix
        for field in fields:
            value, path = getattr(controller, field), path_of_field(controller, field)
            is_field = path == (field,) or not prefix
            if isinstance(value, str):
                references = [Reference(value, user, controller.source, path)]
            else:
                places = enumerate(value or ())
                references = [Reference(name, user, controller.source, (*path, place)) for place, name in places]
            yield from (one for one in references if is_field or prefix + one.name not in known)
