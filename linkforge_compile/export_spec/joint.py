"""Write joints in the units of their motion, with the axis as it was written."""

from __future__ import annotations

import math

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_element
from linkforge_compile.syntax import YamlMap, YamlNode

_AXES = {
    sign + name: Vector3(*(factor if name == axis else 0.0 for axis in "xyz"))
    for sign, factor in (("", 1.0), ("-", -1.0))
    for name in "xyz"
}


def export_joint(builder: SpecBuilder, joint: Joint, gazebo: YamlNode | None) -> YamlMap:
    """Return a joint with the Gazebo blocks about it."""
    return export_element(builder, joint, joint.type.motion, axis=_axis(builder, joint), gazebo=gazebo)


def _axis(builder: SpecBuilder, joint: Joint) -> YamlNode | None:
    """Return the vector that was written, else the axis as a word, such as `-z`, else as a unit vector."""
    if joint.axis is None:
        return None
    written = joint.axis_as_written
    if written and _direction(written) == joint.axis:
        return builder.numbers(written)
    word = next((word for word, axis in _AXES.items() if axis == joint.axis), None)
    return builder.numbers(joint.axis) if word is None else builder.text(word)


def _direction(vector: Vector3) -> Vector3 | None:
    length = math.hypot(*vector)
    return Vector3(*(component / length for component in vector)) if length else None
