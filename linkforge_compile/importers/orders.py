"""The orders of a document that mean something, for MuJoCo alone: those of shapes in a link, and of colors of one name.

It gives a collision the color of the visual before it, and the first color of a name to all that only name it.
"""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import COLORS_REORDERED, SHAPES_REORDERED
from linkforge_compile.importers.draft import number_of
from linkforge_compile.importers.xml import XmlElement
from linkforge_compile.shape_order import KINDS


def named_colors(robot: XmlElement) -> Iterator[tuple[XmlElement, str, tuple[float | None, ...]]]:
    """Yield each material with a color, its name and the numbers of the color, in the order of the document."""
    for child in robot.children:
        inside = child.children if child.tag == "link" else ()
        for material in [child] if child.tag == "material" else [one for shape in inside for one in shape.children]:
            color = next((one for one in material.children if one.tag == "color"), None)
            if material.tag == "material" and color:
                numbers = tuple(map(number_of, (color.get("rgba") or "").split()))
                yield material, material.get("name") or "", numbers


def reordered(robot: XmlElement, again: XmlElement) -> Iterator[Diagnostic]:
    """Yield where what a robot compiles to has such an order otherwise: what is kept raw comes behind all else."""
    yield from _shapes_reordered(robot, again)
    ours = {name: color for _, name, color in reversed(list(named_colors(again)))}
    all_named, first = {(name, color) for _, name, color in named_colors(robot)}, set[str]()
    for material, name, color in named_colors(robot):
        now = ours.get(name, color)
        if name not in first and now != color and (name, now) in all_named:
            yield COLORS_REORDERED.at(material.span, name=name)
        first.add(name)


def _shapes_reordered(robot: XmlElement, again: XmlElement) -> Iterator[Diagnostic]:
    ours = {link.get("name"): link for link in again.children if link.tag == "link"}
    for link in robot.children:
        other = ours.get(link.get("name")) if link.tag == "link" else None
        was, now = _shapes(link), _shapes(other) if other else []
        moved = next((one for one, another in zip(was, now, strict=False) if one.tag != another.tag), None)
        if moved and len(was) == len(now):
            yield SHAPES_REORDERED.at(moved.span, link=link.get("name"))


def _shapes(link: XmlElement) -> list[XmlElement]:
    return [child for child in link.children if child.tag in KINDS]
