"""Compare poses and inertia tensors as a whole: how far a pose moved and turned, which entries of a tensor changed."""

from __future__ import annotations

import math
from collections.abc import Iterator

from linkforge_compile.compare.difference import Difference, Kind, Plain
from linkforge_compile.compare.numbers import ANGLE, BARE, describe_change, describe_distance, describe_number
from linkforge_compile.compare.words import to_plain
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.link import InertiaTensor

_ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def pose_differences(
    path: tuple[str, ...], before: Transform, after: Transform, tolerance: float
) -> Iterator[Difference]:
    """Yield how far a pose moved [m] and turned [rad], if by more than the tolerance."""
    shift = [new - old for old, new in zip(before.xyz, after.xyz, strict=True)]
    distance, angle = math.hypot(*shift), _angle_between(before.rpy, after.rpy)
    words = []
    if distance > tolerance:
        along = [
            f"{axis} {'+' if by > 0 else '-'}{describe_distance(abs(by))}"
            for axis, by in zip("xyz", shift, strict=True)
            if abs(by) > tolerance
        ]
        words.append(f"moved by {describe_distance(distance)}" + (f" ({', '.join(along)})" if along else ""))
    if angle > tolerance:
        words.append(f"turned by {describe_number(angle, ANGLE, 4)}")
    if words:
        yield Difference(Kind.CHANGED, path, _plain_pose(before), _plain_pose(after), ", ".join(words))


def _plain_pose(pose: Transform) -> dict[str, Plain]:
    return {"xyz": to_plain(pose.xyz), "rpy": to_plain(pose.rpy)}


def _angle_between(before: Vector3, after: Vector3) -> float:
    """Return the angle of the rotation between two orientations, given as rpy [rad]."""
    if before == after:
        return 0.0
    w, x, y, z = _quaternion(before)
    w2, x2, y2, z2 = _quaternion(after)
    cosine = w * w2 + x * x2 + y * y2 + z * z2
    sine = math.hypot(
        w * x2 - x * w2 - y * z2 + z * y2, w * y2 - y * w2 - z * x2 + x * z2, w * z2 - z * w2 - x * y2 + y * x2
    )
    return 2 * math.atan2(sine, abs(cosine))


def _quaternion(rpy: Vector3) -> tuple[float, float, float, float]:
    """Return (w, x, y, z) for rotations about the fixed axes x, y, z, in this order."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in rpy)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def tensor_differences(
    path: tuple[str, ...], before: InertiaTensor, after: InertiaTensor, tolerance: float
) -> Iterator[Difference]:
    """Yield the entries of a tensor that differ by more than the tolerance, relative to its largest entry."""
    pairs = {name: (getattr(before, name), getattr(after, name)) for name in _ENTRIES}
    largest = max(abs(entry) for pair in pairs.values() for entry in pair)
    changed = {name: pair for name, pair in pairs.items() if abs(pair[1] - pair[0]) > tolerance * largest}
    if changed:
        words = ", ".join(f"{name} {describe_change(*pair, BARE)}" for name, pair in changed.items())
        yield Difference(Kind.CHANGED, path, _plain_tensor(before), _plain_tensor(after), f"{words} kg*m^2")


def _plain_tensor(tensor: InertiaTensor) -> dict[str, Plain]:
    return {name: getattr(tensor, name) for name in _ENTRIES}
