"""Dimensions, and numbers that have one."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from linkforge_compile.units.numbers import number_text


class Dimension(StrEnum):
    """What a number measures; the values are the parameter types of the language (inertia is for fields only)."""

    LENGTH = "length"
    ANGLE = "angle"
    MASS = "mass"
    TIME = "time"
    FREQUENCY = "frequency"
    FORCE = "force"
    TORQUE = "torque"
    VELOCITY = "velocity"
    ANGULAR_VELOCITY = "angular_velocity"
    DENSITY = "density"
    INERTIA = "inertia"

    @property
    def si_unit(self) -> str:
        """The unit of a bare number."""
        return _SI_UNITS[self]


_SI_UNITS = {
    Dimension.LENGTH: "m",
    Dimension.ANGLE: "rad",
    Dimension.MASS: "kg",
    Dimension.TIME: "s",
    Dimension.FREQUENCY: "Hz",
    Dimension.FORCE: "N",
    Dimension.TORQUE: "N*m",
    Dimension.VELOCITY: "m/s",
    Dimension.ANGULAR_VELOCITY: "rad/s",
    Dimension.DENSITY: "kg/m^3",
    Dimension.INERTIA: "kg*m^2",
}


WIDEST_ANGLE = 2 * math.pi + 0.005
"""A larger bare angle [rad] is probably in degrees; a whole turn rounded to two decimals (6.29) is still radians."""


@dataclass(frozen=True)
class Quantity:
    """A number in the SI unit of its dimension; `written` is its source text, None for a computed one."""

    value: float
    dimension: Dimension
    written: str | None = field(default=None, compare=False)

    def __str__(self) -> str:
        return self.written or self.in_si

    @property
    def in_si(self) -> str:
        """The number with its SI unit: "0.1 m"."""
        return f"{number_text(self.value)} {self.dimension.si_unit}"
