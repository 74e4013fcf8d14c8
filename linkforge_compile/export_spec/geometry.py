"""Write shapes as a spec does: `box: [x, y, z]`, `sphere: radius`, `mesh: file`."""

from __future__ import annotations

from linkforge_compile.core.models.geometry import Box, Geometry, Mesh, Sphere
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_element
from linkforge_compile.syntax import YamlNode


def export_geometry(builder: SpecBuilder, shape: Geometry) -> dict[str, YamlNode]:
    """Return the shape of a visual or collision under its key."""
    node: YamlNode
    match shape:
        case Box():
            node = builder.alone(export_element(builder, shape), "size")
        case Sphere():
            node = builder.alone(export_element(builder, shape), "radius")
        case Mesh():
            node = builder.alone(export_element(builder, shape, scale=_scale(builder, shape)), "file")
        case _:
            node = export_element(builder, shape)
    return {str(shape.type): node}


def _scale(builder: SpecBuilder, mesh: Mesh) -> YamlNode | None:
    """Return one number for three equal ones; None for a scale that is not written."""
    scale = mesh.scale
    if builder.full:
        return builder.numbers(scale)
    if not mesh.is_scale_written:
        return None
    return builder.number(scale.x) if scale.x == scale.y == scale.z else builder.numbers(scale)
