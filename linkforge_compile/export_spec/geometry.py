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
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import written_element
from linkforge_compile.syntax import YamlNode
from linkforge_compile.units import Dimension

_ZERO = Vector3(0.0, 0.0, 0.0)


def written_origin(builder: SpecBuilder, pose: Transform) -> YamlNode | None:
    """Return `[x, y, z]` for a pose that turns nothing, None for one that is not written."""
    if not (pose.is_written or builder.full):
        return None
    xyz, rpy = builder.numbers(pose.xyz, Dimension.LENGTH), builder.numbers(pose.rpy, Dimension.ANGLE)
    if builder.full:
        return builder.element(pose, xyz=xyz, rpy=rpy)
    if pose.rpy == _ZERO and not (pose.extra_elements or pose.extra_attributes):
        return xyz
    return builder.element(pose, xyz=None if pose.xyz == _ZERO else xyz, rpy=None if pose.rpy == _ZERO else rpy)


def written_geometry(builder: SpecBuilder, shape: Geometry) -> dict[str, YamlNode]:
    """Return the one entry that says what shape a visual or collision has."""
    return {str(shape.type): _WRITE[shape.type](builder, shape)}


def _box(builder: SpecBuilder, box: Box) -> YamlNode:
    return builder.alone(builder.element(box, size=builder.numbers(box.size, Dimension.LENGTH)), "size")


def _sphere(builder: SpecBuilder, sphere: Sphere) -> YamlNode:
    return builder.alone(written_element(builder, sphere), "radius")


def _mesh(builder: SpecBuilder, mesh: Mesh) -> YamlNode:
    return builder.alone(builder.element(mesh, file=builder.text(mesh.resource), scale=_scale(builder, mesh)), "file")


def _scale(builder: SpecBuilder, mesh: Mesh) -> YamlNode | None:
    scale = mesh.scale
    if builder.full:
        return builder.numbers(scale)
    if not mesh.is_scale_written:
        return None
    return builder.number(scale.x) if scale.x == scale.y == scale.z else builder.numbers(scale)


_WRITE: Mapping[GeometryType, Callable[..., YamlNode]] = {
    GeometryType.BOX: _box,
    GeometryType.CYLINDER: written_element,
    GeometryType.SPHERE: _sphere,
    GeometryType.CAPSULE: written_element,
    GeometryType.MESH: _mesh,
}
