"""Find the links whose inertia is that of their shapes, to the last digit, so that a spec need not state it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from linkforge_compile.core.exceptions import LinkForgeError
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.physics import inertial_of_shapes

if TYPE_CHECKING:
    from linkforge_compile.core import Link, Robot

Place = tuple[str, str]
"""The name of a file, and the key of a link in it."""


def computed_inertias(robots: Iterable[Robot]) -> frozenset[Place]:
    """Return the places of the links whose inertia is that of their shapes in all robots."""
    places: dict[Place, bool] = {}
    for robot in robots:
        for link in robot.links:
            span = link.source.span if link.source else None
            if span is not None and link.inertial is not None:
                place = span.file.name.rsplit("/", 1)[-1], _key_at(span.file.line(span.line))
                places[place] = places.get(place, True) and _is_computed(link)
    return frozenset(place for place, is_computed in places.items() if is_computed)


def _key_at(line: str) -> str:
    """Return the key on a line."""
    return line.strip().partition(":")[0].strip("\"'")


def _is_computed(link: Link) -> bool:
    shapes = [(shape.geometry, shape.origin) for shape in link.collisions or link.visuals]
    if not shapes or any(isinstance(geometry, Mesh) for geometry, _ in shapes) or link.inertial is None:
        return False
    try:
        computed = inertial_of_shapes(shapes, mass=link.inertial.mass)
    except LinkForgeError:
        return False
    return computed.origin == link.inertial.origin and computed.inertia == link.inertial.inertia
