"""Joints as a spec writes them, in the units of their motion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension
from linkforge_compile.writers.geometry import written_origin
from linkforge_compile.writers.pen import Pen


class _Motion(NamedTuple):
    """The dimensions of a joint's position, effort and velocity; None where numbers are bare."""

    position: Dimension | None = None
    effort: Dimension | None = None
    velocity: Dimension | None = None


_TURNING = _Motion(Dimension.ANGLE, Dimension.TORQUE, Dimension.ANGULAR_VELOCITY)
_MOTIONS: Mapping[str, _Motion] = {
    JointType.REVOLUTE: _TURNING,
    JointType.CONTINUOUS: _TURNING,
    JointType.PRISMATIC: _Motion(Dimension.LENGTH, Dimension.FORCE, Dimension.VELOCITY),
}

_AXES = {
    sign + name: Vector3(*(factor if name == axis else 0.0 for axis in "xyz"))
    for sign, factor in (("", 1.0), ("-", -1.0))
    for name in "xyz"
}


def position_dimension(joint: Joint) -> Dimension | None:
    """Return what a position of a joint is, None where it is a bare number or several of them."""
    return _MOTIONS.get(joint.type, _Motion()).position


def written_joint(pen: Pen, joint: Joint, gazebo: YamlNode | None) -> YamlMap:
    """Return a joint; `gazebo` is what a simulator is told about it."""
    motion = _MOTIONS.get(joint.type, _Motion())
    return pen.element(
        joint,
        type=pen.text(joint.type),
        parent=pen.text(joint.parent),
        child=pen.text(joint.child),
        origin=written_origin(pen, joint.origin),
        axis=_axis(pen, joint),
        limits=_limits(pen, joint.limits, motion) if joint.limits else None,
        dynamics=_dynamics(pen, joint.dynamics, motion) if joint.dynamics else None,
        mimic=_mimic(pen, joint.mimic, motion) if joint.mimic else None,
        safety_controller=_safety_controller(pen, joint.safety_controller, motion) if joint.safety_controller else None,
        calibration=_calibration(pen, joint.calibration, motion) if joint.calibration else None,
        gazebo=gazebo,
    )


def _axis(pen: Pen, joint: Joint) -> YamlNode | None:
    """Return the axis as it was once written, so that it is again; its letter where it has one."""
    if joint.axis is None:
        return None
    written = joint.axis_as_written
    if written and _direction(written) == joint.axis:
        return pen.numbers(written)
    letter = next((letter for letter, axis in _AXES.items() if axis == joint.axis), None)
    return pen.numbers(joint.axis) if letter is None else pen.text(letter)


def _direction(vector: Vector3) -> Vector3 | None:
    length = math.hypot(*vector)
    return Vector3(*(component / length for component in vector)) if length else None


def _limits(pen: Pen, limits: JointLimits, motion: _Motion) -> YamlMap:
    return pen.element(
        limits,
        lower=pen.number(limits.lower, motion.position),
        upper=pen.number(limits.upper, motion.position),
        effort=pen.number(limits.effort, motion.effort),
        velocity=pen.number(limits.velocity, motion.velocity),
    )


def _dynamics(pen: Pen, dynamics: JointDynamics, motion: _Motion) -> YamlMap:
    return pen.element(
        dynamics,
        damping=pen.number(dynamics.damping, default=0),
        friction=pen.number(dynamics.friction, motion.effort, default=0),
    )


def _mimic(pen: Pen, mimic: JointMimic, motion: _Motion) -> YamlMap:
    return pen.element(
        mimic,
        joint=pen.text(mimic.joint),
        multiplier=pen.number(mimic.multiplier, default=None if mimic.is_written("multiplier") else 1),
        offset=pen.number(mimic.offset, motion.position, default=None if mimic.is_written("offset") else 0),
    )


def _safety_controller(pen: Pen, safety: JointSafetyController, motion: _Motion) -> YamlMap:
    return pen.element(
        safety,
        soft_lower_limit=pen.number(safety.soft_lower_limit, motion.position),
        soft_upper_limit=pen.number(safety.soft_upper_limit, motion.position),
        k_position=pen.number(safety.k_position),
        k_velocity=pen.number(safety.k_velocity, default=0),
    )


def _calibration(pen: Pen, calibration: JointCalibration, motion: _Motion) -> YamlMap:
    return pen.element(
        calibration,
        rising=pen.number(calibration.rising, motion.position),
        falling=pen.number(calibration.falling, motion.position),
    )
