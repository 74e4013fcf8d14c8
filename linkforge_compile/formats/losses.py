"""What formats of simulators leave out of a robot, and the losses of joints that they have in common."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import NamedTuple

from linkforge_compile.core.exceptions import FieldPath
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.formats.element import Extended, place_of_attribute, raw_texts
from linkforge_compile.formats.kinematic_tree import leader_of
from linkforge_compile.formats.parts import Held
from linkforge_compile.source import SourceRef


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


_RAW_XML = "raw XML of a URDF"

_WITHOUT_LOSS = ("xmlns", "quat_xyzw")
"""Raw attributes that only a URDF needs: namespaces, and a turn that `rpy` has as well."""


def lost_xml(robot: Robot, parts: Iterable[Held]) -> Iterator[Loss]:
    """Yield the first raw XML or attribute of the robot and of each part; `parts` has what is inside, too.

    What fixed joints have is an axis, limits or whether to keep the joint, none of which is a loss.
    """
    yield from _first(robot, robot.name, robot.source)
    for held in parts:
        if any(isinstance(part, Joint) and part.type == JointType.FIXED for part in (held.part, *held.around)):
            continue
        names = (getattr(part, "name", None) for part in (held.part, *reversed(held.around)))
        yield from _first(held.part, next(filter(None, names), robot.name), held.where)


def _first(part: Extended, name: str, where: SourceRef | None) -> Iterator[Loss]:
    for _, place, keys in raw_texts(part, where):
        yield Loss(_RAW_XML, name, place, keys)
        return
    for attribute, _ in attribute_pairs(part.extra_attributes):
        if not attribute.startswith(_WITHOUT_LOSS):
            source, *path = place_of_attribute(attribute, where)
            yield Loss(_RAW_XML, name, source, (*path, attribute))
            return
