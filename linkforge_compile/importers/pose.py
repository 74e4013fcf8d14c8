"""Read the pose of an element, also from the quaternion of URDF 1.1."""

from __future__ import annotations

import math

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.syntax import YamlList, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, number_text

_QUATERNION = "quat_xyzw"
"""The attribute of URDF 1.1 that replaces `rpy`; it is kept with the angles computed from it."""
_GIMBAL_LOCK = 1e-9
"""Below this cosine of the pitch, roll and yaw turn about the same axis, and all of the turn becomes yaw."""
_NOISE = 4e-16
"""How far a computed angle may be from the round angle in degrees that it replaces [rad]."""


def read_pose(origin: ElementReader) -> YamlNode | None:
    """Read a pose: `[x, y, z]` if it has no rotation, None for the identity."""
    xyz, rpy = origin.numbers("xyz", 3), origin.numbers("rpy", 3, Dimension.ANGLE)
    if rpy is None and origin.draft.has_quaternions:
        rpy = _rpy_of_quaternion(origin)
    xyz, rpy = _unless_zero(xyz), _unless_zero(rpy)
    node = origin.map(xyz=xyz, rpy=rpy)
    if not len(node):
        return None
    return xyz if xyz and len(node) == 1 else node


def _rpy_of_quaternion(origin: ElementReader) -> YamlList | None:
    """Return the rotation of a pose's quaternion as rpy; None without one, or if it is no rotation."""
    attribute = origin.element.attributes.get(_QUATERNION)
    numbers = [number_of(part) for part in attribute.value.split()] if attribute else []
    if attribute is None or len(numbers) != 4:
        return None
    x, y, z, w = (0.0 if number is None else number for number in numbers)
    if None in numbers or not 0 < math.hypot(x, y, z, w) < math.inf:
        return None
    nodes = [origin.draft.number(number_text(angle), attribute.span, Dimension.ANGLE) for angle in _rpy(x, y, z, w)]
    return YamlList(tuple(node for node in nodes if node is not None), attribute.span)


def _rpy(x: float, y: float, z: float, w: float) -> tuple[float, ...]:
    """Return the rotations about the fixed axes x, y, z, in this order [rad]."""
    length = math.hypot(x, y, z, w)
    x, y, z, w = x / length, y / length, z / length, w / length
    cos_pitch = math.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z))
    pitch = math.atan2(2 * (w * y - x * z), cos_pitch)
    if cos_pitch < _GIMBAL_LOCK:
        roll, yaw = 0.0, math.atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z))
    else:
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return tuple(map(_rounded, (roll, pitch, yaw)))


def _rounded(angle: float) -> float:
    degrees = math.radians(round(math.degrees(angle), 3))
    return degrees + 0.0 if abs(angle - degrees) <= _NOISE else angle


def _unless_zero(numbers: YamlList | None) -> YamlList | None:
    return numbers if numbers and any(_value(item) for item in numbers) else None


def _value(node: YamlNode) -> float:
    """Return the value of a number; 1 for an angle in degrees, which is never 0."""
    return (number_of(node.text) or 0.0) if isinstance(node, YamlScalar) and not isinstance(node.value, str) else 1.0
