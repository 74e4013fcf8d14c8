"""Poses and inertia tensors: differences that mean something only as a whole."""

from __future__ import annotations

import math
from collections.abc import Iterator

from linkforge_compile.compare.difference import Difference, Kind, Plain
from linkforge_compile.compare.measures import ANGLE, Measure, change_told, distance_told, number_told
from linkforge_compile.compare.words import plain
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.link import InertiaTensor

_ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def pose_differences(
    path: tuple[str, ...], before: Transform, after: Transform, tolerance: float
) -> Iterator[Difference]:
    """Yield by how far a pose moved and turned, if by more than the tolerance [m], [rad]."""
    shift = [after_ - before_ for before_, after_ in zip(before.xyz, after.xyz, strict=True)]
    distance, angle = math.hypot(*shift), angle_between(before.rpy, after.rpy)
    told = []
    if distance > tolerance:
        along = [
            f"{axis} {'+' if by > 0 else '-'}{distance_told(abs(by))}"
            for axis, by in zip("xyz", shift, strict=True)
            if abs(by) > tolerance
        ]
        told.append(f"moved by {distance_told(distance)}" + (f" ({', '.join(along)})" if along else ""))
    if angle > tolerance:
        told.append(f"turned by {number_told(angle, ANGLE, 4)}")
    if told:
        yield Difference(Kind.CHANGED, path, _pose(before), _pose(after), ", ".join(told))


def _pose(pose: Transform) -> dict[str, Plain]:
    return {"xyz": plain(pose.xyz), "rpy": plain(pose.rpy)}


def angle_between(before: Vector3, after: Vector3) -> float:
    """Return the angle of the rotation from one orientation to another, each given as rpy [rad]."""
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
    """Return (w, x, y, z) of rotations about the fixed axes x, then y, then z."""
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
    """Yield which entries of a tensor differ by more than the tolerance, as a share of the tensor's largest one."""
    pairs = {name: (getattr(before, name), getattr(after, name)) for name in _ENTRIES}
    largest = max(abs(entry) for pair in pairs.values() for entry in pair)
    changed = {name: pair for name, pair in pairs.items() if abs(pair[1] - pair[0]) > tolerance * largest}
    if changed:
        told = ", ".join(f"{name} {change_told(*pair, Measure())}" for name, pair in changed.items())
        yield Difference(Kind.CHANGED, path, _tensor(before), _tensor(after), f"{told} kg*m^2")


def _tensor(tensor: InertiaTensor) -> dict[str, Plain]:
    return {name: getattr(tensor, name) for name in _ENTRIES}
