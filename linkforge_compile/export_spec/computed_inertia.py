"""Find what a link's inertial was computed from, where its spec has no tensor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.provenance import place_of
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Provenance
from linkforge_compile.syntax import YamlMap

_COMPUTED = ("origin", "inertia")


class Shape(NamedTuple):
    """A shape of the link: its path, such as `collision/0`, its geometry, and where it was written."""

    path: str
    geometry: str
    place: Span | None


class ComputedFrom(NamedTuple):
    """The quantity, `mass` or `density`, where it was written, and the shapes that it is distributed over."""

    quantity: str
    place: Provenance
    shapes: tuple[Shape, ...]


def computed_from(robot: Robot, path: Sequence[str]) -> ComputedFrom | None:
    """Return what the value at a path of a full spec was computed from; None unless it is part of such an inertial."""
    match path:
        case ("links", name, "inertial", *rest) if name in robot.links:
            link, field = robot.link(name), rest[0] if rest else None
        case _:
            return None
    source = link.inertial.source if link.inertial else None
    node = source.node if source else None
    if not isinstance(node, YamlMap) or node.get("inertia") is not None:
        return None
    quantity = "mass" if node.get("mass") is not None else "density"
    spread = node.get(quantity)
    is_computed = field in {None, *_COMPUTED} or (field == "mass" and quantity == "density")
    if spread is None or not is_computed:
        return None
    kind = "collision" if link.collisions else "visual"
    bodies: Sequence[Visual | Collision] = link.collisions or link.visuals
    shapes = tuple(
        Shape(f"{kind}/{place}", body.geometry.type.value, body.source.span if body.source else None)
        for place, body in enumerate(bodies)
    )
    return ComputedFrom(quantity, place_of(spread.span), shapes)
