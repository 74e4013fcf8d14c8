"""Joints: what their type lets them say, in the dimensions of their motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.constants import EPSILON, UNKNOWN
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.joint import (
    HAVE_NO_AXIS,
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.diagnostics.codes.model import (
    JOINT_TO_ITSELF,
    LIMITS_CROSSED,
    NOT_OF_THIS_TYPE,
    UNKNOWN_AXIS,
    ZERO_AXIS,
)
from linkforge_compile.lower.elements import E, lower_element, lower_fields, stated_numbers
from linkforge_compile.lower.extra import besides
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.quantities import (
    ANGLE_OR_LENGTH,
    BARE,
    Measure,
    found,
    measure_of,
)
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlScalar
from linkforge_compile.units import POSITION, Motion

_LIMITS_EXAMPLE = {
    JointType.REVOLUTE: "{lower: -90 deg, upper: 90 deg, effort: 50 N*m, velocity: 90 deg/s}",
    JointType.PRISMATIC: "{lower: 0, upper: 100 mm, effort: 50 N, velocity: 0.2 m/s}",
}
# What stands in for what is faulty, which has been told: the joint stays, so that its ends and the tree are judged.
# Nothing of it is ever written: a compile that told an error gives no robot.
_STAND_IN_TYPE = JointType.REVOLUTE
_STAND_IN_AXIS = Vector3(0.0, 0.0, 1.0)
_STAND_IN_LIMITS = JointLimits(-UNKNOWN, UNKNOWN, 1.0, 1.0)

_AXES = {
    "x": Vector3(1.0, 0.0, 0.0),
    "y": Vector3(0.0, 1.0, 0.0),
    "z": Vector3(0.0, 0.0, 1.0),
    "-x": Vector3(-1.0, 0.0, 0.0),
    "-y": Vector3(0.0, -1.0, 0.0),
    "-z": Vector3(0.0, 0.0, -1.0),
}


def position_measure(joint: Joint | None) -> Measure:
    """Return what a position of a joint is measured in: an angle, a length, or either where its type is not known."""
    if joint is None or joint.limits == _STAND_IN_LIMITS:
        return ANGLE_OR_LENGTH
    return _position_measure(joint.type)


def _position_measure(kind: JointType | None) -> Measure:
    motion = kind.motion if kind else Motion.UNKNOWN
    return measure_of(POSITION, None, Motion.UNKNOWN if motion is Motion.OTHER else motion)


def joints_of(file: YamlMap) -> Mapping[str, YamlMap]:
    """Return the joints that a file itself writes, by name: its `joints`, and the one by which it hangs."""
    sections = [section for name in ("joints", "mount") if isinstance(section := file.get(name), YamlMap)]
    entries = (entry for section in sections for entry in section)
    return {entry.name: entry.value for entry in entries if isinstance(entry.value, YamlMap)}


def positions_of_type(joint: Located | None) -> Measure:
    """Return what a position of a joint that is written somewhere is measured in; see `position_measure`."""
    kind = joint.child("type") if joint else None
    known = {str(each): each for each in JointType}
    return _position_measure(known.get(kind.text) if isinstance(kind, YamlScalar) else None)


class Ends(NamedTuple):
    """What a joint joins: its links, None for one whose fault was told, and the pose of the child in the parent."""

    parent: str | None
    child: str | None
    origin: Transform


def lower_joints(file: Fields) -> Iterator[tuple[str, Joint | None]]:
    """Lower the joints of a file, None for one that is lost."""
    links = file.node.get("links")
    names = tuple(links.entries) if isinstance(links, YamlMap) else ()
    return file.each("joints", "joint", lambda fields, name: _joint(fields, name, names))


def read_joint_of_any_type(fields: Fields, name: str) -> None:
    """Read what a joint may say of its motion, for what there is to tell of it where its type may not be known."""
    joint_type = fields.choice("type", JointType)
    motion = joint_type.motion if joint_type else Motion.UNKNOWN
    fields.origin()
    _axis(fields, joint_type)
    _limits(fields, joint_type, motion)
    for part in (JointDynamics, JointSafetyController, JointCalibration):
        _part(fields, part, motion)
    _mimic(fields, motion)


def _joint(fields: Fields, name: str, links: Sequence[str]) -> Joint | None:
    """Lower one joint; of the file's `links`, one that it may hang on is the example where it says none."""
    valid_name = name if fields.name_is_valid(name, "joint") else None
    joint_type = fields.choice("type", JointType, required="revolute")
    base = _some_base(fields, links) if fields.said("parent") is None else ""
    ends = Ends(fields.text("parent", required=base), fields.text("child", required="arm"), fields.origin())
    return joint_between(fields, valid_name, joint_type, ends)


