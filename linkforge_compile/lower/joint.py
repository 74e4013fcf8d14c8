"""Joints: their type decides which parts they have, and the units of their positions and limits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.constants import EPSILON, UNKNOWN
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.joint import AXES, HAVE_NO_AXIS, HAVE_NO_LIMITS, Joint, JointLimits, JointType
from linkforge_compile.diagnostics.codes.model import (
    JOINT_TO_ITSELF,
    LIMITS_CROSSED,
    NOT_OF_THIS_TYPE,
    UNKNOWN_AXIS,
    ZERO_AXIS,
)
from linkforge_compile.lower.elements import extras_of, lower_element, lower_fields, lower_pose
from linkforge_compile.lower.fields import Fields, by_word
from linkforge_compile.lower.numbers import (
    ANGLE_OR_LENGTH,
    BARE,
    NumberType,
    Refusal,
    describe_node,
    number_type,
    si_number,
)
from linkforge_compile.source import Located
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlScalar
from linkforge_compile.units import POSITION, Motion

_LIMITS_EXAMPLE = {
    JointType.REVOLUTE: "{lower: -90 deg, upper: 90 deg, effort: 50 N*m, velocity: 90 deg/s}",
    JointType.PRISMATIC: "{lower: 0, upper: 100 mm, effort: 50 N, velocity: 0.2 m/s}",
}
# Substitutes for what is faulty, which is reported: the joint stays, so that checks see its ends and a whole tree.
# They are never written, because a compile with errors gives no robot.
_SUBSTITUTE_TYPE = JointType.REVOLUTE
_SUBSTITUTE_AXIS = AXES["z"]
SUBSTITUTE_LIMITS = JointLimits(-UNKNOWN, UNKNOWN, 1.0, 1.0)


class JointEnds(NamedTuple):
    """The links of a joint, None for a faulty one, and the pose of the child in the parent."""

    parent: str | None
    child: str | None
    origin: Transform


def lower_joints(file: Fields) -> Iterator[tuple[str, Joint | None]]:
    """Lower the joints of a file, None for a faulty one."""
    links = file.node.get("links")
    names = tuple(links.entries) if isinstance(links, YamlMap) else ()
    return file.each("joints", "joint", lambda fields, name: _lower_joint(fields, name, names))


def _lower_joint(fields: Fields, name: str, links: Sequence[str]) -> Joint | None:
    """Lower one joint; an example for a missing parent is one of the `links` of the file."""
    valid_name = name if fields.name_is_valid(name, "joint") else None
    joint_type = fields.choice("type", JointType, required="revolute")
    child_node = fields.get("child")
    child_name = child_node.text if isinstance(child_node, YamlScalar) else None
    example = next((link for link in links if link != child_name), "base")
    parent, child = fields.text("parent", required=example), fields.text("child", required="arm")
    ends = JointEnds(parent, child, lower_pose(fields))
    return joint_between(fields, valid_name, joint_type, ends)


def joint_between(fields: Fields, name: str | None, joint_type: JointType | None, ends: JointEnds) -> Joint | None:
    """Lower the other fields of a joint between two links; None for a faulty one.

    Name, type and links are None where they are faulty. All fields are read all the same, so that each of their faults
    is reported; those that depend on the type are not if there is none.
    """
    parent, child, origin = ends
    if joint_type is None:
        if name is None or parent is None or child is None or parent == child:
            return None
        parts = (_SUBSTITUTE_TYPE, parent, child, origin, _SUBSTITUTE_AXIS, SUBSTITUTE_LIMITS)
        return fields.build(lambda: Joint(name, *parts).with_source(fields.ref))
    axis, axis_as_written = _lower_axis(fields, joint_type)
    if name is not None and parent is not None and parent == child:
        fields.report(JOINT_TO_ITSELF, fields.node.get("child") or fields.ref, owner=fields.title, link=child)
        child = None
    return lower_element(
        Joint,
        fields,
        joint_type.motion,
        name=name,
        type=joint_type,
        parent=parent,
        child=child,
        origin=origin,
        axis=axis,
        limits=_lower_limits(fields, joint_type, joint_type.motion),
        axis_as_written=axis_as_written,
    )


def check_joint_defaults(fields: Fields, _name: str) -> None:
    """Read what a joint may have that depends on its motion, to report its faults; its type may be unknown."""
    joint_type = fields.choice("type", JointType)
    motion = joint_type.motion if joint_type else Motion.UNKNOWN
    _lower_axis(fields, joint_type)
    limits = _lower_limits(fields, joint_type, motion)
    lower_fields(Joint, fields, motion, name="", type=joint_type, parent="", child="", axis=None, limits=limits)


def _lower_axis(fields: Fields, joint_type: JointType | None) -> tuple[Vector3 | None, Vector3 | None]:
    """Return the unit axis, and the axis as written where that is no unit vector."""
    if joint_type in HAVE_NO_AXIS:
        _refuse(fields, "axis", joint_type)
        return None, None
    node = fields.get("axis", required="z")
    if node is None or isinstance(node, YamlFault):
        return _SUBSTITUTE_AXIS, None
    if not isinstance(node, YamlList):
        axis = AXES.get(node.text) if isinstance(node, YamlScalar) else None
        if axis is None:
            fields.report(UNKNOWN_AXIS, node, found=describe_node(node))
        return axis or _SUBSTITUTE_AXIS, None
    written = fields.vector3_at(node, "axis", BARE)
    if written is None:
        return _SUBSTITUTE_AXIS, None
    length = math.hypot(written.x, written.y, written.z)
    if length < EPSILON:
        fields.report(ZERO_AXIS, node)
        return _SUBSTITUTE_AXIS, None
    if abs(length - 1) <= EPSILON:
        return written, None
    return Vector3(*(component / length for component in written)), written


def _lower_limits(fields: Fields, joint_type: JointType | None, motion: Motion) -> JointLimits | None:
    if joint_type in HAVE_NO_LIMITS:
        _refuse(fields, "limits", joint_type)
        return None
    example = _LIMITS_EXAMPLE.get(joint_type, "") if joint_type else ""
    limits = fields.map("limits", required=example)
    if limits is None:
        return SUBSTITUTE_LIMITS if example else None
    values = lower_fields(JointLimits, limits, motion)
    lower, upper = values["lower"], values["upper"]
    if lower is not None and upper is not None and lower > upper:
        _report_crossed(limits)
        values |= {"lower": -UNKNOWN, "upper": UNKNOWN}
    if joint_type is JointType.CONTINUOUS:
        # It has no range; one that is written is reported, but not the substitute of a faulty one.
        values |= {name: None for name in ("lower", "upper") if values[name] in (-UNKNOWN, UNKNOWN)}
    return limits.build(lambda: JointLimits(**values, **extras_of(limits)).with_source(limits.ref))


def _report_crossed(limits: Fields) -> None:
    lower, upper = limits.node.get("lower"), limits.node.get("upper")
    if lower is not None and upper is not None:
        limits.report(LIMITS_CROSSED, lower, lower=describe_node(lower), upper=describe_node(upper))


def _refuse(fields: Fields, key: str, joint_type: JointType) -> None:
    node = fields.node.get(key)
    if node is not None and not isinstance(node, YamlFault):
        fields.report(NOT_OF_THIS_TYPE, node, owner=fields.title, field=key, type=joint_type)


def joints_of(file: YamlMap) -> Mapping[str, YamlMap]:
    """Return the joints that a file itself writes, by name: its `joints` and its `mount`."""
    sections = [section for name in ("joints", "mount") if isinstance(section := file.get(name), YamlMap)]
    entries = (entry for section in sections for entry in section)
    return {entry.name: entry.value for entry in entries if isinstance(entry.value, YamlMap)}


def position_type(joint: Joint | None) -> NumberType:
    """Return what a position of a joint may be: an angle, a length, or either for a joint of unknown type."""
    if joint is None or joint.limits == SUBSTITUTE_LIMITS:
        return ANGLE_OR_LENGTH
    return _position_type(joint.type)


def position_type_of_node(joint: Located | None) -> NumberType:
    """Return what a position may be of the joint that is written at a node."""
    node = joint.child("type") if joint else None
    return _position_type(by_word(JointType).get(node.text) if isinstance(node, YamlScalar) else None)


def _position_type(joint_type: JointType | None) -> NumberType:
    motion = joint_type.motion if joint_type else Motion.UNKNOWN
    return number_type(POSITION, None, Motion.UNKNOWN if motion is Motion.OTHER else motion)


class _Position(NamedTuple):
    """A position under a key of an object that belongs to a joint."""

    joint: str
    fields: Fields
    key: str


def check_positions_of_module_joints(file: Fields, joints: Mapping[str, Joint | None]) -> None:
    """Report positions in a file that are in a wrong unit for a joint of a module.

    They were read as angles or lengths, because the joint was not known yet. `joints` are those of the whole robot.
    """
    own = joints_of(file.node)
    for joint_name, fields, key in (*_in_transmissions(file), *_in_gazebo_blocks(file)):
        node, joint = fields.node.get(key), joints.get(joint_name)
        if node is None or joint is None or joint_name in own:
            continue
        if not isinstance(si_number(node, ANGLE_OR_LENGTH), Refusal):
            fields.number_at(node, key, position_type(joint))


def _in_transmissions(file: Fields) -> Iterator[_Position]:
    transmissions = file.node.get("transmissions")
    for transmission in transmissions if isinstance(transmissions, YamlMap) else ():
        joints = transmission.value.child("joints")
        for entry in joints if isinstance(joints, YamlMap) else ():
            if isinstance(entry.value, YamlMap):
                owner = f"transmission joint '{entry.name}'"
                yield _Position(entry.name, Fields(entry.value, owner, file.sink, file.trail, entry.key), "offset")


def _in_gazebo_blocks(file: Fields) -> Iterator[_Position]:
    for node in file.items("gazebo"):
        reference = node.get("reference") if isinstance(node, YamlMap) else None
        if isinstance(node, YamlMap) and isinstance(reference, YamlScalar):
            block = Fields(node, file.owner, file.sink, file.trail, path="gazebo")
            yield _Position(reference.text, block, "springReference")
