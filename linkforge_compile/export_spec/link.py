"""Links as a spec writes them: their shapes, their inertial and how a simulator treats them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.core.models.link import Collision, Inertial, Link, LinkPhysics, Visual
from linkforge_compile.core.models.material import Material
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import written_element, written_fields
from linkforge_compile.export_spec.geometry import written_geometry, written_origin
from linkforge_compile.export_spec.material import written_visual_material
from linkforge_compile.shape_order import COLLISION, VISUAL, as_said
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension


def written_link(
    builder: SpecBuilder, link: Link, materials: Mapping[str, Material], gazebo: YamlNode | None
) -> YamlMap:
    """Return a link; `gazebo` is what a simulator is told about it beside its physics."""
    visuals = _one_or_list(builder, [_visual(builder, visual, materials) for visual in link.visuals])
    shapes = {VISUAL: visuals, COLLISION: _collisions(builder, link)}
    kinds = [VISUAL if isinstance(shape, Visual) else COLLISION for shape in link.shapes]
    return builder.element(
        link,
        # Their order is that of the output.
        **dict(reversed(shapes.items()) if kinds[:1] == [COLLISION] else shapes),
        shape_order=_shape_order(builder, as_said(kinds)),
        inertial=_inertial(builder, link.inertial) if link.inertial else None,
        physics=_physics(builder, link.physics),
        gazebo=gazebo,
    )


def _shape_order(builder: SpecBuilder, said: str | Sequence[str] | None) -> YamlNode | None:
    return builder.text(said) if said is None or isinstance(said, str) else builder.texts(said)


def _visual(builder: SpecBuilder, visual: Visual, materials: Mapping[str, Material]) -> YamlNode:
    return builder.element(
        visual,
        name=builder.text(visual.name),
        **written_geometry(builder, visual.geometry),
        origin=written_origin(builder, visual.origin),
        material=written_visual_material(builder, visual.material, materials),
    )


def _collisions(builder: SpecBuilder, link: Link) -> YamlNode | None:
    copies = [Collision(visual.geometry, visual.origin) for visual in link.visuals]
    if copies and copies == list(link.collisions) and not builder.full:
        return builder.text("visual")
    return _one_or_list(builder, [_collision(builder, collision) for collision in link.collisions])


def _collision(builder: SpecBuilder, collision: Collision) -> YamlNode:
    return builder.element(
        collision,
        name=builder.text(collision.name),
        **written_geometry(builder, collision.geometry),
        origin=written_origin(builder, collision.origin),
    )


def _one_or_list(builder: SpecBuilder, shapes: Sequence[YamlNode]) -> YamlNode | None:
    if not shapes:
        return None
    return shapes[0] if len(shapes) == 1 and not builder.full else builder.list_of(shapes)


def _inertial(builder: SpecBuilder, inertial: Inertial) -> YamlMap:
    # The tensor is written even where it is the floor: to leave it out is to have it computed from the shapes.
    return builder.element(
        inertial,
        mass=builder.number(inertial.mass, Dimension.MASS),
        origin=written_origin(builder, inertial.origin),
        inertia=written_element(builder, inertial.inertia),
    )


def _physics(builder: SpecBuilder, physics: LinkPhysics) -> YamlNode | None:
    node = builder.map_of(written_fields(builder, physics, stated=tuple(physics.stated)))
    return builder.located(node, physics.source) if len(node) else None
