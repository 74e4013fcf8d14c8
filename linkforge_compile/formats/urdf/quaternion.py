"""Quaternions of URDF 1.1: `quat_xyzw` in the place of `rpy`, beside which readers of that version refuse it."""

from __future__ import annotations

import math

from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.physics import rotation_matrix

QUATERNION = "quat_xyzw"
_VERSIONS_WITHOUT = (None, "1.0")
_NO_TURN = Vector3(0.0, 0.0, 0.0)
_TOLERANCE = 1e-9
"""By so much may the entries of two rotation matrices differ that are the same turn."""


def reads_quaternions(version: str | None) -> bool:
    """Whether readers take the quaternions of a document that states a version, None for none, or ignore them."""
    return version not in _VERSIONS_WITHOUT


def rpy_beside_quaternion(pose: Transform, version: str | None) -> Vector3 | None:
    """Return the rpy that an origin states in a document of a version; None where its quaternion says the turn."""
    said = dict(pose.extra_attributes).get(QUATERNION)
    if said is None:
        return pose.rpy
    is_said = pose.rpy == _NO_TURN or (reads_quaternions(version) and _turns_as(said, pose.rpy))
    return None if is_said else pose.rpy


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
