"""The orders of a document that mean something, for MuJoCo alone: those of shapes in a link, and of colors of one name.

It gives a shape without color that of the visual before it, and the first color of a name to all that only name it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.shape_order import KINDS, VISUAL, shown_colors
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import COLORS_REORDERED, SHAPES_REORDERED
from linkforge_compile.importers.draft import number_of
from linkforge_compile.source.xml_tree import XmlElement

if TYPE_CHECKING:
    from linkforge_compile.importers.said import Said

_Color: TypeAlias = tuple[float | None, ...]
"""The numbers of a color; None for a word that is none."""
_Shown: TypeAlias = "tuple[Said, _Color | None]"


def named_colors(robot: XmlElement) -> Iterator[tuple[XmlElement, str, _Color]]:
    """Yield each material with a color, its name and the numbers of the color, in the order of the document."""
    for child in robot.children:
        inside = child.children if child.tag == "link" else ()
        for material in [child] if child.tag == "material" else [one for shape in inside for one in shape.children]:
            color = _color_of(material) if material.tag == "material" else None
            if color is not None:
                yield material, material.get("name") or "", color


def recolored(robot: Said, again: Said) -> Iterator[Diagnostic]:
    """Yield where MuJoCo shows the first shape of a link in another color in what a robot compiles to, and why.

    What is kept raw comes behind all else there. A name is told once.
    """
    links = {link.element.get("name"): link for link in again.children if link.tag == "link"}
    first, ours = _first_colors(robot.element), _first_colors(again.element)
    told: set[str] = set()
    for link in robot.children:
        other = links.get(link.element.get("name")) if link.tag == "link" else None
        shape = _first_recolored(_shown(link, first), _shown(other, ours)) if other else None
        if shape is None:
            continue
        material = _material_of(shape)
        name = (material.get("name") or "") if material else ""
        if not material or name not in {*first, *ours}:
            yield SHAPES_REORDERED.at(shape.span, link=link.element.get("name"))
        elif name not in told:
            told.add(name)
            yield COLORS_REORDERED.at(material.span, name=name)


def _first_recolored(shapes: Iterable[_Shown], ours: Iterable[_Shown]) -> XmlElement | None:
    """Return the first of the shapes that is there as well, but not in its color; each is there as often as here."""
    left = Counter((shape.number, color) for shape, color in ours)
    there = {number for number, _ in left}
    for shape, color in shapes:
        if left[shape.number, color] > 0:
            left[shape.number, color] -= 1
        elif shape.number in there:
            return shape.element
    return None


def _shown(link: Said, named: Mapping[str, _Color]) -> Iterator[_Shown]:
    """Yield the shapes of a link with the color in which MuJoCo shows each, None for its gray."""
    shapes = [child for child in link.children if child.tag in KINDS]
    return zip(shapes, shown_colors(_own_color(shape.element, named) for shape in shapes), strict=True)


def _own_color(shape: XmlElement, named: Mapping[str, _Color]) -> _Color | None:
    material = _material_of(shape)
    if material is None:
        return None
    return _color_of(material) or named.get(material.get("name") or "")


def _material_of(shape: XmlElement) -> XmlElement | None:
    if shape.tag != VISUAL:
        return None
    return next((child for child in shape.children if child.tag == "material"), None)


def _color_of(material: XmlElement) -> _Color | None:
    color = next((child for child in material.children if child.tag == "color"), None)
    return tuple(map(number_of, (color.get("rgba") or "").split())) if color else None


def _first_colors(robot: XmlElement) -> dict[str, _Color]:
    return {name: color for _, name, color in reversed(list(named_colors(robot)))}
