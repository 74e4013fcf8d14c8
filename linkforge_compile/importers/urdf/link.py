"""Links of URDF."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import SpecDraft, is_same
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.importers.urdf.geometry import read_geometry, read_origin
from linkforge_compile.importers.urdf.material import Palette
from linkforge_compile.shape_order import COLLISION, KINDS, VISUAL, as_said
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlMap, YamlNode

_MOMENTS = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")


def read_link(link: ElementReader, palette: Palette, blocks: Blocks) -> YamlMap:
    """Read a link, whose name is taken; `blocks` has what a simulator is told about it."""
    visuals = link.children("visual", partial(_visual, palette=palette))
    collisions = link.children("collision", _collision)
    shapes = {VISUAL: link.draft.one_or_list(visuals), COLLISION: _collisions(link, visuals, collisions)}
    kept_raw = set(link.remaining())
    read = [child for child in link.element.children if child.tag in KINDS and child not in kept_raw]
    kinds = [child.tag for child in read]
    return link.map(
        # Their order is that of the output.
        **dict(reversed(shapes.items()) if kinds[:1] == [COLLISION] else shapes),
        shape_order=_shape_order(link.draft, as_said(kinds), read[0].span) if read else None,
        inertial=link.child("inertial", _inertial),
        gazebo=blocks.beside(link.element.get("name") or ""),
    )


def _shape_order(draft: SpecDraft, said: str | Sequence[str] | None, where: Span) -> YamlNode | None:
    if said is None:
        return None
    if isinstance(said, str):
        return draft.text(said, where)
    return draft.list_of([draft.text(kind, where) for kind in said], where)


def _visual(visual: ElementReader, palette: Palette) -> YamlNode:
    name, geometry = visual.text("name"), visual.required("geometry", read_geometry)
    origin, material = visual.child("origin", read_origin), visual.child("material", palette.used)
    return visual.map(name=name, **_shape(geometry), origin=origin, material=material)


def _collision(collision: ElementReader) -> YamlNode:
    name, geometry = collision.text("name"), collision.required("geometry", read_geometry)
    return collision.map(name=name, **_shape(geometry), origin=collision.child("origin", read_origin))


def _shape(geometry: YamlNode) -> dict[str, YamlNode]:
    return {entry.name: entry.value for entry in geometry} if isinstance(geometry, YamlMap) else {}


def _collisions(link: ElementReader, visuals: list[YamlNode], collisions: list[YamlNode]) -> YamlNode | None:
    """Return the collisions; `visual` where they are the shapes of all visuals and say no more."""
    bare = [_without_looks(visual) for visual in visuals if isinstance(visual, YamlMap)]
    if not collisions or len(bare) != len(collisions) or not all(map(is_same, bare, collisions)):
        return link.draft.one_or_list(collisions)
    copy = link.draft.text("visual", collisions[0].span)
    link.draft.note_same_source(copy, *collisions)
    return copy


def _without_looks(visual: YamlMap) -> YamlMap:
    bare = {entry.name: entry for entry in visual if entry.name in _SHAPE_AND_PLACE}
    return YamlMap(bare, visual.place, visual.begin, visual.end)


_SHAPE_AND_PLACE = ("box", "cylinder", "sphere", "capsule", "mesh", "origin")


def _inertial(inertial: ElementReader) -> YamlNode:
    mass, inertia = inertial.required("mass", _mass), inertial.required("inertia", _inertia)
    return inertial.map(mass=mass, origin=inertial.child("origin", read_origin), inertia=inertia)


def _mass(mass: ElementReader) -> YamlNode:
    value = mass.required_number("value")
    if value.text.startswith("-"):
        raise mass.cannot_represent(f"the mass must be 0 or above [kg], found {value.text}")
    mass.pass_rest_up()
    return value


def _inertia(inertia: ElementReader) -> YamlNode:
    moments = {key: inertia.required_number(key) for key in _MOMENTS}
    for key in _PRODUCTS:
        if inertia.element.get(key) is None:
            raise inertia.cannot_represent(f"it has no '{key}'")
    return inertia.map(**moments, **{key: inertia.number(key, default=0) for key in _PRODUCTS})
