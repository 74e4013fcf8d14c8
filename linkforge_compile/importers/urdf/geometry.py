"""Poses and shapes of URDF."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.importers.urdf.quaternion import rpy_of_quaternion
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension


def read_origin(origin: ElementReader) -> YamlNode | None:
    """Read a pose: `[x, y, z]` where it turns nothing, None where it is the identity."""
    xyz, rpy = origin.numbers("xyz", 3), origin.numbers("rpy", 3, Dimension.ANGLE)
    if rpy is None and origin.draft.has_quaternions:
        rpy = rpy_of_quaternion(origin)
    xyz, rpy = _unless_zero(xyz), _unless_zero(rpy)
    node = origin.map(xyz=xyz, rpy=rpy)
    if not len(node):
        return None
    return xyz if xyz and len(node) == 1 else node


def read_geometry(geometry: ElementReader) -> YamlMap:
    """Read the one shape of a visual or collision, as a map of the one entry that says it."""
    shapes = geometry.remaining()
    if len(shapes) != 1:
        raise geometry.cannot_represent(f"a geometry is one shape, found {len(shapes) or 'none'}")
    [shape] = shapes
    read = _READ.get(shape.tag)
    if read is None:
        raise geometry.cannot_represent(f"there is no shape named '{shape.tag}'")
    node = geometry.read(shape, read)
    geometry.pass_rest_up()
    return geometry.draft.map_of({shape.tag: node}, shape)


def _box(box: ElementReader) -> YamlNode:
    size = box.numbers("size", 3)
    if size is None:
        raise box.cannot_represent("it has no 'size'")
    if any(_value(item) <= 0 for item in size):
        raise box.cannot_represent(f"every side must be above 0, found '{box.element.get('size')}'")
    box.pass_rest_up()
    return size


def _sphere(sphere: ElementReader) -> YamlNode:
    radius = sphere.required_number("radius", above=0)
    return radius if sphere.is_used_up() else sphere.map(radius=radius)


def _round(body: ElementReader) -> YamlNode:
    return body.map(radius=body.required_number("radius", above=0), length=body.required_number("length", above=0))


def _mesh(mesh: ElementReader) -> YamlNode:
    file, scale = mesh.required_text("filename"), mesh.numbers("scale", 3)
    if not file.text.strip():
        raise mesh.cannot_represent("it names no file")
    node = mesh.map(file=file, scale=_scale(mesh, scale) if scale else None)
    return file if len(node) == 1 else node


def _scale(mesh: ElementReader, scale: YamlList) -> YamlNode | None:
    """Return one number for three that are the same, None for 1."""
    factors = {_value(item) for item in scale}
    if 0 in factors:
        raise mesh.cannot_represent(f"no scale may be 0, found '{mesh.element.get('scale')}'")
    if len(factors) > 1:
        return scale
    return None if factors == {1.0} else scale.items[0]


def _unless_zero(numbers: YamlList | None) -> YamlList | None:
    return numbers if numbers and any(_value(item) for item in numbers) else None


def _value(node: YamlNode) -> float:
    """Return what a number says; anything but 0 for an angle in degrees."""
    return (number_of(node.text) or 0.0) if isinstance(node, YamlScalar) and not isinstance(node.value, str) else 1.0


_READ: Mapping[str, Callable[[ElementReader], YamlNode]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _round,
    "capsule": _round,
    "mesh": _mesh,
}
