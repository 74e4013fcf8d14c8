"""Poses with unit quaternions, which no angle makes inexact."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

from linkforge_compile.core.models.geometry import Transform


class Quaternion(NamedTuple):
    x: float
    y: float
    z: float
    w: float

    def times(self, other: Quaternion) -> Quaternion:
        """Return the turn of first the other and then this one."""
        (a, b, c, d), (e, f, g, h) = self, other
        return Quaternion(
            d * e + a * h + b * g - c * f,
            d * f - a * g + b * h + c * e,
            d * g + a * f - b * e + c * h,
            d * h - a * e - b * f - c * g,
        )

    @property
    def inverse(self) -> Quaternion:
        return Quaternion(-self.x, -self.y, -self.z, self.w)

    def turned(self, xyz: tuple[float, float, float]) -> tuple[float, float, float]:
        return self.times(Quaternion(*xyz, 0.0)).times(self.inverse)[:3]


class Pose(NamedTuple):
    """A position [m] and a turn in the frame around it."""

    xyz: tuple[float, float, float]
    turn: Quaternion

    @classmethod
    def of(cls, origin: Transform) -> Pose:
        roll, pitch, yaw = (angle / 2 for angle in origin.rpy)
        about_x, about_y = Quaternion(sin(roll), 0.0, 0.0, cos(roll)), Quaternion(0.0, sin(pitch), 0.0, cos(pitch))
        about_z = Quaternion(0.0, 0.0, sin(yaw), cos(yaw))
        return cls(origin.xyz.to_tuple(), about_z.times(about_y).times(about_x))

    def times(self, inner: Pose) -> Pose:
        """Return a pose in this frame as one in the frame around this one."""
        x, y, z = self.turn.turned(inner.xyz)
        return Pose((self.xyz[0] + x, self.xyz[1] + y, self.xyz[2] + z), self.turn.times(inner.turn))

    @property
    def inverse(self) -> Pose:
        x, y, z = self.turn.inverse.turned(self.xyz)
        return Pose((-x, -y, -z), self.turn.inverse)


NO_TURN = Quaternion(0.0, 0.0, 0.0, 1.0)
