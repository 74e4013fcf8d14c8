"""Geometry from plain numbers: shapes, poses, unit axes."""

from __future__ import annotations

import math
from typing import TypeAlias

from linkforge_compile.core.constants import EPSILON
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Mesh, Sphere, Transform, Vector3

Triple: TypeAlias = tuple[float, float, float]


def box(x: float, y: float, z: float) -> Box:
    """Return a cuboid by its full extents [m]."""
    return Box(Vector3(x, y, z))


def cylinder(radius: float, length: float) -> Cylinder:
    """Return a cylinder about its z axis [m]."""
    return Cylinder(radius, length)


def sphere(radius: float) -> Sphere:
    """Return a sphere [m]."""
    return Sphere(radius)


def capsule(radius: float, length: float) -> Capsule:
    """Return a cylinder about its z axis with half spheres beyond its length [m]."""
    return Capsule(radius, length)


def mesh(resource: str, scale: Triple = (1.0, 1.0, 1.0)) -> Mesh:
    """Return the shape in a file, a URI or a path."""
    return Mesh(resource, Vector3(*scale))


def pose(xyz: Triple | None, rpy: Triple | None) -> Transform:
    """Return the pose at `xyz` [m], turned by `rpy` [rad]; None for zeros."""
    return Transform(*(Vector3(0.0, 0.0, 0.0) if triple is None else Vector3(*triple) for triple in (xyz, rpy)))


def unit_axis(axis: Triple) -> Vector3:
    """Return the vector of length 1 in that direction.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a vector that has none.

    """
    length = math.hypot(*axis)
    if length < EPSILON:
        raise RobotValidationError(
            ValidationErrorCode.OUT_OF_RANGE,
            "Joint axis magnitude is too small",
            target="JointAxis",
            value=0.0,
            field=("axis",),
        )
    return Vector3(*(component / length for component in axis))
