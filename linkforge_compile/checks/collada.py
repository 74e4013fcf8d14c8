"""COLLADA at a first look: the corners of a scene, as far as the ends of its arrays of numbers tell.

The long arrays are cut before anything is parsed, so that a look takes a few milliseconds for a file of megabytes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

    from linkforge_compile.checks.mesh_files import Effort

_END = 1024
"""How much of each end of an array is looked at [bytes]."""

_DEEPEST = 50
"""How deep in one another nodes are looked at; a node may be placed in itself."""

Corner: TypeAlias = tuple[float, float, float]
Matrix: TypeAlias = tuple[tuple[float, float, float, float], ...]
"""The first three rows of a homogeneous matrix."""

_IDENTITY: Matrix = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


class _UnknownError(Exception):
    """The scene is made of what a first look does not understand, or has no time for."""


def corners_of_scene(content: bytes, effort: Effort) -> Sequence[Corner]:
    """Return corners of a scene where its nodes place them [m]; () where that cannot be told at a look.

    Small files can ask for much, as nodes place one shape again and again, so the effort is counted. `<unit meter>`
    scales all of it, and `<up_axis>` turns nothing, as where meshes are read whole.
    """
    from lxml import etree

    from linkforge_compile.source.xml_tree import safe_parser

    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        return ()
    if not effort.takes(content.count(b"<")):
        return ()
    try:
        pieces = (piece if len(piece) <= 2 * _END else _shortened(piece) for piece in content.split(b"<"))
        root = etree.fromstring(b"<".join(pieces), safe_parser(remove_comments=True))
        corners = tuple(_Scene(root, effort).corners())
    except (etree.XMLSyntaxError, ValueError, LookupError, _UnknownError):  # LookupError: of ids and encodings
        return ()
    return corners if all(math.isfinite(at) for corner in corners for at in corner) else ()


def _shortened(piece: bytes) -> bytes:
    """Return a tag and the long text behind it with the ends of that only, each of whole triples of numbers.

    Indices go, as all corners are taken.
    """
    tag, _, text = piece.partition(b">")
    if b"float_array" not in tag:
        return tag + b">"
    head, tail = text[:_END].split()[:-1], text[-_END:].split()[1:]
    return tag + b">" + b" ".join((*head[: len(head) // 3 * 3], *tail[len(tail) % 3 :]))


class _Scene:
    """A document whose arrays are cut."""

    def __init__(self, root: Element, effort: Effort) -> None:
        self._root, self._effort = root, effort
        for element in root.iter():
            element.tag = element.tag.rpartition("}")[2]
        self._by_id = {name: element for element in root.iter() if (name := element.get("id"))}

    def corners(self) -> Iterator[Corner]:
        unit = self._root.find("asset/unit")
        meter = float(unit.get("meter", "1")) if unit is not None else 1.0
        scene = self._root.find("scene/instance_visual_scene")
        shapes: dict[str, Sequence[Corner]] = {}
        for url, matrix in self._geometries(self._at(scene), _IDENTITY) if scene is not None else ():
            if url not in shapes:
                shapes[url] = self._shape(url)
            self._spend(len(shapes[url]))
            for corner in shapes[url]:
                yield _scaled(_moved(corner, matrix), meter)

    def _spend(self, count: int) -> None:
        if not self._effort.takes(count):
            raise _UnknownError

    def _at(self, instance: Element) -> Element:
        return self._by_id[instance.get("url", "").removeprefix("#")]

    def _geometries(self, node: Element, around: Matrix, depth: int = 0) -> Iterator[tuple[str, Matrix]]:
        """Yield each geometry that a node places, with the matrix to the scene."""
        if depth > _DEEPEST:
            raise _UnknownError
        self._spend(1 + len(node))
        matrix = around
        for part in node:
            match part.tag:
                case "matrix" | "translate" | "rotate" | "scale":
                    matrix = _product(matrix, _transform(part))
                case "node":
                    yield from self._geometries(part, matrix, depth + 1)
                case "instance_node":
                    yield from self._geometries(self._at(part), matrix, depth + 1)
                case "instance_geometry":
                    yield part.get("url", "").removeprefix("#"), matrix
                case "instance_controller" | "lookat" | "skew":
                    raise _UnknownError

    def _shape(self, url: str) -> Sequence[Corner]:
        """Return the corners of a geometry in its own frame; none of one without a mesh."""
        given = self._by_id[url].find("mesh/vertices/input[@semantic='POSITION']")
        if given is None:
            return ()
        source = self._by_id[given.get("source", "").removeprefix("#")]
        accessor, array = source.find("technique_common/accessor"), source.find("float_array")
        if accessor is None or array is None or accessor.get("stride") != "3":
            raise _UnknownError
        numbers = [float(number) for number in (array.text or "").split()]
        return list(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))


def _matrix(*numbers: float) -> Matrix:
    if len(numbers) != 16:
        raise _UnknownError
    a, b, c, d, e, f, g, h, i, j, k, m = numbers[:12]
    return ((a, b, c, d), (e, f, g, h), (i, j, k, m))


def _translation(x: float, y: float, z: float) -> Matrix:
    return ((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z))


def _scaling(x: float, y: float, z: float) -> Matrix:
    return ((x, 0, 0, 0), (0, y, 0, 0), (0, 0, z, 0))


def _turn(x: float, y: float, z: float, degrees: float) -> Matrix:
    """Return the turn about an axis, of any length (Rodrigues)."""
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
    "translate": _translation,
    "rotate": _turn,
    "scale": _scaling,
}


def _transform(part: Element) -> Matrix:
    try:
        return _TRANSFORMS[part.tag](*map(float, (part.text or "").split()))
    except TypeError as error:  # of more numbers, or fewer
        raise _UnknownError from error


def _product(left: Matrix, right: Matrix) -> Matrix:
    whole = (*right, (0.0, 0.0, 0.0, 1.0))
    columns = tuple(zip(*whole, strict=True))
    rows = [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in left]
    return tuple((a, b, c, d) for a, b, c, d in rows)


def _moved(corner: Corner, matrix: Matrix) -> Corner:
    x, y, z = (a * corner[0] + b * corner[1] + c * corner[2] + d for a, b, c, d in matrix)
    return x, y, z


def _scaled(corner: Corner, factor: float) -> Corner:
    x, y, z = corner
    return x * factor, y * factor, z * factor
