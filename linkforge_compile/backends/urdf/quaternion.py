"""Quaternions of URDF 1.1: `quat_xyzw` in the place of `rpy`, beside which readers of that version refuse it."""

from __future__ import annotations

import math

from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.physics import rotation_matrix

QUATERNION = "quat_xyzw"
_NO_TURN = Vector3(0.0, 0.0, 0.0)
_TOLERANCE = 1e-9
"""By so much may the entries of two rotation matrices differ that are the same turn."""


def rpy_beside_quaternion(pose: Transform) -> Vector3 | None:
    """Return the rpy that an origin states; None where its quaternion says the turn."""
    said = dict(pose.extra_attributes).get(QUATERNION)
    return None if said is not None and (pose.rpy == _NO_TURN or _turns_as(said, pose.rpy)) else pose.rpy


def is_other_turn(pose: Transform) -> bool:
    """Whether an origin has a quaternion that turns otherwise than its rpy does."""
    said = dict(pose.extra_attributes).get(QUATERNION)
    return said is not None and not _turns_as(said, pose.rpy)


def _turns_as(quaternion: str, rpy: Vector3) -> bool:
    """Whether the text of a quaternion (x, y, z, w) is the rotation of an rpy [rad]."""
    try:
        x, y, z, w = map(float, quaternion.split())
    except ValueError:
        return False
    square = x * x + y * y + z * z + w * w
    if not square or not math.isfinite(square):
        return False
    s = 2 / square
    turned = (
        (1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        (s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)),
        (s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)),
    )
    pairs = zip(turned, rotation_matrix(rpy), strict=True)
    return all(abs(a - b) <= _TOLERANCE for one, other in pairs for a, b in zip(one, other, strict=True))
