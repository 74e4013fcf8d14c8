"""Collisions in an SRDF: the pairs of links that planners ignore or check, and the spheres in place of shapes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import (
    NOT_NEGATIVE,
    Children,
    Number,
    Reference,
    Text,
    is_finite,
    not_finite,
    require_finite,
)
from linkforge_compile.core.naming import require_not_blank
from linkforge_compile.core.part import Element, extras_last
from linkforge_compile.units import LENGTH


@extras_last
@dataclass(frozen=True)
class CollisionPair(Element):
    """Two different links whose collision is ignored or checked: `<disable_collisions>`, `<enable_collisions>`.

    `reason` is for people and tools (`Adjacent`, `Never`), None if not given. (a, b) and (b, a) are
    the same pair but not equal; `key` is.
    """

    TITLE = "collision pair"
    SHORT_FORM = "reason"

    link1: Annotated[str, Reference("link", key="")]
    link2: Annotated[str, Reference("link", key="")]
    reason: Annotated[str | None, Text()] = None

    def _check(self) -> None:
        require_not_blank(self.link1, "link1 of a collision pair", "CollisionPair", ("link1",))
        require_not_blank(self.link2, "link2 of a collision pair", "CollisionPair", ("link2",))
        if self.link1 == self.link2:
            message = f"a collision pair needs two different links, found '{self.link1}' twice"
            raise RobotValidationError.invalid(message, "CollisionPair", None, "link2")

    @property
    def key(self) -> tuple[str, str]:
        """The two links in alphabetical order."""
        return (self.link1, self.link2) if self.link1 < self.link2 else (self.link2, self.link1)


_CENTER = Number(LENGTH, key="center", xml="@center", example="[0, 0, 0.1]")


@extras_last
@dataclass(frozen=True)
class SrdfSphere(Element):
    """A sphere in the frame of its link: `<sphere center radius>`, all [m]; a radius may be 0."""

    TAG = "sphere"

    center_x: Annotated[float, _CENTER]
    center_y: Annotated[float, _CENTER]
    center_z: Annotated[float, _CENTER]
    radius: Annotated[float, Number(LENGTH, NOT_NEGATIVE, example="0.1")]

    def _check(self) -> None:
        if self.radius < 0:
            message = f"sphere radius must be at least 0 m, found {self.radius}"
            raise RobotValidationError.invalid(message, "SrdfSphere", None, "radius")
        for index, name in enumerate(("center_x", "center_y", "center_z")):
            if not is_finite(getattr(self, name)):
                raise not_finite(getattr(self, name), name, f"SrdfSphere.{name}", ("center", index))
        require_finite(self, "radius")


@extras_last
@dataclass(frozen=True)
class LinkSphereApproximation(Element):
    """Spheres, or none, in place of the shape of a link: `<link_sphere_approximation link>`."""

    TAG = "link_sphere_approximation"
    TITLE = "sphere approximation of link '{link}'"
    SHORT_FORM = "spheres"

    link: Annotated[str, Reference("link", key="")]
    spheres: Annotated[Sequence[SrdfSphere], Children()] = ()

    def _check(self) -> None:
        require_not_blank(self.link, "link of a sphere approximation", "LinkSphereApproximation", ("link",))
