"""How much room the shapes of a link take: boxes along its axes, and the volume in them."""

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
"""How much farther bounds lie for meshes: they may be hollow, and more may hang on a link than is drawn."""


class Extent(NamedTuple):
    """A box along the axes of a link, from its lowest to its highest corner [m]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @property
    def diagonal(self) -> float:
        """How far the corners are apart [m]."""
        return math.dist(self.low, self.high)

    @property
    def sides(self) -> tuple[float, ...]:
        """How long it is along each axis [m]."""
        return tuple(high - low for low, high in zip(self.low, self.high, strict=True))

    @property
    def volume(self) -> float:
        """The volume [m³]."""
        return math.prod(self.sides)

    def distance(self, point: Iterable[float]) -> float:
        """Return how far a point lies outside [m]; 0 inside."""
        axes = zip(self.low, point, self.high, strict=True)
        return math.hypot(*(max(low - at, 0.0, at - high) for low, at, high in axes))


MeasureMesh: TypeAlias = Callable[[Mesh], Extent | None]
"""Returns the box around a mesh in its own frame [m], None where it cannot be measured."""


def extents_of(shapes: Iterable[Visual | Collision], measure: MeasureMesh) -> list[Extent | None]:
    """Return the box of each shape, None for a mesh that cannot be measured."""
    return [_extent(shape.geometry, shape.origin, measure) for shape in shapes]


def around(extents: Sequence[Extent | None]) -> Extent | None:
    """Return the box that holds all of the boxes; None without any, and where one is not known."""
    known = [extent for extent in extents if extent]
    if not known or len(known) < len(extents):
        return None
    if len(known) == 1:
        return known[0]
    lows, highs = zip(*(extent.low for extent in known), strict=True), zip(*(one.high for one in known), strict=True)
    (x, y, z), (to_x, to_y, to_z) = map(min, lows), map(max, highs)
    return Extent((x, y, z), (to_x, to_y, to_z))


class Room(NamedTuple):
    """The box around the shapes of a link, and whether meshes are among them."""

    box: Extent
    is_of_meshes: bool

    @property
    def slack(self) -> float:
        """How far a bound is moved because the box is that of a few corners."""
        return MESH_SLACK if self.is_of_meshes else 1.0

    @property
    def volume(self) -> float:
        """The volume of the box [m³]; a sheet of triangles counts for a plate."""
        thinnest = self.box.diagonal / 100 if self.is_of_meshes else 0.0
        return math.prod(max(side, thinnest) for side in self.box.sides)


def room_of(link: Link, measure: MeasureMesh) -> Room | None:
    """Return the room of all shapes of a link, or of those to touch or to see where the others are unknown."""
    seen, touched = extents_of(link.visuals, measure), extents_of(link.collisions, measure)
    both: Shapes = (*link.visuals, *link.collisions)
    for shapes, boxes in ((both, [*seen, *touched]), (link.collisions, touched), (link.visuals, seen)):
        if box := around(boxes):
            return Room(box, any(isinstance(shape.geometry, Mesh) for shape in shapes))
    return None


def volume_of(shapes: Shapes) -> float | None:
    """Return the volumes of the shapes, added up [m³]; None without any, and for meshes."""
    volumes = [shape.geometry.volume() for shape in shapes if not isinstance(shape.geometry, Mesh)]
    return math.fsum(volumes) if volumes and len(volumes) == len(shapes) else None


def _extent(geometry: Geometry, pose: Transform, measure: MeasureMesh) -> Extent | None:
    half, middle = _half(geometry), (0.0, 0.0, 0.0)
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
    return Extent((x - half[0], y - half[1], z - half[2]), (x + half[0], y + half[1], z + half[2]))


def _half(geometry: Geometry) -> tuple[float, ...] | None:
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
