"""Shapes of links: their geometry, their materials, and what both need to know about their file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from linkforge_compile.core.fields import NOT_ZERO, ZERO_TO_ONE
from linkforge_compile.core.models.geometry import (
    Box,
    Capsule,
    Color,
    Cylinder,
    Geometry,
    Material,
    Mesh,
    Sphere,
    Vector3,
)
from linkforge_compile.diagnostics import UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    EMPTY_MATERIAL,
    NO_GEOMETRY,
    NO_MESH_FILE,
    OUT_OF_RANGE,
    SEVERAL_GEOMETRIES,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_MATERIAL
from linkforge_compile.diagnostics.entry_fixes import as_items
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.load.locations import from_base, no_mesh
from linkforge_compile.lower.elements import extras_of, lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.lower.numbers import EXTENT, FRACTION, NumberType
from linkforge_compile.paths import path_base
from linkforge_compile.source import Located, SourceFile, SourceRef, Span
from linkforge_compile.syntax.colors import byte_as_component, color_as_list
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar

_FACTOR = NumberType(bound=NOT_ZERO)


@dataclass(frozen=True)
class FileScope:
    """`materials` are those that the file declares, `unresolved_materials` the faulty ones.

    `mesh_bases` are as in Instance. `meshes` reads the meshes that an inertia is computed from.
    """

    mesh_bases: Mapping[SourceFile, str] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    unresolved_materials: UnresolvedNames = field(default_factory=UnresolvedNames)
    meshes: MeshReader = field(default_factory=lambda: MeshReader(no_mesh, MeshSolids()))

    def resource(self, path: str, node: Located) -> str:
        """Return a path as the compiled file would write it, relative to the file that `node` was written in."""
        return from_base(path, self.mesh_bases.get(path_base(node).file, ""))


def lower_geometry(shape: Fields, scope: FileScope, extent: NumberType = EXTENT) -> Geometry | None:
    """Lower the one geometry of a visual or a collision, None for none, which is reported."""
    keys = [key for key in (*_PRIMITIVES, "mesh") if shape.get(key) is not None]
    if not keys:
        shape.report_incomplete(NO_GEOMETRY, owner=shape.title)
        return None
    if len(keys) > 1:
        first, second, *_ = keys
        entries = [(entry.key.span, entry.value.span) for entry in shape.node]
        fix = as_items(entries, "write a list") if len(keys) == len(entries) else None
        second_node = shape.node.entries[second].value
        shape.report(SEVERAL_GEOMETRIES, second_node, fixes=[fix], owner=shape.title, first=first, second=second)
        return None
    key, node = keys[0], shape.node.entries[keys[0]].value
    if key == "mesh":
        return _mesh(shape, node, scope)
    if key in _SHORT_FORMS and not isinstance(node, YamlMap):
        return _SHORT_FORMS[key](shape, node, extent)
    body = shape.map(key)
    return lower_element(_PRIMITIVES[key], body) if body else None


def _box(shape: Fields, node: YamlNode, extent: NumberType) -> Geometry | None:
    size = shape.vector3_at(node, "box", extent)
    return None if size is None else Box(size).with_source(SourceRef(node, None, shape.trail))


def _sphere(shape: Fields, node: YamlNode, extent: NumberType) -> Geometry | None:
    radius = shape.number_at(node, "sphere", extent)
    return None if radius is None else Sphere(radius).with_source(SourceRef(node, None, shape.trail))


def _mesh(shape: Fields, node: YamlNode, scope: FileScope) -> Geometry | None:
    if not isinstance(node, YamlMap):
        file = shape.text_at(node, "mesh")
        resource = None if file is None else _resource(shape, file, node, scope)
        return None if resource is None else Mesh(resource).with_source(SourceRef(node, None, shape.trail))
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


_PRIMITIVES = {"box": Box, "cylinder": Cylinder, "sphere": Sphere, "capsule": Capsule}
_SHORT_FORMS = {"box": _box, "sphere": _sphere}


_BYTE = 255
_LEAST_BYTE = 16
"""A list is read as a color in bytes if its largest number is at least this one; 2 is a slip for 0.2."""


def lower_materials(file: Fields, scope: FileScope) -> dict[str, Material | None]:
    """Lower the materials that a file declares, None for a faulty one."""
    return dict(file.each("materials", "material", lambda fields, name: _lower_material(fields, name, scope)))


def lower_visual_material(visual: Fields, scope: FileScope) -> Material | None:
    """Lower the material of a visual: the name of one that the file declares, or one written in place."""
    node = visual.node.get("material")
    if node is None:
        return None
    if isinstance(node, YamlMap):
        inline = visual.map_at(node, "material")
        return None if inline is None else _lower_material(inline, inline.text("name") or "", scope)
    name = visual.text_at(node, "material")
    if name is None:
        return None
    if name not in scope.materials and name not in scope.unresolved_materials:
        known = {*scope.materials, *scope.unresolved_materials.names}
        rgb = color_as_list(name)
        in_place = f"{{color: {rgb or '[r, g, b]'}}}"
        hint = "" if nearest(name, known) else f"; declare it in 'materials', or write '{in_place}'"
        fix = Replacement("", in_place).within(node.span) if hint and rgb else None
        visual.report(UNKNOWN_MATERIAL, node, near=sorted(known), fixes=[fix], name=name, hint=hint)
    return scope.materials.get(name)


def _lower_material(fields: Fields, name: str, scope: FileScope) -> Material | None:
    texture = fields.node.get("texture")
    if fields.node.get("color") is None and texture is None:
        comment = _color_in_comment(fields.node.key_span("color"))
        rgb = color_as_list(comment.text or "") if comment else None
        hint = f"; '{comment.text}' begins a comment: write '{rgb}'" if comment and rgb else ""
        fix = Replacement("", rgb, is_safe=True).within(comment) if rgb else None
        fields.report_incomplete(EMPTY_MATERIAL, fixes=[fix], owner=fields.title, hint=hint)
        return None
    color, file = _lower_color(fields), fields.text("texture")
    if color is None and file is None:
        return None
    image = scope.resource(file, texture) if file is not None and texture is not None else None
    return lower_element(Material, fields, name=name, color=color, texture=image)


def _color_in_comment(key: Span | None) -> Span | None:
    """Return the place of a color after its key as in style sheets, which YAML reads as a comment; None for none."""
    written = re.match(r":[ \t]+(#\S+)", key.file.line(key.line)[key.end_column - 1 :]) if key else None
    return (
        Span(*key).within(key.end_column - key.column + written.start(1), len(written[1])) if key and written else None
    )


def _lower_color(fields: Fields) -> Color | None:
    """Read `color`: red, green, blue and, unless it is 1, opacity, each from 0 to 1."""
    node = fields.node.get("color")
    long = fields.map_at(node, "color") if isinstance(node, YamlMap) else None
    numbers = node if long is None else long.get("rgba", required="[0.6, 0.6, 0.65]")
    if isinstance(numbers, YamlList) and (suggestion := _suggested_color(numbers)):
        found = f"[{', '.join(item.text for item in numbers if isinstance(item, YamlScalar))}]; write '{suggestion}'"
        bound = ZERO_TO_ONE.words
        fields.report(OUT_OF_RANGE, numbers, field="color", bound=bound, found=found, written="", instead=suggestion)
        return None
    if isinstance(numbers, YamlList) and _report_bytes(fields, numbers):
        return None
    rgba = None if numbers is None else fields.numbers_at(numbers, "color", FRACTION, 3, 4)
    if node is None or rgba is None:
        return None
    color = fields.build(lambda: Color(*rgba, **(extras_of(long) if long else {})))
    return color.with_source(long.ref if long else SourceRef(node, None, fields.trail)) if color else None


def _report_bytes(fields: Fields, numbers: YamlList) -> bool:
    """Report single components from 0 to 255, where the others are right; return whether there are any."""
    others = [item for item in numbers if not _is_component(item)]
    large = [byte for item in others if (byte := _byte(item)) is not None and byte >= _LEAST_BYTE]
    if len(large) < len(others):
        return False
    for item, byte in zip(others, large, strict=True):
        bound, instead = ZERO_TO_ONE.words, byte_as_component(byte)
        found = f"{byte}; write '{instead}'"
        fields.report(OUT_OF_RANGE, item, field="color", bound=bound, found=found, written=str(byte), instead=instead)
    return bool(large)


def _suggested_color(numbers: YamlList) -> str | None:
    """Return a color written from 0 to 255 as one from 0 to 1; None for any other list."""
    rgb = [byte for byte in map(_byte, numbers.items[:3]) if byte is not None]
    if len(rgb) < 3 or len(numbers) > 4 or max(rgb) < _LEAST_BYTE:
        return None
    opacity = _opacity(numbers.items[3]) if len(numbers) == 4 else "1"
    return f"[{', '.join((*map(byte_as_component, rgb), opacity))}]" if opacity else None


def _opacity(node: YamlNode) -> str | None:
    """Return the opacity of a color in bytes: from 0 to 1 as in style sheets, else in bytes as well."""
    if isinstance(node, YamlScalar) and _is_component(node):
        return node.text
    byte = _byte(node)
    return None if byte is None else byte_as_component(byte)


def _is_component(node: YamlNode) -> bool:
    """Whether a node is a number from 0 to 1."""
    value = node.value if isinstance(node, YamlScalar) else None
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= 1


def _byte(node: YamlNode) -> int | None:
    value = node.value if isinstance(node, YamlScalar) else None
    return value if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= _BYTE else None
