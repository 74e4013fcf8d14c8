"""Read links of URDF, with their shapes and inertial."""

from __future__ import annotations

from functools import partial

from linkforge_compile.core.models.link import COLLISION, KINDS, VISUAL, shortest_setting
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import is_same
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.importers.urdf.geometry import read_geometry, read_pose
from linkforge_compile.importers.urdf.material import Palette
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlMap, YamlNode

_MOMENTS = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")
_SHAPE_AND_POSE = ("box", "cylinder", "sphere", "capsule", "mesh", "origin")


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
        inertial=link.child("inertial", _inertial),
        gazebo=blocks.take(link.element.get("name") or ""),
    )


def _shape_order(link: ElementReader, kinds: list[str], where: Span) -> YamlNode | None:
    order = shortest_setting(kinds)
    if order is None or isinstance(order, str):
        return None if order is None else link.draft.text(order, where)
    return link.draft.list_of([link.draft.text(kind, where) for kind in order], where)


def _visual(visual: ElementReader, palette: Palette) -> YamlNode:
    name, geometry = visual.text("name"), visual.required("geometry", read_geometry)
    origin, material = visual.child("origin", read_pose), visual.child("material", palette.read_used)
    return visual.map(name=name, **_entries(geometry), origin=origin, material=material)


def _collision(collision: ElementReader) -> YamlNode:
    name, geometry = collision.text("name"), collision.required("geometry", read_geometry)
    return collision.map(name=name, **_entries(geometry), origin=collision.child("origin", read_pose))


def _entries(geometry: YamlNode) -> dict[str, YamlNode]:
    return {entry.name: entry.value for entry in geometry} if isinstance(geometry, YamlMap) else {}


def _short_collisions(link: ElementReader, visuals: list[YamlNode], collisions: list[YamlNode]) -> YamlNode | None:
    """Return `visual` for collisions that have the shapes and poses of all visuals and nothing else."""
    bare = [_shape_and_pose(visual) for visual in visuals if isinstance(visual, YamlMap)]
    if not collisions or len(bare) != len(collisions) or not all(map(is_same, bare, collisions)):
        return link.draft.one_or_list(collisions)
    copy = link.draft.text("visual", collisions[0].span)
    link.draft.note_same_source(copy, *collisions)
    return copy


def _shape_and_pose(visual: YamlMap) -> YamlMap:
    entries = {entry.name: entry for entry in visual if entry.name in _SHAPE_AND_POSE}
    return YamlMap(entries, visual.place, visual.begin, visual.end)


def _inertial(inertial: ElementReader) -> YamlNode:
    mass, inertia = inertial.required("mass", _mass), inertial.required("inertia", _inertia)
    return inertial.map(mass=mass, origin=inertial.child("origin", read_pose), inertia=inertia)


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
