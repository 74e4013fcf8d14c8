"""Solid bodies of even density: the integrals over a shape that its mass properties depend on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.link import InertiaTensor


@dataclass(frozen=True, slots=True)
class Solid:
    """A shape that holds a volume, in a frame of its own.

    `volume` [m³]; `centre` of the volume [m]; `spread`, the integrals of x², y², z² about the centre, and `skew`,
    those of xy, xz, yz [m⁵]; `size` of its box along the axes of the frame [m].
    """

    volume: float
    centre: Vector3
    spread: Vector3
    skew: Vector3
    size: Vector3

    def scaled(self, scale: Vector3) -> Solid:
        """Return the solid with each axis of its frame stretched by a factor; a negative one mirrors.

        Raises:
            RobotPhysicsError: OUT_OF_RANGE if no volume that a double can hold is left.

        """
        x, y, z = scale
        stretch = abs(x * y * z)
        volume = self.volume * stretch
        if not 0 < volume < math.inf:
            raise RobotPhysicsError(
                ValidationErrorCode.OUT_OF_RANGE,
                f"a scale of {scale} takes the volume of the mesh to {volume} m³",
                target="MeshScale",
                value=scale,
            )
        return Solid(
            volume,
            Vector3(*(at * factor for at, factor in zip(self.centre, scale, strict=True))),
            Vector3(*(one * factor * factor * stretch for one, factor in zip(self.spread, scale, strict=True))),
            Vector3(self.skew.x * x * y * stretch, self.skew.y * x * z * stretch, self.skew.z * y * z * stretch),
            Vector3(*(one * abs(factor) for one, factor in zip(self.size, scale, strict=True))),
        )

    def inertia(self, mass: float) -> InertiaTensor:
        """Return the inertia about the centre, in the axes of the frame, of that mass [kg] spread evenly [kg·m²]."""
        density = mass / self.volume
        xx, yy, zz = (density * one for one in self.spread)
        xy, xz, yz = (density * one for one in self.skew)
        return InertiaTensor(yy + zz, xx + zz, xx + yy, -xy, -xz, -yz)
