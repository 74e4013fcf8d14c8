"""Read the links and joints of a URDF, with their materials."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TypeAlias

from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Material, Mesh, Sphere
from linkforge_compile.core.models.joint import AXES, HAVE_NO_AXIS, NEED_LIMITS, Joint, JointLimits, JointType
from linkforge_compile.core.models.link import COLLISION, KINDS, VISUAL, Collision, Inertial, Visual, shortest_setting
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.importing import ENDS_KEPT_RAW, MATERIAL_REPEATED, NEGATIVE_LIMIT
from linkforge_compile.importers.element_reader import ElementReader, Named
from linkforge_compile.importers.elements import Entries, Names, read_element, read_field, read_numbers, require_parts
from linkforge_compile.importers.plugin_data import Blocks
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft, is_same, number_of
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

SHAPES: Mapping[str, type[Element]] = {kind.TAG: kind for kind in (Box, Sphere, Cylinder, Capsule, Mesh)}
_SHAPE_AND_POSE = (*SHAPES, "origin")


Rgba: TypeAlias = tuple[float | None, ...]
"""The numbers of a color; None for a word that is none."""


def read_link(link: ElementReader, palette: Palette, blocks: Blocks) -> YamlMap:
    """Read a link whose name is taken, with the Gazebo blocks about it."""
    visuals = link.children("visual", partial(_visual, palette=palette))
    collisions = link.children("collision", _collision)
    shapes = {VISUAL: link.draft.one_or_list(visuals), COLLISION: _short_collisions(link, visuals, collisions)}
    kept_raw = set(link.remaining())
    read = [child for child in link.element.children if child.tag in KINDS and child not in kept_raw]
    kinds = [child.tag for child in read]
    return link.map(
        # The order of these keys is the order of the output.
        **dict(reversed(shapes.items()) if kinds[:1] == [COLLISION] else shapes),
        shape_order=_shape_order(link, kinds, read[0].span) if read else None,
        inertial=link.child("inertial", lambda inertial: read_element(inertial, Inertial)),
        gazebo=blocks.take(link.element.get("name") or ""),
    )


def _shape_order(link: ElementReader, kinds: list[str], where: Span) -> YamlNode | None:
    order = shortest_setting(kinds)
    if order is None or isinstance(order, str):
        return None if order is None else link.draft.text(order, where)
    return link.draft.list_of([link.draft.text(kind, where) for kind in order], where)


def _visual(visual: ElementReader, palette: Palette) -> YamlNode:
    return read_element(
        visual,
        Visual,
        first=_name_and_shape(visual),
        material=lambda visual: visual.child("material", palette.read_used),
    )


def _collision(collision: ElementReader) -> YamlNode:
    return read_element(collision, Collision, first=_name_and_shape(collision))


def _name_and_shape(owner: ElementReader) -> Entries:
    """Read the entries that come first in the language: a name, and the shape under its own key."""
    name, geometry = owner.text("name"), owner.required("geometry", _geometry)
    return {"name": name, **_entries(geometry)}


def _geometry(geometry: ElementReader) -> YamlMap:
    """Read a shape as a map with its tag as the only key."""
    shapes = geometry.remaining()
    if len(shapes) != 1:
        raise geometry.cannot_represent(f"a geometry is one shape, found {len(shapes) or 'none'}")
    [shape] = shapes
    kind = SHAPES.get(shape.tag)
    if kind is None:
        raise geometry.cannot_represent(f"there is no shape named '{shape.tag}'")
    node = geometry.read(shape, lambda reader: _shape(reader, kind))
    geometry.pass_rest_up()
    return geometry.draft.map_of({shape.tag: node}, shape)


def _shape(shape: ElementReader, kind: type[Element]) -> YamlNode:
    """Read a shape; one of which nothing but its first field is given is that alone."""
    node = read_element(shape, Mesh, scale=_scale) if kind is Mesh else read_element(shape, kind)
    [first, *others] = node
    return first.value if not others else node


def _scale(mesh: ElementReader) -> YamlNode | None:
    """Read the scale of a mesh: one number for three equal ones."""
    scale = read_field(mesh, Mesh, "scale")
    if not isinstance(scale, YamlList):
        return scale
    return scale.items[0] if all(is_same(item, scale.items[0]) for item in scale) else scale


def _entries(node: YamlNode) -> dict[str, YamlNode]:
    return {entry.name: entry.value for entry in node} if isinstance(node, YamlMap) else {}


def _short_collisions(link: ElementReader, visuals: list[YamlNode], collisions: list[YamlNode]) -> YamlNode | None:
    """Return `visual` for collisions that have the shapes and poses of all visuals and nothing else."""
    if link.draft.is_template or not are_shapes_of(visuals, collisions):
        return link.draft.one_or_list(collisions)
    copy = link.draft.text("visual", collisions[0].span)
    link.draft.note_same_source(copy, *collisions)
    return copy


def are_shapes_of(visuals: Sequence[YamlNode], collisions: Sequence[YamlNode]) -> bool:
    """Whether collisions have the shapes and poses of all visuals and nothing else."""
    bare = [_shape_and_pose(visual) for visual in visuals if isinstance(visual, YamlMap)]
    return bool(collisions) and len(bare) == len(collisions) and all(map(is_same, bare, collisions))


def _shape_and_pose(visual: YamlMap) -> YamlMap:
    entries = {entry.name: entry for entry in visual if entry.name in _SHAPE_AND_POSE}
    return YamlMap(entries, visual.place, visual.begin, visual.end)


JOINT_TYPES = tuple(map(str, JointType))
_WORDS: Mapping[tuple[float | None, ...], str] = {tuple(axis): word for word, axis in AXES.items()}


def read_joint(joint: ElementReader, names: Names, blocks: Blocks) -> YamlMap:
    """Read a joint whose name is taken, with the Gazebo blocks about it; `names` has those of all joints."""
    kind = joint.required_text("type")
    if kind.text not in JOINT_TYPES:
        raise joint.cannot_represent(f"there is no joint type named '{kind.text}'")
    joint_type = JointType(kind.text)
    return read_element(
        joint,
        Joint,
        joint_type.motion,
        names=names,
        type=lambda _: kind,
        axis=lambda joint: None if joint_type in HAVE_NO_AXIS else _axis_of(joint),
        limits=lambda joint: None if joint_type is JointType.FIXED else _limits_of(joint, joint_type),
        gazebo=lambda joint: blocks.take(joint.element.get("name") or ""),
    )


def _axis_of(joint: ElementReader) -> YamlNode | None:
    """Read the axis; a URDF without one means x, but the language requires it."""
    return joint.essential_child("axis", _axis) if joint.has_child("axis") else joint.draft.text("x", joint.span)


def _axis(axis: ElementReader) -> YamlNode:
    xyz = axis.numbers("xyz", 3)
    axis.pass_rest_up()
    if xyz is None:
        return axis.draft.text("x", axis.span)
    word = _WORDS.get(tuple(map(number_of, (axis.element.get("xyz") or "").split())))
    return axis.draft.text(word, xyz) if word else xyz


def _limits_of(joint: ElementReader, joint_type: JointType) -> YamlNode | None:
    if joint_type in NEED_LIMITS:
        return joint.essential_child("limit", lambda limit: _limits(limit, joint, joint_type))
    return joint.child("limit", lambda limit: _limits(limit, joint, joint_type))


def _limits(limit: ElementReader, joint: ElementReader, joint_type: JointType) -> YamlNode:
    lower, upper = (number_of(limit.element.get(name) or "0") for name in ("lower", "upper"))
    reversed_ends: tuple[str, ...] = ()
    if lower is not None and upper is not None and lower > upper:
        limit.draft.diagnostics.append(ENDS_KEPT_RAW.at(limit.span, lower=f"{lower:g}", upper=f"{upper:g}"))
        reversed_ends = ("lower", "upper")
    if joint_type not in NEED_LIMITS:
        require_parts(limit, JointLimits)
    zeros = dict(_zeros_for_negative(limit, joint)) if joint_type in NEED_LIMITS else {}
    # If a joint needs limits, incomplete ones are read, and compiling the spec reports what they lack.
    return limit.map(**read_numbers(limit, JointLimits, joint_type.motion, without=(*reversed_ends, *zeros)), **zeros)


def _zeros_for_negative(limit: ElementReader, joint: ElementReader) -> Iterator[tuple[str, YamlNode]]:
    """Yield 0 for an effort or velocity below 0, which urdfdom reads and Pinocchio refuses; vendors write -1."""
    for name in ("effort", "velocity"):
        value = number_of(limit.element.get(name) or "")
        if value is not None and value < 0:
            attribute, joint_name = limit.attribute(name), joint.element.get("name")
            report = NEGATIVE_LIMIT.at(attribute.span, joint=joint_name, name=name, value=attribute.value)
            limit.draft.diagnostics.append(report)
            yield name, limit.draft.word("0", attribute)


class Palette:
    """The materials of a robot by name.

    URDF declares a material at the robot or in the first visual with its content; every other visual with the name
    only, also an earlier one, uses that.
    """

    def __init__(self, robot: XmlElement) -> None:
        self.materials: Named = {}
        self._definitions: dict[str, YamlMap] = {}
        self._after_links = _declared_after_links(robot)

    def read_declared(self, material: ElementReader) -> YamlNode | None:
        """Read a material that the robot declares; None for one that repeats another."""
        name = material.attribute("name")
        if name.value in self.materials:
            first, _ = self.materials[name.value]
            is_at_fault = material.element in material.draft.at_fault
            if is_at_fault or not is_same(_definition(material), self._definitions[name.value]):
                raise CannotRepresentError(f"there is a material '{name.value}' already", name.span)
            notes = [Note("the other is here", first.span)]
            material.draft.diagnostics.append(MATERIAL_REPEATED.at(name.span, name=name.value, notes=notes))
            return None
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
    """Read what a material has besides its name."""
    if not (material.has_child("color") or material.has_child("texture")):
        raise material.cannot_represent("it has neither a color nor a texture that the language can say")
    return read_element(material, Material)


def _declared_after_links(robot: XmlElement) -> set[XmlElement]:
    """Return the robot's materials whose name has another color in a visual before them."""
    own = {child for child in robot.children if child.tag == "material"}
    first: dict[str, object] = {}
    colors = ((material, first.setdefault(name, color) != color) for material, name, color in named_colors(robot))
    return {material for material, is_another in colors if is_another and material in own}


def named_colors(robot: XmlElement) -> Iterator[tuple[XmlElement, str, Rgba]]:
    """Yield each material with a color, its name and the color, in the order of the document."""
    for child in robot.children:
        shapes = child.children if child.tag == "link" else ()
        for material in [child] if child.tag == "material" else [one for shape in shapes for one in shape.children]:
            color = color_of(material) if material.tag == "material" else None
            if color is not None:
                yield material, material.get("name") or "", color


def color_of(material: XmlElement) -> Rgba | None:
    """Return the color of a `<material>`, None for one without."""
    color = next((child for child in material.children if child.tag == "color"), None)
    return tuple(map(number_of, (color.get("rgba") or "").split())) if color else None


def visual_materials(robot: XmlElement) -> Iterator[XmlElement]:
    """Yield the materials in the visuals of a robot, in the order of the document."""
    for link in robot.children:
        for visual in link.children if link.tag == "link" else ():
            yield from (part for part in visual.children if visual.tag == "visual" and part.tag == "material")
