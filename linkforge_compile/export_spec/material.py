"""Materials as a spec writes them: those of the robot by their name, all others where they are used."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.syntax import YamlMap, YamlNode


def written_material(builder: SpecBuilder, material: Material) -> YamlMap:
    """Return a material that stands under its name."""
    return builder.element(
        material,
        color=_color(builder, material.color),
        texture=builder.text(material.texture),
        after_links=builder.flag(material.after_links, default=False),
    )


def written_visual_material(
    builder: SpecBuilder, material: Material | None, materials: Mapping[str, Material]
) -> YamlNode | None:
    """Return the name of a visual's material, or the whole of one that is not the robot's."""
    if material is None:
        return None
    if materials.get(material.name) == material:
        return builder.text(material.name)
    return builder.element(
        material,
        name=builder.text(material.name, default=""),
        color=_color(builder, material.color),
        texture=builder.text(material.texture),
    )


def _color(builder: SpecBuilder, color: Color | None) -> YamlNode | None:
    if color is None:
        return None
    rgba = color.to_tuple()
    numbers = builder.numbers(rgba[:3] if color.a == 1 and not builder.full else rgba)
    return builder.alone(builder.element(color, rgba=numbers), "rgba")
