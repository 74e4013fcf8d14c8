"""Shapes, told by their key: `box`, `cylinder`, `sphere`, `capsule` or `mesh`, exactly one."""

from __future__ import annotations

from collections.abc import Callable

from linkforge_compile.core.fields import NOT_ZERO
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Vector3
from linkforge_compile.diagnostics.codes.model import NO_GEOMETRY, NO_MESH_FILE, SEVERAL_GEOMETRIES
from linkforge_compile.lower.elements import lower_element
from linkforge_compile.lower.extra import CommonKwargs, common_kwargs
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import EXTENT, NumberType
from linkforge_compile.lower.scope import FileScope
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode

_FACTOR = NumberType(bound=NOT_ZERO)


def lower_geometry(shape: Fields, scope: FileScope) -> Geometry | None:
    """Lower the one geometry of a visual or a collision; None where it was told why there is none."""
    said = [key for key in shape.node.entries if key in _LOWER and shape.get(key) is not None]
    if not said:
        shape.report_incomplete(NO_GEOMETRY, owner=shape.title)
        return None
    if len(said) > 1:
        first, second, *_ = sorted(said, key=list(_LOWER).index)
        shape.report(
            SEVERAL_GEOMETRIES, shape.node.entries[second].value, owner=shape.title, first=first, second=second
        )
        return None
    key = said[0]
    return _LOWER[key](shape, shape.node.entries[key].value, scope)


def _box(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    body = shape.map_at(node, "box") if isinstance(node, YamlMap) else None
    if body:
        size, rest = body.vector3("size", EXTENT, required="[0.1, 0.1, 0.1]"), common_kwargs(body)
    else:
        size, rest = shape.vector3_at(node, "box", EXTENT), _short(shape, node)
    return None if size is None else Box(size, **rest)


def _cylinder(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    body = shape.map_at(node, "cylinder")
    return lower_element(Cylinder, body) if body else None


def _capsule(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    body = shape.map_at(node, "capsule")
    return lower_element(Capsule, body) if body else None


def _sphere(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    body = shape.map_at(node, "sphere") if isinstance(node, YamlMap) else None
    if body:
        return lower_element(Sphere, body)
    radius = shape.number_at(node, "sphere", EXTENT)
    return None if radius is None else Sphere(radius, **_short(shape, node))


def _mesh(shape: Fields, node: YamlNode, scope: FileScope) -> Geometry | None:
    if not isinstance(node, YamlMap):
        return _mesh_file(shape, shape.text_at(node, "mesh"), node, Vector3(1.0, 1.0, 1.0), scope, _short(shape, node))
    mesh = shape.map_at(node, "mesh")
    if mesh is None:
        return None
    file = mesh.text("file", required="meshes/part.stl")
    scale = _scale(mesh)
    return None if scale is None else _mesh_file(mesh, file, node, scale, scope, common_kwargs(mesh))


def _mesh_file(  # noqa: PLR0917 both forms of a mesh end here
    fields: Fields, file: str | None, node: YamlNode, scale: Vector3, scope: FileScope, rest: CommonKwargs
) -> Geometry | None:
    if file is None:
        return None
    if not file.strip():
        fields.report(NO_MESH_FILE, node.child("file") or node, owner=fields.title)
        return None
    resource = scope.resource(file, node.child("file") or node)
    return Mesh(resource, scale, is_scale_stated=node.child("scale") is not None, **rest)


def _scale(mesh: Fields) -> Vector3 | None:
    """Read `scale`, one number or one for each axis; 1 where nothing is said."""
    node = mesh.node.get("scale")
    if node is None:
        return Vector3(1.0, 1.0, 1.0)
    if isinstance(node, YamlList):
        return mesh.vector3_at(node, "scale", _FACTOR)
    number = mesh.number_at(node, "scale", _FACTOR)
    return None if number is None else Vector3(number, number, number)


def _short(shape: Fields, node: YamlNode) -> CommonKwargs:
    """Return what there is besides in a short form, which has no place for what is said raw."""
    return {"source": SourceRef(node, None, shape.trail)}


_LOWER: dict[str, Callable[[Fields, YamlNode, FileScope], Geometry | None]] = {
    "box": _box,
    "cylinder": _cylinder,
    "sphere": _sphere,
    "capsule": _capsule,
    "mesh": _mesh,
}
