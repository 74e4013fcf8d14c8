"""Materials of URDF: each name once for the robot, whatever differs from it where it stands."""

from __future__ import annotations

from linkforge_compile.importers.canonical import named_colors
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft, is_same
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

Named = dict[str, tuple[XmlAttribute, YamlNode]]


class Palette:
    """The materials of a robot by name.

    URDF declares a material for all visuals, or where it is first used; who names it without saying it, be it
    before, means that one. `declared` takes the robot's own, `found` the first of each name in a visual.
    """

    def __init__(self, robot: XmlElement) -> None:
        self.materials: Named = {}
        self._said: dict[str, YamlMap] = {}
        self._painted_before = _painted_before(robot)

    def declare(self, material: ElementReader) -> YamlNode:
        """Read a material of the robot itself."""
        name = material.attribute("name")
        if name.value in self.materials:
            raise CannotRepresentError(f"there is a material '{name.value}' already", name.span)
        said = node = _definition(material)
        if material.element in self._painted_before:
            true = YamlScalar("true", True, material.span)
            node = material.draft.map_of({**_entries(said), "after_links": true}, material.span)
        self._said[name.value] = said
        self.materials[name.value] = name, node
        return node

    def find(self, draft: SpecDraft, root: XmlElement) -> None:
        """Take in what visuals say, for the names that the robot does not declare."""
        for material in _materials_of_visuals(root):
            name = material.get("name")
            if name and name not in self.materials and material.children:
                reading = ElementReader(draft, material)
                taken = reading.attribute("name")
                try:
                    node = self._said[name] = _definition(reading)
                except CannotRepresentError:
                    continue  # told where the visual is read
                self.materials[name] = taken, node

    def used(self, material: ElementReader) -> YamlNode:
        """Read the material of a visual: a name, or the whole of one that is another than the robot's of this name."""
        name = material.attribute("name")
        known = self._said.get(name.value)
        if material.is_used_up():
            if known is None:
                raise CannotRepresentError(f"no material named '{name.value}' has a color or a texture", name.span)
            return material.draft.text(name.value, name)
        node = _definition(material)
        if known and is_same(known, node):
            return material.draft.text(name.value, name)
        said = material.draft.text(name.value, name) if name.value else None
        return material.draft.map_of({"name": said, **_entries(node)}, material.span)


def _definition(material: ElementReader) -> YamlMap:
    color, texture = material.optional("color", _color), material.child("texture", _texture)
    if color is None and texture is None:
        raise material.cannot_represent("it has neither a color nor a texture that the language can say")
    return material.map(color=color, texture=texture)


def _color(color: ElementReader) -> YamlNode:
    rgba = color.numbers("rgba", 4)
    if rgba is None:
        raise color.cannot_represent("it has no 'rgba'")
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


def _materials_of_visuals(root: XmlElement) -> list[XmlElement]:
    visuals = [visual for link in root.children if link.tag == "link" for visual in link.children]
    return [one for visual in visuals if visual.tag == "visual" for one in visual.children if one.tag == "material"]


def _painted_before(robot: XmlElement) -> set[XmlElement]:
    """Return the robot's materials whose name a visual that stands before them gives to another color."""
    own = {child for child in robot.children if child.tag == "material"}
    first: dict[str, object] = {}
    colors = ((material, first.setdefault(name, color) != color) for material, name, color in named_colors(robot))
    return {material for material, is_another in colors if is_another and material in own}
