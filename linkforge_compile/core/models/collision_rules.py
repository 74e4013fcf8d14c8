"""Collisions in motion planning: pairs of links that are not checked, and spheres in place of a link's shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from linkforge_compile.core.exceptions import FieldPath, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.fields import NOT_NEGATIVE, Children, Number, Reference, Text
from linkforge_compile.core.part import Element, freeze
from linkforge_compile.core.rules import is_finite, not_finite, require_not_blank
from linkforge_compile.units import LENGTH


@dataclass(frozen=True, slots=True)
class CollisionPair(Element):
    """Two links whose collision is not checked, or is after all: `<disable_collisions>`, `<enable_collisions>`.

    `reason` is for people and tools (`Adjacent`, `Never`), None if not given. (a, b) and (b, a) are
    the same pair but not equal; `key` is.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank link, INVALID_VALUE for a link with itself.

    """

    link1: Annotated[str, Reference("link", key="")]
    link2: Annotated[str, Reference("link", key="")]
    reason: Annotated[str | None, Text()] = None

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.link1, "link1 of a collision pair", "CollisionPair", ("link1",))
        require_not_blank(self.link2, "link2 of a collision pair", "CollisionPair", ("link2",))
        if self.link1 == self.link2:
            raise RobotValidationError(
                ValidationErrorCode.INVALID_VALUE,
                f"a collision pair needs two different links, found '{self.link1}' twice",
                target="CollisionPair",
                field=("link2",),
            )

    @property
    def key(self) -> tuple[str, str]:
        """The two links in alphabetical order."""
        return (self.link1, self.link2) if self.link1 < self.link2 else (self.link2, self.link1)


_CENTER = Number(LENGTH, key="center", xml="@center", example="[0, 0, 0.1]")


@dataclass(frozen=True, slots=True)
class SrdfSphere(Element):
    """A sphere in the frame of its link: `<sphere center radius>`, all [m].

    Raises:
        RobotValidationError: INVALID_VALUE for a radius below 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "sphere"

    center_x: Annotated[float, _CENTER]
    center_y: Annotated[float, _CENTER]
    center_z: Annotated[float, _CENTER]
    radius: Annotated[float, Number(LENGTH, NOT_NEGATIVE, example="0.1")]

    def __post_init__(self) -> None:
        freeze(self)
        if self.radius < 0:
            raise RobotValidationError(
                ValidationErrorCode.INVALID_VALUE,
                f"sphere radius must be at least 0 m, found {self.radius}",
                target="SrdfSphere",
                field=("radius",),
            )
        places: tuple[tuple[str, float, FieldPath], ...] = (
            ("center_x", self.center_x, ("center", 0)),
            ("center_y", self.center_y, ("center", 1)),
            ("center_z", self.center_z, ("center", 2)),
            ("radius", self.radius, ("radius",)),
        )
        for name, number, field in places:
            if not is_finite(number):
                raise not_finite(number, name, f"SrdfSphere.{name}", field)


@dataclass(frozen=True, slots=True)
class LinkSphereApproximation(Element):
    """Spheres in place of the shape of a link: `<link_sphere_approximation link>`; without spheres it has no shape.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank link.

    """

    TAG = "link_sphere_approximation"

    link: Annotated[str, Reference("link", key="")]
    spheres: Annotated[Sequence[SrdfSphere], Children()] = ()

    def __post_init__(self) -> None:
        freeze(self, "spheres")
        require_not_blank(self.link, "link of a sphere approximation", "LinkSphereApproximation", ("link",))
