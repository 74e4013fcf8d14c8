"""Shapes and poses as a spec writes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkforge_compile.core.models.geometry import (
    Box,
    Geometry,
    GeometryType,
    Mesh,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.export_spec.elements import written_element
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlNode
from linkforge_compile.units import Dimension

_ZERO = Vector3(0.0, 0.0, 0.0)


def written_origin(pen: Pen, pose: Transform) -> YamlNode | None:
    """Return `[x, y, z]` for a pose that turns nothing, None for one that is not written."""
    if not (pose.is_written or pen.full):
        return None
    xyz, rpy = pen.numbers(pose.xyz, Dimension.LENGTH), pen.numbers(pose.rpy, Dimension.ANGLE)
    if pen.full:
        return pen.element(pose, xyz=xyz, rpy=rpy)
    if pose.rpy == _ZERO and not (pose.extra_elements or pose.extra_attributes):
        return xyz
    return pen.element(pose, xyz=None if pose.xyz == _ZERO else xyz, rpy=None if pose.rpy == _ZERO else rpy)


def written_geometry(pen: Pen, shape: Geometry) -> dict[str, YamlNode]:
    """Return the one entry that says what shape a visual or collision has."""
    return {str(shape.type): _WRITE[shape.type](pen, shape)}


def _box(pen: Pen, box: Box) -> YamlNode:
    return pen.alone(pen.element(box, size=pen.numbers(box.size, Dimension.LENGTH)), "size")


def _sphere(pen: Pen, sphere: Sphere) -> YamlNode:
    return pen.alone(written_element(pen, sphere), "radius")


def _mesh(pen: Pen, mesh: Mesh) -> YamlNode:
    return pen.alone(pen.element(mesh, file=pen.text(mesh.resource), scale=_scale(pen, mesh)), "file")


def _scale(pen: Pen, mesh: Mesh) -> YamlNode | None:
    scale = mesh.scale
    if pen.full:
        return pen.numbers(scale)
    if not mesh.is_scale_written:
        return None
    return pen.number(scale.x) if scale.x == scale.y == scale.z else pen.numbers(scale)


_WRITE: Mapping[GeometryType, Callable[..., YamlNode]] = {
    GeometryType.BOX: _box,
    GeometryType.CYLINDER: written_element,
    GeometryType.SPHERE: _sphere,
    GeometryType.CAPSULE: written_element,
    GeometryType.MESH: _mesh,
}
