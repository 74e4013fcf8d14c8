"""Quaternions of URDF 1.1, which turn a pose in the place of `rpy`: read as that, and kept as they stand."""

from __future__ import annotations

import math

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.syntax import YamlList
from linkforge_compile.units import Dimension, number_text

_QUATERNION = "quat_xyzw"
_STRAIGHT_UP = 1e-9
"""Nearer than so to a pitch of a quarter turn, roll and yaw turn about one axis; all of it is yaw then."""

_NOISE = 4e-16
"""So far may an angle be off that is meant as a round one in degrees [rad]."""


def rpy_of_quaternion(origin: ElementReader) -> YamlList | None:
    """Return the turn of a pose that a quaternion says, in rpy; None for one without, or with one that is no turn."""
    said = origin.element.attributes.get(_QUATERNION)
    numbers = [number_of(part) for part in said.value.split()] if said else []
    if said is None or len(numbers) != 4:
        return None
    x, y, z, w = (0.0 if number is None else number for number in numbers)
    if None in numbers or not 0 < math.hypot(x, y, z, w) < math.inf:
        return None
    nodes = [origin.draft.number(number_text(angle), said.span, Dimension.ANGLE) for angle in _rpy(x, y, z, w)]
    return YamlList(tuple(node for node in nodes if node is not None), said.span)


def _rpy(x: float, y: float, z: float, w: float) -> tuple[float, ...]:
    """Return the rotations about the fixed axes x, then y, then z [rad]."""
    length = math.hypot(x, y, z, w)
    x, y, z, w = x / length, y / length, z / length, w / length
    across = math.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z))
    pitch = math.atan2(2 * (w * y - x * z), across)
    if across < _STRAIGHT_UP:
        roll, yaw = 0.0, math.atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z))
    else:
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return tuple(map(_round, (roll, pitch, yaw)))


def _round(angle: float) -> float:
    degrees = math.radians(round(math.degrees(angle), 3))
    return degrees + 0.0 if abs(angle - degrees) <= _NOISE else angle
