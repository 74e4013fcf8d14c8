"""Units of fields: the dimension of a number, which may depend on how its joint moves."""

from __future__ import annotations

from enum import Enum, auto
from typing import NamedTuple

from linkforge_compile.units.quantity import Dimension


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
DAMPING = FieldUnit(turning_text="N*m*s/rad", sliding_text="N*s/m")
