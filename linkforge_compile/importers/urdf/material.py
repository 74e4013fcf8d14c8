"""Read materials of URDF: each name once for the robot, and differing ones where they are used."""

from __future__ import annotations

from linkforge_compile.importers.canonical import named_colors, visual_materials
from linkforge_compile.importers.element_reader import ElementReader, Named
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft, is_same
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar


class Palette:
    """The materials of a robot by name.

    URDF declares a material at the robot or in the first visual with its content; every other visual with the name
    only, also an earlier one, uses that.
    """

    def __init__(self, robot: XmlElement) -> None:
        self.materials: Named = {}
        self._definitions: dict[str, YamlMap] = {}
        self._after_links = _declared_after_links(robot)

    def read_declared(self, material: ElementReader) -> YamlNode:
        """Read a material that the robot declares."""
        name = material.attribute("name")
        if name.value in self.materials:
            raise CannotRepresentError(f"there is a material '{name.value}' already", name.span)
        definition = node = _definition(material)
        if material.element in self._after_links:
            true = YamlScalar("true", True, material.span)
            node = material.draft.map_of({**_entries(definition), "after_links": true}, material.span)
        self._definitions[name.value] = definition
        self.materials[name.value] = name, node
        return node

    def find_in_visuals(self, draft: SpecDraft, root: XmlElement) -> None:
        """Add the materials that visuals declare, for names that the robot does not."""
        for material in visual_materials(root):
            name = material.get("name")
            if name and name not in self.materials and material.children:
                reader = ElementReader(draft, material)
                attribute = reader.attribute("name")
                try:
                    node = self._definitions[name] = _definition(reader)
                except CannotRepresentError:
                    continue  # reported where the visual is read
                self.materials[name] = attribute, node

    def read_used(self, material: ElementReader) -> YamlNode:
        """Read the material of a visual: its name, or all of it if it differs from the robot's of this name."""
        name = material.attribute("name")
        known = self._definitions.get(name.value)
        if material.is_used_up():
            if known is None:
                raise CannotRepresentError(f"no material named '{name.value}' has a color or a texture", name.span)
            return material.draft.text(name.value, name)
        node = _definition(material)
        if known and is_same(known, node):
            return material.draft.text(name.value, name)
        name_node = material.draft.text(name.value, name) if name.value else None
        return material.draft.map_of({"name": name_node, **_entries(node)}, material.span)


def _definition(material: ElementReader) -> YamlMap:
    color, texture = material.optional("color", _color), material.child("texture", _texture)
    if color is None and texture is None:
        raise material.cannot_represent("it has neither a color nor a texture that the language can say")
    return material.map(color=color, texture=texture)


def _color(color: ElementReader) -> YamlNode:
    rgba = color.required_numbers("rgba", 4)
    if any(not 0 <= float(part) <= 1 for part in (color.element.get("rgba") or "").split()):
        raise color.cannot_represent(f"its components must be from 0 to 1, found '{color.element.get('rgba')}'")
    color.pass_rest_up()
    *rgb, opacity = rgba
    return color.draft.list_of(rgb, rgba) if is_same(opacity, color.draft.number("1", rgba)) else rgba


def _texture(texture: ElementReader) -> YamlNode:
    file = texture.required_text("filename")
    texture.pass_rest_up()
    return file


def _entries(node: YamlMap) -> dict[str, YamlNode]:
    return {entry.name: entry.value for entry in node}


def _declared_after_links(robot: XmlElement) -> set[XmlElement]:
    """Return the robot's materials whose name has another color in a visual before them."""
    own = {child for child in robot.children if child.tag == "material"}
    first: dict[str, object] = {}
    colors = ((material, first.setdefault(name, color) != color) for material, name, color in named_colors(robot))
    return {material for material, is_another in colors if is_another and material in own}
