"""What a controller manager refuses of a robot's controllers, and joints that none of them commands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.diagnostics.codes.formats import (
    CONTROLLER_LACKS,
    NO_CONTROLLER_FOR_JOINT,
    NO_HARDWARE,
    NOT_OF_CONTROLLER,
    NOT_OF_HARDWARE,
)
from linkforge_compile.formats.ros2_controllers.complete import commanded_joints, complete_controllers
from linkforge_compile.formats.ros2_controllers.kinds import GRIPPERS, KINDS, TRAJECTORY, kind_of

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

_FIELDS = ("joints", "left_wheels", "right_wheels", "sensor", "frame", "command_interfaces", "state_interfaces")
_COMMANDED = ("joints", "left_wheels", "right_wheels")


def missing_hardware(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no controllers; None if it has some."""
    if robot.ros2_controls or robot.controllers:
        return None
    return NO_HARDWARE.at(robot.source, "name", robot=robot.name)


def check_controllers(robot: Robot) -> Iterator[Diagnostic]:
    """A controller has what its class needs and nothing else; each commanded joint has a controller."""
    controllers, hardware = complete_controllers(robot), commanded_joints(robot)
    for controller in controllers:
        yield from _check_parameters(controller)
        if controller.type in {TRAJECTORY, *GRIPPERS}:
            for place, name in enumerate(controller.joints):
                if name not in hardware and robot.has_joint(name):
                    yield NOT_OF_HARDWARE.at(controller.source, "joints", place, controller=controller.name, joint=name)
    has_states_alone = all(one.name == MANAGER for one in robot.controllers)
    used = {name for one in controllers for field in _COMMANDED for name in getattr(one, field)}
    is_known = all(one.type in KINDS for one in controllers)
    for joint in hardware.values() if is_known or has_states_alone else ():
        if joint.name not in used:
            yield NO_CONTROLLER_FOR_JOINT.at(joint.source, joint=joint.name)


def _check_parameters(controller: Controller) -> Iterator[Diagnostic]:
    kind, name = kind_of(controller.type), controller.name
    given = {kind.parameters[field] for field in _FIELDS if field in kind.parameters and getattr(controller, field)}
    for parameter in kind.required:
        if parameter not in given and parameter not in controller.parameters:
            field = next((key for key, value in kind.parameters.items() if value == parameter), "")
            way_out = f"`{field}`" if field else f"`{parameter}` in `parameters`"
            yield CONTROLLER_LACKS.at(controller.source, controller=name, type=controller.type, parameter=way_out)
    if controller.type in KINDS:
        for field in _FIELDS:
            if field not in kind.parameters and getattr(controller, field):
                yield NOT_OF_CONTROLLER.at(controller.source, field, controller=name, type=controller.type, field=field)
