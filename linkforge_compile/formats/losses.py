"""What formats of simulators leave out of a robot, and the losses of joints that they have in common."""

from __future__ import annotations

from collections.abc import Container, Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.exceptions import FieldPath
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.formats.single_axis import leader_of
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


class Loss(NamedTuple):
    """What kind of part is omitted, the name of the part that has it, and its place."""

    parts: str
    name: str
    source: SourceRef | None
    path: FieldPath = ()


def joint_losses(joint: Joint, robot: Robot, *, loose: Container[str]) -> Iterator[Loss]:
    """Yield what no simulator has of a joint; `loose` are the types that have neither limits nor dynamics there."""
    limits, dynamics = joint.limits, joint.dynamics
    if joint.safety_controller:
        yield Loss("safety controllers", joint.name, joint.source, ("safety_controller",))
    if joint.calibration:
        yield Loss("calibrations", joint.name, joint.source, ("calibration",))
    if joint.mimic and robot.has_joint(joint.mimic.joint) and leader_of(joint, robot) is None:
        yield Loss("mimic with a joint of other than one axis", joint.name, joint.mimic.source or joint.source)
    if joint.type in loose and limits:
        yield Loss(f"limits of {joint.type} joints", joint.name, limits.source or joint.source)
    if joint.type in loose and dynamics and (dynamics.damping or dynamics.friction):
        yield Loss(f"dynamics of {joint.type} joints", joint.name, dynamics.source or joint.source)
