"""Names of the shapes and sensors of a link, which are different in SDF."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import SensorType
from linkforge_compile.core.naming import unique_name
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.settings import LINK_ELEMENTS, Settings

_MERGED = "_fixed_joint_lump__"
"""Before the name of a shape where Gazebo's conversion of a URDF merges its link into another."""

_OF_CONVERSION = re.compile(f"(?:.*{_MERGED})?(.+)_{Collision.TAG}(?:_[0-9]+)?")
"""The name of a collision in a converted URDF: that of the collision or of its link, and a number."""


class NamedShape(NamedTuple):
    """A shape of a link, and its name in SDF."""

    link: Link
    shape: Visual | Collision
    name: str

    @property
    def is_renamed(self) -> bool:
        return self.shape.name not in (None, "", self.name)


class PartNames:
    """The names of the shapes of all links.

    Sensors keep their names; then collisions, to which contact sensors refer, have their own where they can.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._of_links = _sensors_of_links(layout.robot, layout.settings)
        self.visuals: dict[str, list[NamedShape]] = {}
        self.collisions: dict[str, list[NamedShape]] = {}
        for body, links in layout.held.items():
            taken = set(self.sensors(body))
            for found, tag in ((self.collisions, Collision.TAG), (self.visuals, Visual.TAG)):
                for link in links:
                    found[link.name] = list(_named(link, tag, taken))

    def sensors(self, body: str) -> Sequence[str]:
        """Return the names of the sensors of a body, and of its other elements that are SDF already."""
        return [name for link in self._layout.held[body] for name in self._of_links.get(link.name, ())]

    def collision(self, link: str, reference: str) -> str | None:
        """Return the collision to which a contact sensor on a link refers, maybe by its name in a converted URDF."""
        shapes = self._collisions_near(link)
        converted = _OF_CONVERSION.fullmatch(reference)
        stem = converted[1] if converted else reference
        for name in (reference, reference.rpartition(_MERGED)[2], stem):
            for one in shapes:
                if name in (one.shape.name, one.name):
                    return one.name
        return next((one.name for one in shapes if one.link.name == stem and not one.shape.name), None)

    def of_body(self, link: str) -> Sequence[str]:
        """Return the names of all collisions of the body that holds a link."""
        return [one.name for one in self._collisions_near(link)]

    def _collisions_near(self, link: str) -> Sequence[NamedShape]:
        """Return the collisions of the body that holds a link, those of the link first."""
        held = self._layout.held.get(self._layout.body_of(link), ())
        links = sorted(held, key=lambda one: one.name != link)
        return [shape for one in links for shape in self.collisions[one.name]]


def repeated(names: Sequence[str]) -> Iterator[str]:
    """Yield the names that are there twice or more."""
    return (name for name, count in Counter(names).items() if count > 1 and name)


def _named(link: Link, tag: str, taken: set[str]) -> Iterator[NamedShape]:
    """Yield the shapes of a link; one without a name has that which the conversion of a URDF makes."""
    shapes: Sequence[Visual | Collision] = link.collisions if tag == Collision.TAG else link.visuals
    for number, shape in enumerate(shapes):
        implied = f"{link.name}_{tag}" + (f"_{number}" if number else "")
        name = shape.name or implied
        if name in taken:
            name = unique_name(f"{name}_{tag}" if shape.name else name, taken)
        taken.add(name)
        yield NamedShape(link, shape, name)


def _sensors_of_links(robot: Robot, settings: Mapping[str | None, Settings]) -> Mapping[str, Sequence[str]]:
    names: dict[str, list[str]] = {link.name: [] for link in robot.links}
    for sensor in robot.sensors:
        if sensor.type != SensorType.FORCE_TORQUE and sensor.link_name in names:
            names[sensor.link_name].append(sensor.name)
    for link, found in names.items():
        found += [name for one in settings.get(link, ()) if one.tag in LINK_ELEMENTS for name in one.names]
    return names
