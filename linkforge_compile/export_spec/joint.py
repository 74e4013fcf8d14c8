"""Joints as a spec writes them, in the units of their motion."""

from __future__ import annotations

import math

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.part import Element
from linkforge_compile.export_spec.elements import written_element
from linkforge_compile.export_spec.geometry import written_origin
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import POSITION, Dimension, Motion

_AXES = {
    sign + name: Vector3(*(factor if name == axis else 0.0 for axis in "xyz"))
    for sign, factor in (("", 1.0), ("-", -1.0))
    for name in "xyz"
}


def position_dimension(joint: Joint) -> Dimension | None:
    """Return what a position of a joint is, None where it is a bare number or several of them."""
    return POSITION.dimension(joint.type.motion)


def written_joint(pen: Pen, joint: Joint, gazebo: YamlNode | None) -> YamlMap:
    """Return a joint; `gazebo` is what a simulator is told about it."""
    motion = joint.type.motion
    return pen.element(
        joint,
        type=pen.text(joint.type),
        parent=pen.text(joint.parent),
        child=pen.text(joint.child),
        origin=written_origin(pen, joint.origin),
        axis=_axis(pen, joint),
        limits=_part(pen, joint.limits, motion),
        dynamics=_part(pen, joint.dynamics, motion),
        mimic=_part(pen, joint.mimic, motion),
        safety_controller=_part(pen, joint.safety_controller, motion),
        calibration=_part(pen, joint.calibration, motion),
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


def _part(pen: Pen, part: Element | None, motion: Motion, **entries: YamlNode | None) -> YamlMap | None:
    return written_element(pen, part, motion, **entries) if part else None
