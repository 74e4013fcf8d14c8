"""Bounding boxes of the shapes of links, and the corners of COLLADA scenes that they are computed from."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Transform
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.physics import rotation_matrix

if TYPE_CHECKING:
    from lxml.etree import _Element

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
    return sum(volumes) if volumes and len(volumes) == len(shapes) else None


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


_END = 1024
"""How much of each end of an array is read [bytes]."""

_MAX_DEPTH = 50
"""How deeply nodes may be nested; a node may place itself."""

Corner: TypeAlias = tuple[float, float, float]
Matrix: TypeAlias = tuple[tuple[float, float, float, float], ...]
"""The first three rows of a homogeneous matrix."""

_IDENTITY: Matrix = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


class _UnsupportedError(Exception):
    """The scene has elements that a scan does not read, or exceeds the budget."""


class ScanBudget:
    """How many tags, nodes and corners of COLLADA scenes are scanned for one robot: half a million take a second."""

    def __init__(self, limit: int = 500_000) -> None:
        self._left = limit

    def try_spend(self, count: int) -> bool:
        """Count what is to be scanned; False if the budget is, or was, exceeded."""
        self._left -= count
        return self._left >= 0


def corners_of_scene(content: bytes, budget: ScanBudget) -> Sequence[Corner]:
    """Return corners of a scene where its nodes place them [m]; () where a scan cannot find them.

    A small file can place one shape again and again, so every step spends some of the budget. `<unit meter>` scales
    the scene, and `<up_axis>` turns nothing, as in core/meshes.
    """
    from lxml import etree

    from linkforge_compile.source.xml_tree import safe_parser

    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        return ()
    if not budget.try_spend(content.count(b"<")):
        return ()
    try:
        pieces = (piece if len(piece) <= 2 * _END else _shortened(piece) for piece in content.split(b"<"))
        return tuple(_Scene(etree.fromstring(b"<".join(pieces), safe_parser(remove_comments=True)), budget).corners())
    except (etree.XMLSyntaxError, ValueError, LookupError, _UnsupportedError):  # LookupError: an unknown id
        return ()


def _shortened(piece: bytes) -> bytes:
    """Return a tag with the ends of the text after it, each of whole triples of numbers.

    The text of other elements goes: all corners are taken, whatever the triangles.
    """
    tag, _, text = piece.partition(b">")
    if b"float_array" not in tag:
        return tag + b">"
    head, tail = text[:_END].split()[:-1], text[-_END:].split()[1:]
    return tag + b">" + b" ".join((*head[: len(head) // 3 * 3], *tail[len(tail) % 3 :]))


class _Scene:
    """A document whose arrays are cut."""

    def __init__(self, root: _Element, budget: ScanBudget) -> None:
        self._root, self._budget = root, budget
        self._by_id = {name: element for element in root.iter() if (name := element.get("id"))}

    def corners(self) -> Iterator[Corner]:
        unit = self._root.find("{*}asset/{*}unit")
        meter = float(unit.get("meter", "1")) if unit is not None else 1.0
        scene = self._root.find("{*}scene/{*}instance_visual_scene")
        shapes: dict[str, Sequence[Corner]] = {}
        for url, matrix in self._geometries(self._target(scene), _IDENTITY) if scene is not None else ():
            if url not in shapes:
                shapes[url] = self._shape(url)
            self._spend(len(shapes[url]))
            for corner in shapes[url]:
                x, y, z = (a * corner[0] + b * corner[1] + c * corner[2] + d for a, b, c, d in matrix)
                yield x * meter, y * meter, z * meter

    def _spend(self, count: int) -> None:
        if not self._budget.try_spend(count):
            raise _UnsupportedError

    def _target(self, instance: _Element) -> _Element:
        return self._by_id[instance.get("url", "").removeprefix("#")]

    def _geometries(self, node: _Element, around: Matrix, depth: int = 0) -> Iterator[tuple[str, Matrix]]:
        """Yield each geometry that a node places, with the matrix to the scene."""
        if depth > _MAX_DEPTH:
            raise _UnsupportedError
        self._spend(1 + len(node))
        matrix = around
        for part in node:
            match part.tag.rpartition("}")[2]:
                case "matrix" | "translate" | "rotate" | "scale" as kind:
                    matrix = _product(matrix, _transform(kind, part.text or ""))
                case "node":
                    yield from self._geometries(part, matrix, depth + 1)
                case "instance_node":
                    yield from self._geometries(self._target(part), matrix, depth + 1)
                case "instance_geometry":
                    yield part.get("url", "").removeprefix("#"), matrix
                case "instance_controller" | "lookat" | "skew":
                    raise _UnsupportedError

    def _shape(self, url: str) -> Sequence[Corner]:
        """Return the corners of a geometry in its own frame; none of one without a mesh."""
        position = self._by_id[url].find("{*}mesh/{*}vertices/{*}input[@semantic='POSITION']")
        if position is None:
            return ()
        source = self._by_id[position.get("source", "").removeprefix("#")]
        accessor, array = source.find("{*}technique_common/{*}accessor"), source.find("{*}float_array")
        if accessor is None or array is None or accessor.get("stride") != "3":
            raise _UnsupportedError
        numbers = [float(number) for number in (array.text or "").split()]
        return list(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))


def _matrix(*numbers: float) -> Matrix:
    if len(numbers) != 16:
        raise _UnsupportedError
    a, b, c, d, e, f, g, h, i, j, k, m = numbers[:12]
    return ((a, b, c, d), (e, f, g, h), (i, j, k, m))


def _rotation(x: float, y: float, z: float, degrees: float) -> Matrix:
    """Return the rotation about an axis of any length (Rodrigues)."""
    length = math.hypot(x, y, z)
    if not length:
        return _IDENTITY
    x, y, z = x / length, y / length, z / length
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    t = 1 - c
    return (
        (t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0),
        (t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0),
        (t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0),
    )


_TRANSFORMS: Mapping[str, Callable[..., Matrix]] = {
    "matrix": _matrix,
    "translate": lambda x, y, z: ((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z)),
    "rotate": _rotation,
    "scale": lambda x, y, z: ((x, 0, 0, 0), (0, y, 0, 0), (0, 0, z, 0)),
}


def _transform(kind: str, text: str) -> Matrix:
    try:
        return _TRANSFORMS[kind](*map(float, text.split()))
    except TypeError as error:  # too many numbers, or too few
        raise _UnsupportedError from error


def _product(left: Matrix, right: Matrix) -> Matrix:
    whole = (*right, (0.0, 0.0, 0.0, 1.0))
    columns = tuple(zip(*whole, strict=True))
    rows = [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in left]
    return tuple((a, b, c, d) for a, b, c, d in rows)
