"""Quantities, the units of fields, and numbers as text."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from enum import Enum, StrEnum, auto
from functools import lru_cache
from operator import index
from typing import NamedTuple

_IN_FULL = re.compile(r"-?(?:0|[1-9][0-9]*)\.[0-9]+")


def number_text(value: float) -> str:
    """Return the shortest decimal text that reads back to the same double.

    Whole numbers have no ".0", zero has no sign and exponents no padding: 4.0 is "4", -0.0 is "0", 1e-07 is "1e-7".
    Integers keep every digit. NumPy numbers are formatted as the float or integer that they hold.
    """
    if not isinstance(value, float):
        try:
            return str(index(value))
        except TypeError:  # not an integer; every array has __index__, too
            value = float(value)
    return double_text(value)


def finite_number(text: str | None) -> float | None:
    """Return the finite number that a text spells for Python; None for any other text, and for no text."""
    try:
        number = float(text or "")
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def is_in_full(text: str) -> bool:
    """Whether a text is a decimal number with a point and no exponent, as in `1.0` and `0.50`."""
    return _IN_FULL.fullmatch(text) is not None


@lru_cache(maxsize=4096)
def double_text(value: float) -> str:
    """Return what `number_text` does, for a value that is a float."""
    if value == 0:
        return "0"
    digits, marker, exponent = float.__repr__(value).partition("e")
    if not marker:
        return digits.removesuffix(".0")
    return f"{digits}e{int(exponent)}"


class Dimension(StrEnum):
    """What a number measures; the values are the parameter types of the language, but for the last five.

    Inertia, accelerations and jerks are for fields only.
    """

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
    ACCELERATION = "acceleration"
    ANGULAR_ACCELERATION = "angular_acceleration"
    JERK = "jerk"
    ANGULAR_JERK = "angular_jerk"

    @property
    def si_unit(self) -> str:
        """The unit of a bare number."""
        return _SI_UNITS[self]

    @property
    def words(self) -> str:
        """What messages call it: "a length", "an angular velocity"."""
        name = self.replace("_", " ")
        return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


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
    Dimension.ACCELERATION: "m/s^2",
    Dimension.ANGULAR_ACCELERATION: "rad/s^2",
    Dimension.JERK: "m/s^3",
    Dimension.ANGULAR_JERK: "rad/s^3",
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


class Motion(Enum):
    """How a joint moves, which the units of its numbers depend on."""

    TURNING = auto()
    SLIDING = auto()
    OTHER = auto()  # in several directions, or not at all: its numbers have no unit
    UNKNOWN = auto()


class FieldUnit(NamedTuple):
    """The dimension of a number on a joint that turns, and on one that slides; None for a bare number.

    `turning_text` and `sliding_text` name a unit of no dimension of the language, for people to read.
    """

    turning: Dimension | None = None
    sliding: Dimension | None = None
    turning_text: str = ""
    sliding_text: str = ""

    def dimensions(self, motion: Motion) -> tuple[Dimension, ...]:
        """Return the dimensions that a number may have; none for a bare number."""
        if (
            self.turning is None
            or self.sliding is None
            or (self.turning is not self.sliding and motion is Motion.OTHER)
        ):
            return ()
        if self.turning is self.sliding or motion is Motion.TURNING:
            return (self.turning,)
        return (self.sliding,) if motion is Motion.SLIDING else (self.turning, self.sliding)

    def dimension(self, motion: Motion) -> Dimension | None:
        """Return the one dimension that a number has; None for a bare number, and for one that may have several."""
        found = self.dimensions(motion)
        return found[0] if len(found) == 1 else None

    def text(self, motion: Motion) -> str:
        """Return the SI unit for people to read; empty for a bare number."""
        dimension = self.dimension(motion)
        return dimension.si_unit if dimension else self.sliding_text if motion is Motion.SLIDING else self.turning_text


def unit_of(dimension: Dimension) -> FieldUnit:
    """Return the unit of a number that does not depend on motion."""
    return FieldUnit(dimension, dimension)


BARE = FieldUnit()
LENGTH = unit_of(Dimension.LENGTH)
ANGLE = unit_of(Dimension.ANGLE)
MASS = unit_of(Dimension.MASS)
INERTIA = unit_of(Dimension.INERTIA)
FREQUENCY = unit_of(Dimension.FREQUENCY)
TURN_RATE = unit_of(Dimension.ANGULAR_VELOCITY)
VELOCITY = unit_of(Dimension.VELOCITY)
LOAD = FieldUnit(Dimension.FORCE, Dimension.TORQUE)
"""A force or a torque, of a sensor that measures both."""
PIXELS = FieldUnit(turning_text="px", sliding_text="px")
STIFFNESS = FieldUnit(turning_text="N/m", sliding_text="N/m")
CONTACT_DAMPING = FieldUnit(turning_text="N*s/m", sliding_text="N*s/m")

POSITION = FieldUnit(Dimension.ANGLE, Dimension.LENGTH)
"""Of a joint."""
EFFORT = FieldUnit(Dimension.TORQUE, Dimension.FORCE)
SPEED = FieldUnit(Dimension.ANGULAR_VELOCITY, Dimension.VELOCITY)
ACCELERATION = FieldUnit(Dimension.ANGULAR_ACCELERATION, Dimension.ACCELERATION)
JERK = FieldUnit(Dimension.ANGULAR_JERK, Dimension.JERK)
DAMPING = FieldUnit(turning_text="N*m*s/rad", sliding_text="N*s/m")
