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
from linkforge_compile.lowering.extra import besides, with_extras
from linkforge_compile.lowering.fields import Fields
from linkforge_compile.lowering.quantities import (
    AMOUNT,
    ANGLE,
    ANGLE_OR_LENGTH,
    BARE,
    LENGTH,
    NOT_NEGATIVE,
    Measure,
    found,
)
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlScalar
from linkforge_compile.units import Dimension


class _Motion(NamedTuple):
    """What a joint's position, effort and velocity are measured in, and what the latter look like where they lack."""

    position: Measure = BARE
    effort: Measure = AMOUNT
    velocity: Measure = AMOUNT
    some_effort: str = "1"
    some_velocity: str = "1"
    limits: str = ""
    """What limits look like, to offer where they are required; empty where they are not."""


def _amount(*dimensions: Dimension) -> Measure:
    return Measure(dimensions, NOT_NEGATIVE)


_TURNING = _Motion(ANGLE, _amount(Dimension.TORQUE), _amount(Dimension.ANGULAR_VELOCITY), "50 N*m", "90 deg/s")
_SLIDING = _Motion(LENGTH, _amount(Dimension.FORCE), _amount(Dimension.VELOCITY), "50 N", "0.2 m/s")
_MOTIONS = {
    JointType.REVOLUTE: _TURNING._replace(limits="{lower: -90 deg, upper: 90 deg, effort: 50 N*m, velocity: 90 deg/s}"),
    JointType.CONTINUOUS: _TURNING,
    JointType.PRISMATIC: _SLIDING._replace(limits="{lower: 0, upper: 100 mm, effort: 50 N, velocity: 0.2 m/s}"),
    JointType.FIXED: _Motion(),
    JointType.FLOATING: _Motion(),
    JointType.PLANAR: _Motion(),
}
_MOTIONS_BY_NAME = {str(kind): motion for kind, motion in _MOTIONS.items()}
_ANY_MOTION = _TURNING._replace(
    position=ANGLE_OR_LENGTH,
    effort=_amount(Dimension.TORQUE, Dimension.FORCE),
    velocity=_amount(Dimension.ANGULAR_VELOCITY, Dimension.VELOCITY),
)
# What stands in for what is faulty, which has been told: the joint stays, so that its ends and the tree are judged.
# Nothing of it is ever written: a compile that told an error gives no robot.
_STAND_IN_TYPE = JointType.REVOLUTE
_STAND_IN_AXIS = Vector3(0.0, 0.0, 1.0)
_STAND_IN_LIMITS = JointLimits(-UNKNOWN, UNKNOWN, 1.0, 1.0)

# What their constructors ask of values, the measures and what reads the others have asked.

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
    position = _MOTIONS[joint.type].position
    return position if position.dimensions else ANGLE_OR_LENGTH


def joints_of(file: YamlMap) -> Mapping[str, YamlMap]:
    """Return the joints that a file itself writes, by name: its `joints`, and the one by which it hangs."""
    sections = [section for name in ("joints", "mount") if isinstance(section := file.get(name), YamlMap)]
    entries = (entry for section in sections for entry in section)
    return {entry.name: entry.value for entry in entries if isinstance(entry.value, YamlMap)}


def positions_of_type(joint: Located | None) -> Measure:
    """Return what a joint that is written somewhere goes by: an angle, a length, or either where nobody knows."""
    kind = joint.child("type") if joint else None
    motion = _MOTIONS_BY_NAME.get(kind.text) if isinstance(kind, YamlScalar) else None
    return motion.position if motion and motion.position.dimensions else ANGLE_OR_LENGTH


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
    motion = _MOTIONS[joint_type] if joint_type else _ANY_MOTION
    fields.origin()
    _axis(fields, joint_type)
    _limits(fields, joint_type, motion)
    for read in (_dynamics, _mimic, _safety_controller, _calibration):
        read(fields, motion)


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
    motion = _MOTIONS[joint_type]
    axis, axis_as_written = _axis(fields, joint_type)
    limits = _limits(fields, joint_type, motion)
    dynamics, mimic = _dynamics(fields, motion), _mimic(fields, motion)
    safety, calibration = _safety_controller(fields, motion), _calibration(fields, motion)
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


