"""The interfaces of joints that controllers claim and `ros2_control` does not have."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.controller import JOINT_FIELDS
from linkforge_compile.core.models.controller_kinds import KINDS, path_of_field, written_names
from linkforge_compile.diagnostics.codes.formats import NOT_OF_HARDWARE

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.ros2_control import Ros2ControlJoint
    from linkforge_compile.diagnostics import Diagnostic


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
