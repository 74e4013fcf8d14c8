"""Materials: colors and textures of visuals."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from linkforge_compile.core.constants import DEFAULT_MATERIAL_RGBA
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.fields import Colour, Flag, Name, Text
from linkforge_compile.core.part import Element, freeze


@dataclass(frozen=True, slots=True)
class Color(Element):
    """Red, green, blue and opacity, each from 0 to 1: `<color rgba>`.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a component outside of [0, 1]; the field is its position, 0 to 3.

    """

    TAG = "color"

    r: float
    g: float
    b: float
    a: float = 1.0

    def __post_init__(self) -> None:
        freeze(self)
        for position, component in enumerate(self.to_tuple()):
            if not 0 <= component <= 1:
                raise RobotValidationError(
                    ValidationErrorCode.OUT_OF_RANGE,
                    f"color component must be in range [0.0, 1.0], found {component}",
                    target="ColorComponent",
                    value=component,
                    field=(position,),
                )

    @classmethod
    def white(cls) -> Color:
        """Return opaque white."""
        return cls(1.0, 1.0, 1.0, 1.0)

    @classmethod
    def black(cls) -> Color:
        """Return opaque black."""
        return cls(0.0, 0.0, 0.0, 1.0)

    @classmethod
    def grey(cls) -> Color:
        """Return the grey of a shape without a color: 0.7, opaque."""
        return cls(*DEFAULT_MATERIAL_RGBA)

    def to_tuple(self) -> tuple[float, float, float, float]:
        """Return (r, g, b, a)."""
        return (self.r, self.g, self.b, self.a)

    def __str__(self) -> str:
        return f"{self.r} {self.g} {self.b} {self.a}"


@dataclass(frozen=True, slots=True)
class Material(Element):
    """A color, a texture or both, under a name that may be empty: `<material name>`.

    `texture` is the file of the image, as a URI or a path: `<texture filename>`; None for none. With
    `after_links` it is written after the links: of two colors of one name, MuJoCo uses the first in the document
    wherever only the name is given. It is not compared; for equal materials of one name it holds if all have it.

    Raises:
        RobotValidationError: VALUE_EMPTY if it has neither color nor texture.

    """

    TAG = "material"

    name: Annotated[str, Name()]
    color: Annotated[Color | None, Colour()] = None
    texture: Annotated[str | None, Text(xml="texture/@filename")] = None
    after_links: Annotated[bool, Flag(xml="")] = field(default=False, compare=False, repr=False, kw_only=True)

    def __post_init__(self) -> None:
        freeze(self)
        if self.color is None and self.texture is None:
            raise RobotValidationError(
                ValidationErrorCode.VALUE_EMPTY,
                f"material '{self.name}' must have a color or a texture",
                target="MaterialDefinition",
                value=self.name,
            )
