"""Links as a spec writes them: their shapes, their inertial and how a simulator treats them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.core.models.link import Collision, Inertial, Link, LinkPhysics, Visual
from linkforge_compile.core.models.material import Material
from linkforge_compile.core.models.shape_order import COLLISION, VISUAL, shortest_setting
from linkforge_compile.export_spec.elements import written_element, written_fields
from linkforge_compile.export_spec.geometry import written_geometry, written_origin
from linkforge_compile.export_spec.material import written_visual_material
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension


def written_link(pen: Pen, link: Link, materials: Mapping[str, Material], gazebo: YamlNode | None) -> YamlMap:
    """Return a link; `gazebo` is what a simulator is told about it beside its physics."""
    visuals = _one_or_list(pen, [_visual(pen, visual, materials) for visual in link.visuals])
    shapes = {VISUAL: visuals, COLLISION: _collisions(pen, link)}
    kinds = [VISUAL if isinstance(shape, Visual) else COLLISION for shape in link.shapes]
    return pen.element(
        link,
        # Their order is that of the output.
        **dict(reversed(shapes.items()) if kinds[:1] == [COLLISION] else shapes),
        shape_order=_shape_order(pen, shortest_setting(kinds)),
        inertial=_inertial(pen, link.inertial) if link.inertial else None,
        physics=_physics(pen, link.physics),
        gazebo=gazebo,
    )


def _shape_order(pen: Pen, said: str | Sequence[str] | None) -> YamlNode | None:
    return pen.text(said) if said is None or isinstance(said, str) else pen.texts(said)


def _visual(pen: Pen, visual: Visual, materials: Mapping[str, Material]) -> YamlNode:
    return pen.element(
        visual,
        name=pen.text(visual.name),
        **written_geometry(pen, visual.geometry),
        origin=written_origin(pen, visual.origin),
        material=written_visual_material(pen, visual.material, materials),
    )


def _collisions(pen: Pen, link: Link) -> YamlNode | None:
    copies = [Collision(visual.geometry, visual.origin) for visual in link.visuals]
    if copies and copies == list(link.collisions) and not pen.full:
        return pen.text("visual")
    return _one_or_list(pen, [_collision(pen, collision) for collision in link.collisions])


def _collision(pen: Pen, collision: Collision) -> YamlNode:
    return pen.element(
        collision,
        name=pen.text(collision.name),
        **written_geometry(pen, collision.geometry),
        origin=written_origin(pen, collision.origin),
    )


def _one_or_list(pen: Pen, shapes: Sequence[YamlNode]) -> YamlNode | None:
    if not shapes:
        return None
    return shapes[0] if len(shapes) == 1 and not pen.full else pen.list_of(shapes)


def _inertial(pen: Pen, inertial: Inertial) -> YamlMap:
    # The tensor is written even where it is the floor: to leave it out is to have it computed from the shapes.
    return pen.element(
        inertial,
        mass=pen.number(inertial.mass, Dimension.MASS),
        origin=written_origin(pen, inertial.origin),
        inertia=written_element(pen, inertial.inertia),
    )


def _physics(pen: Pen, physics: LinkPhysics) -> YamlNode | None:
    node = pen.map_of(written_fields(pen, physics, stated=tuple(physics.stated)))
    return pen.located(node, physics.source) if len(node) else None
