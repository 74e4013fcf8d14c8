"""Joints as URDF writes them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linkforge_compile.backends.element import attributes, elements, leaf, leaf_at
from linkforge_compile.backends.markup import NOTHING, Xml, placed
from linkforge_compile.backends.urdf.link import origin
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
)


class JointView(NamedTuple):
    """`<joint>`; its parts are nothing where they are not stated."""

    attributes: Xml
    origin: Xml
    parent: str
    child: str
    axis: Xml
    limit: Xml
    dynamics: Xml
    mimic: Xml
    safety_controller: Xml
    calibration: Xml
    elements: Xml


def joint_views(joints: Iterable[Joint], version: str | None) -> tuple[JointView, ...]:
    return tuple(
        JointView(
            attributes(joint, name=joint.name, type=joint.type),
            origin(joint.origin, version),
            placed(joint.parent, joint.source, "parent"),
            placed(joint.child, joint.source, "child"),
            _axis(joint),
            _limit(joint.limits),
            _dynamics(joint.dynamics),
            _mimic(joint.mimic),
            _safety_controller(joint.safety_controller),
            _calibration(joint.calibration),
            elements(joint),
        )
        for joint in joints
    )


def _axis(joint: Joint) -> Xml:
    axis = joint.axis_as_written or joint.axis
    return leaf_at("axis", joint.source, "axis", xyz=axis) if axis else NOTHING


def _limit(limits: JointLimits | None) -> Xml:
    if limits is None:
        return NOTHING
    return leaf("limit", limits, lower=limits.lower, upper=limits.upper, effort=limits.effort, velocity=limits.velocity)


def _dynamics(dynamics: JointDynamics | None) -> Xml:
    # Both, always: urdfdom refuses a <dynamics> that states neither.
    if dynamics is None:
        return NOTHING
    return leaf("dynamics", dynamics, damping=dynamics.damping, friction=dynamics.friction)


def _mimic(mimic: JointMimic | None) -> Xml:
    if mimic is None:
        return NOTHING
    return leaf(
        "mimic",
        mimic,
        joint=mimic.joint,
        multiplier=mimic.multiplier if mimic.is_written("multiplier") else None,
        offset=mimic.offset if mimic.is_written("offset") else None,
    )


def _safety_controller(safety: JointSafetyController | None) -> Xml:
    if safety is None:
        return NOTHING
    return leaf(
        "safety_controller",
        safety,
        soft_lower_limit=safety.soft_lower_limit,
        soft_upper_limit=safety.soft_upper_limit,
        k_position=safety.k_position,
        k_velocity=safety.k_velocity,
    )


def _calibration(calibration: JointCalibration | None) -> Xml:
    if calibration is None:
        return NOTHING
    return leaf("calibration", calibration, rising=calibration.rising, falling=calibration.falling)
