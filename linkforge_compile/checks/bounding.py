"""Bounding boxes of the shapes of links, and volumes of primitive shapes."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Transform
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.physics import rotation_matrix

Shapes: TypeAlias = Sequence[Visual] | Sequence[Collision] | Sequence[Visual | Collision]

MESH_SLACK = 10.0
"""The factor on bounds where meshes are measured: they may be hollow, and a link may hold more than is drawn."""


class BoundingBox(NamedTuple):
    """A box along the axes of a frame, from its lowest to its highest corner [m]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @classmethod
    def around(cls, points: Iterable[Sequence[float]]) -> BoundingBox | None:
        """Return the box around points, None without any."""
        axes = list(zip(*points, strict=True))
        if not axes:
            return None
        (x, y, z), (to_x, to_y, to_z) = map(min, axes), map(max, axes)
        return cls((x, y, z), (to_x, to_y, to_z))

    @property
    def diagonal(self) -> float:
        """The distance between the two corners [m]."""
        return math.dist(self.low, self.high)

    @property
    def sides(self) -> tuple[float, ...]:
        """The length along each axis [m]."""
        return tuple(high - low for low, high in zip(self.low, self.high, strict=True))

    def distance(self, point: Iterable[float]) -> float:
        """Return the distance of a point outside [m]; 0 inside."""
        axes = zip(self.low, point, self.high, strict=True)
        return math.hypot(*(max(low - at, 0.0, at - high) for low, at, high in axes))


class BoundingVolume(NamedTuple):
    """The box around the shapes of a link, and whether meshes are among them."""

    box: BoundingBox
    has_meshes: bool

    @property
    def slack(self) -> float:
        """The factor on bounds, as the box of a mesh is that of some of its corners."""
        return MESH_SLACK if self.has_meshes else 1.0

    @property
    def volume(self) -> float:
        """The volume of the box [m³]; a flat mesh counts as a plate of a hundredth of its diagonal."""
        thinnest = self.box.diagonal / 100 if self.has_meshes else 0.0
        return math.prod(max(side, thinnest) for side in self.box.sides)


MeasureMesh: TypeAlias = Callable[[Mesh], BoundingBox | None]
"""Returns the box around a mesh in its own frame [m], None where it cannot be measured."""


def bounding_volume(link: Link, measure: MeasureMesh) -> BoundingVolume | None:
    """Return the box around all shapes of a link; around its collisions, or its visuals, if others are unknown."""
    visuals = [_box_of(shape.geometry, shape.origin, measure) for shape in link.visuals]
    collisions = [_box_of(shape.geometry, shape.origin, measure) for shape in link.collisions]
    both: Shapes = (*link.visuals, *link.collisions)
    for shapes, boxes in ((both, [*visuals, *collisions]), (link.collisions, collisions), (link.visuals, visuals)):
        known = [box for box in boxes if box]
        if len(known) == len(boxes) and (whole := BoundingBox.around(corner for box in known for corner in box)):
            return BoundingVolume(whole, any(isinstance(shape.geometry, Mesh) for shape in shapes))
    return None


def primitive_volume(shapes: Shapes) -> float | None:
    """Return the sum of the volumes of shapes [m³]; None without any, and for meshes."""
    volumes = [shape.geometry.volume() for shape in shapes if not isinstance(shape.geometry, Mesh)]
    return math.fsum(volumes) if volumes and len(volumes) == len(shapes) else None


def _box_of(geometry: Geometry, pose: Transform, measure: MeasureMesh) -> BoundingBox | None:
    half, middle = _half_size(geometry), (0.0, 0.0, 0.0)
    if isinstance(geometry, Mesh) and (box := measure(geometry)):
        half = tuple(side / 2 for side in box.sides)
        x, y, z = (low + side for low, side in zip(box.low, half, strict=True))
        middle = (x, y, z)
    if half is None:
        return None
    place, turn = pose.xyz, pose.rpy
    if turn.x or turn.y or turn.z:
        matrix = rotation_matrix(turn)
        half = tuple(sum(map(operator.mul, map(abs, row), half)) for row in matrix)
        x, y, z = (sum(map(operator.mul, row, middle)) for row in matrix)
        middle = (x, y, z)
    x, y, z = place.x + middle[0], place.y + middle[1], place.z + middle[2]
    return BoundingBox((x - half[0], y - half[1], z - half[2]), (x + half[0], y + half[1], z + half[2]))


def _half_size(geometry: Geometry) -> tuple[float, ...] | None:
    """Return half the size of a shape along its own axes [m]."""
    match geometry:
        case Box():
            return tuple(size / 2 for size in geometry.size)
        case Sphere():
            return (geometry.radius,) * 3
        case Cylinder():
            return geometry.radius, geometry.radius, geometry.length / 2
        case Capsule():
            return geometry.radius, geometry.radius, geometry.length / 2 + geometry.radius
        case Mesh():
            return None
