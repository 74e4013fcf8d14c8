"""Shapes: `box`, `cylinder`, `sphere`, `capsule` or `mesh`, exactly one; a box and a sphere have short forms."""

from __future__ import annotations

from collections.abc import Callable

from linkforge_compile.core.fields import NOT_ZERO
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Vector3
from linkforge_compile.diagnostics.codes.model import NO_GEOMETRY, NO_MESH_FILE, SEVERAL_GEOMETRIES
from linkforge_compile.lower.elements import lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file_scope import FileScope
from linkforge_compile.lower.numbers import EXTENT, NumberType
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode

_FACTOR = NumberType(bound=NOT_ZERO)


def lower_geometry(shape: Fields, scope: FileScope) -> Geometry | None:
    """Lower the one geometry of a visual or a collision; None for none, which is reported."""
    keys = [key for key in _LOWER if shape.get(key) is not None]
    if not keys:
        shape.report_incomplete(NO_GEOMETRY, owner=shape.title)
        return None
    if len(keys) > 1:
        first, second, *_ = keys
        shape.report(
            SEVERAL_GEOMETRIES, shape.node.entries[second].value, owner=shape.title, first=first, second=second
        )
        return None
    return _LOWER[keys[0]](shape, shape.node.entries[keys[0]].value, scope)


def _box(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    if isinstance(node, YamlMap):
        return _described(Box, shape, "box")
    size = shape.vector3_at(node, "box", EXTENT)
    return None if size is None else Box(size, source=SourceRef(node, None, shape.trail))


def _sphere(shape: Fields, node: YamlNode, _scope: FileScope) -> Geometry | None:
    if isinstance(node, YamlMap):
        return _described(Sphere, shape, "sphere")
    radius = shape.number_at(node, "sphere", EXTENT)
    return None if radius is None else Sphere(radius, source=SourceRef(node, None, shape.trail))


def _described(kind: type[Box | Cylinder | Sphere | Capsule], shape: Fields, key: str) -> Geometry | None:
    body = shape.map(key)
    return lower_element(kind, body) if body else None


def _mesh(shape: Fields, node: YamlNode, scope: FileScope) -> Geometry | None:
    if not isinstance(node, YamlMap):
        file = shape.text_at(node, "mesh")
        resource = None if file is None else _resource(shape, file, node, scope)
        return None if resource is None else Mesh(resource, source=SourceRef(node, None, shape.trail))
    mesh = shape.map_at(node, "mesh")
    if mesh is None:
        return None
    file = mesh.text("file", required="meshes/part.stl")
    scale = _scale(mesh)
    resource = None if file is None or scale is None else _resource(mesh, file, node, scope)
    return lower_element(Mesh, mesh, resource=resource, scale=scale, is_scale_stated=node.child("scale") is not None)


def _resource(fields: Fields, file: str, node: YamlNode, scope: FileScope) -> str | None:
    """Return the file of a mesh as the output writes it, None for an empty path."""
    place = node.child("file") or node
    if not file.strip():
        fields.report(NO_MESH_FILE, place, owner=fields.title)
        return None
    return scope.resource(file, place)


def _scale(mesh: Fields) -> Vector3 | None:
    """Read `scale`, one number or one for each axis; 1 if absent."""
    node = mesh.node.get("scale")
    if node is None:
        return Vector3(1.0, 1.0, 1.0)
    if isinstance(node, YamlList):
        return mesh.vector3_at(node, "scale", _FACTOR)
    number = mesh.number_at(node, "scale", _FACTOR)
    return None if number is None else Vector3(number, number, number)


_LOWER: dict[str, Callable[[Fields, YamlNode, FileScope], Geometry | None]] = {
    "box": _box,
    "cylinder": lambda shape, _node, _scope: _described(Cylinder, shape, "cylinder"),
    "sphere": _sphere,
    "capsule": lambda shape, _node, _scope: _described(Capsule, shape, "capsule"),
    "mesh": _mesh,
}
