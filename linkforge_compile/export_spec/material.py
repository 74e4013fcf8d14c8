"""Materials as a spec writes them: those of the robot by their name, all others where they are used."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap, YamlNode


def written_material(pen: Pen, material: Material) -> YamlMap:
    """Return a material that stands under its name."""
    return pen.element(
        material,
        color=_color(pen, material.color),
        texture=pen.text(material.texture),
        after_links=pen.flag(material.after_links, default=False),
    )


def written_visual_material(pen: Pen, material: Material | None, materials: Mapping[str, Material]) -> YamlNode | None:
    """Return the name of a visual's material, or the whole of one that is not the robot's."""
    if material is None:
        return None
    if materials.get(material.name) == material:
        return pen.text(material.name)
    return pen.element(
        material,
        name=pen.text(material.name, default=""),
        color=_color(pen, material.color),
        texture=pen.text(material.texture),
    )


def _color(pen: Pen, color: Color | None) -> YamlNode | None:
    if color is None:
        return None
    rgba = color.to_tuple()
    numbers = pen.numbers(rgba[:3] if color.a == 1 and not pen.full else rgba)
    return pen.alone(pen.element(color, rgba=numbers), "rgba")