def _some_base(fields: Fields, links: Sequence[str]) -> str:
    child = fields.said("child")
    held = child.text if isinstance(child, YamlScalar) else None
    return next((link for link in links if link != held), "base")


def joint_between(fields: Fields, name: str | None, joint_type: JointType | None, ends: Ends) -> Joint | None:
    """Lower what makes a joint of two links; None for one that is lost.

    Name, type and links are None where their fault has been told. All that is left is read before the joint is
    given up, so that every fault of it is told; without a type, nothing else can be read.
    """
    if joint_type is None:
        return _joint_of_no_type(fields, name, ends)
    motion = joint_type.motion
    axis, axis_as_written = _axis(fields, joint_type)
    limits = _limits(fields, joint_type, motion)
    dynamics, mimic = _part(fields, JointDynamics, motion), _mimic(fields, motion)
    safety, calibration = _part(fields, JointSafetyController, motion), _part(fields, JointCalibration, motion)
    parent, child, origin = ends
    if name is None or parent is None or child is None:
        return None
    if parent == child:
        fields.tell(JOINT_TO_ITSELF, fields.node.get("child") or fields.ref, owner=fields.title, link=child)
        return None
    return fields.build(
        lambda: Joint(
            name,
            joint_type,
            parent,
            child,
            origin,
            axis,
            limits,
            dynamics,
            mimic,
            safety,
            calibration,
            axis_as_written=axis_as_written,
            **besides(fields),
        )
    )


def _joint_of_no_type(fields: Fields, name: str | None, ends: Ends) -> Joint | None:
    parent, child, origin = ends
    if name is None or parent is None or child is None or parent == child:
        return None
    return fields.build(
        lambda: Joint(name, _STAND_IN_TYPE, parent, child, origin, _STAND_IN_AXIS, _STAND_IN_LIMITS, source=fields.ref)
    )


def _axis(fields: Fields, joint_type: JointType | None) -> tuple[Vector3 | None, Vector3 | None]:
    """Return the unit axis, and the axis as written where that is no unit vector."""
    if joint_type in HAVE_NO_AXIS:
        _refuse(fields, "axis", joint_type)
        return None, None
    node = fields.said("axis", "z")
    if node is None or isinstance(node, YamlFault):
        return _STAND_IN_AXIS, None
    if not isinstance(node, YamlList):
        axis = _AXES.get(node.text) if isinstance(node, YamlScalar) else None
        if axis is None:
            fields.tell(UNKNOWN_AXIS, node, found=found(node))
        return axis or _STAND_IN_AXIS, None
    written = fields.vector3_at(node, "axis", BARE)
    if written is None:
        return _STAND_IN_AXIS, None
    length = math.hypot(written.x, written.y, written.z)
    if length < EPSILON:
        fields.tell(ZERO_AXIS, node)
        return _STAND_IN_AXIS, None
    if abs(length - 1) <= EPSILON:
        return written, None
    return Vector3(*(component / length for component in written)), written


def _limits(fields: Fields, joint_type: JointType | None, motion: Motion) -> JointLimits | None:
    if joint_type is JointType.FIXED:
        _refuse(fields, "limits", joint_type)
        return None
    example = _LIMITS_EXAMPLE.get(joint_type, "") if joint_type else ""
    limits = fields.map("limits", required=example)
    if limits is None:
        return _STAND_IN_LIMITS if example else None
    values = lower_fields(JointLimits, limits, motion)
    lower, upper = values["lower"], values["upper"]
    if lower is not None and upper is not None and lower > upper:
        _tell_crossed(limits)
        values |= {"lower": -UNKNOWN, "upper": UNKNOWN}
    if joint_type is JointType.CONTINUOUS:
        # It has no range, and one that is stated is reported; what stands in for a faulty one is not.
        values |= {name: None for name in ("lower", "upper") if values[name] in (-UNKNOWN, UNKNOWN)}
    return limits.build(lambda: JointLimits(**values, **besides(limits)))


def _tell_crossed(limits: Fields) -> None:
    lower, upper = limits.node.get("lower"), limits.node.get("upper")
    if lower is not None and upper is not None:
        limits.tell(LIMITS_CROSSED, lower, lower=found(lower), upper=found(upper))


def _part(fields: Fields, kind: type[E], motion: Motion) -> E | None:
    part = fields.map(kind.TAG)
    return lower_element(kind, part, motion) if part else None


def _mimic(fields: Fields, motion: Motion) -> JointMimic | None:
    mimic = fields.map("mimic")
    if mimic is None:
        return None
    return lower_element(JointMimic, mimic, motion, stated=stated_numbers(JointMimic, mimic))


def _refuse(fields: Fields, key: str, joint_type: JointType) -> None:
    node = fields.node.get(key)
    if node is not None and not isinstance(node, YamlFault):
        fields.tell(NOT_OF_THIS_TYPE, node, owner=fields.title, field=key, type=joint_type)