def _limits(fields: Fields, joint_type: JointType | None, motion: _Motion) -> JointLimits | None:
    if joint_type is JointType.FIXED:
        _refuse(fields, "limits", joint_type)
        return None
    limits = fields.map("limits", required=motion.limits)
    if limits is None:
        return _STAND_IN_LIMITS if motion.limits else None
    lower, upper, effort, velocity = limits.numbers(
        ("lower", motion.position, ""),
        ("upper", motion.position, ""),
        ("effort", motion.effort, motion.some_effort),
        ("velocity", motion.velocity, motion.some_velocity),
    )
    are_crossed = lower is not None and upper is not None and lower > upper
    if are_crossed:
        _tell_crossed(limits)
    # A continuous joint has none, and is told of those that it has.
    has_range = joint_type is not JointType.CONTINUOUS
    if are_crossed or (lower is None and _is_lost(limits, "lower")):
        lower = _STAND_IN_LIMITS.lower if has_range else None
    if are_crossed or (upper is None and _is_lost(limits, "upper")):
        upper = _STAND_IN_LIMITS.upper if has_range else None
    effort = _STAND_IN_LIMITS.effort if effort is None else effort
    velocity = _STAND_IN_LIMITS.velocity if velocity is None else velocity
    return with_extras(JointLimits(lower, upper, effort, velocity, source=limits.ref), limits)


def _is_lost(fields: Fields, key: str) -> bool:
    """Whether a field that gave nothing was said: faulty, or under another key that is none."""
    return fields.said(key) is not None or fields.is_faulty


def _tell_crossed(limits: Fields) -> None:
    lower, upper = limits.node.get("lower"), limits.node.get("upper")
    if lower is not None and upper is not None:
        limits.tell(LIMITS_CROSSED, lower, lower=found(lower), upper=found(upper))


def _dynamics(fields: Fields, motion: _Motion) -> JointDynamics | None:
    dynamics = fields.map("dynamics")
    if dynamics is None:
        return None
    damping, friction = dynamics.numbers(("damping", AMOUNT, ""), ("friction", motion.effort, ""))
    return with_extras(JointDynamics(damping or 0.0, friction or 0.0, source=dynamics.ref), dynamics)


def _mimic(fields: Fields, motion: _Motion) -> JointMimic | None:
    mimic = fields.map("mimic")
    if mimic is None:
        return None
    joint = mimic.text("joint", required="left_finger")
    multiplier, offset = mimic.number("multiplier"), mimic.number("offset", motion.position)
    if joint is None:
        return None
    if multiplier is None:
        multiplier = UNKNOWN if _is_lost(mimic, "multiplier") else 1.0
    if offset is None:
        offset = UNKNOWN if _is_lost(mimic, "offset") else 0.0
    stated = [name for name in ("multiplier", "offset") if mimic.node.get(name) is not None]
    return mimic.build(lambda: JointMimic(joint, multiplier, offset, stated=stated, **besides(mimic)))


def _safety_controller(fields: Fields, motion: _Motion) -> JointSafetyController | None:
    safety = fields.map("safety_controller")
    if safety is None:
        return None
    lower = safety.number("soft_lower_limit", motion.position)
    upper = safety.number("soft_upper_limit", motion.position)
    if lower is None and _is_lost(safety, "soft_lower_limit"):
        lower = -UNKNOWN
    if upper is None and _is_lost(safety, "soft_upper_limit"):
        upper = UNKNOWN
    k_position, k_velocity = safety.number("k_position"), safety.number("k_velocity") or 0.0
    return safety.build(lambda: JointSafetyController(lower, upper, k_position, k_velocity, **besides(safety)))


def _calibration(fields: Fields, motion: _Motion) -> JointCalibration | None:
    calibration = fields.map("calibration")
    if calibration is None:
        return None
    rising, falling = calibration.number("rising", motion.position), calibration.number("falling", motion.position)
    return calibration.build(lambda: JointCalibration(rising, falling, **besides(calibration)))


def _refuse(fields: Fields, key: str, joint_type: JointType) -> None:
    node = fields.node.get(key)
    if node is not None and not isinstance(node, YamlFault):
        fields.tell(NOT_OF_THIS_TYPE, node, owner=fields.title, field=key, type=joint_type)
