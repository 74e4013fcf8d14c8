"""What the fields of model classes say about themselves, and what walkers make of it."""

from dataclasses import dataclass
from typing import Annotated

import pytest

from linkforge_compile import compile_text, render_urdf
from linkforge_compile.core import (
    CameraInfo,
    InertiaTensor,
    JointDynamics,
    JointLimits,
    JointMimic,
    LinkPhysics,
    RobotModelError,
)
from linkforge_compile.core.fields import NOT_NEGATIVE, Number, check_numbers
from linkforge_compile.formats.element import attributes_of
from linkforge_compile.units import DAMPING, EFFORT, POSITION, SPEED, Dimension, Motion

TURN_RATE = Dimension.ANGULAR_VELOCITY


@pytest.mark.parametrize(
    ("unit", "turning", "sliding", "other", "unknown"),
    [
        (POSITION, (Dimension.ANGLE,), (Dimension.LENGTH,), (), (Dimension.ANGLE, Dimension.LENGTH)),
        (EFFORT, (Dimension.TORQUE,), (Dimension.FORCE,), (), (Dimension.TORQUE, Dimension.FORCE)),
        (
            SPEED,
            (Dimension.ANGULAR_VELOCITY,),
            (Dimension.VELOCITY,),
            (),
            (Dimension.ANGULAR_VELOCITY, Dimension.VELOCITY),
        ),
        (DAMPING, (), (), (), ()),
    ],
)
def test_a_unit_depends_on_how_the_joint_moves(unit, turning, sliding, other, unknown):
    motions = (Motion.TURNING, Motion.SLIDING, Motion.OTHER, Motion.UNKNOWN)
    assert tuple(map(unit.dimensions, motions)) == (turning, sliding, other, unknown)


def test_a_unit_has_a_name_for_people():
    assert [EFFORT.text(Motion.TURNING), EFFORT.text(Motion.SLIDING)] == ["N*m", "N"]
    assert [DAMPING.text(Motion.TURNING), DAMPING.text(Motion.SLIDING)] == ["N*m*s/rad", "N*s/m"]


def test_an_implied_number_is_written_where_the_author_wrote_it():
    assert attributes_of(JointMimic("a")) == ' joint="a"'
    assert attributes_of(JointMimic("a", 2, stated=("offset",))) == ' joint="a" multiplier="2" offset="0"'
    assert attributes_of(JointDynamics()) == ' damping="0" friction="0"'


@dataclass
class Spring:
    """A user's class with a number of its own."""

    stiffness: Annotated[float | None, Number(bound=NOT_NEGATIVE)]


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (-1.0, "stiffness must be at least 0, found -1.0"),
        (float("nan"), "stiffness must be a finite number, found nan"),
        (float("inf"), "stiffness must be a finite number, found inf"),
    ],
)
def test_a_number_outside_of_its_bound_is_refused(value: float, message: str):
    check_numbers(Spring(None))
    check_numbers(Spring(0.0))
    with pytest.raises(RobotModelError, match=message):
        check_numbers(Spring(value))


def test_a_number_that_is_always_written_may_not_be_none():
    for make in (
        lambda: JointLimits(0, 1, effort=None),
        lambda: JointMimic("a", multiplier=None),
        lambda: CameraInfo(width=None),
        lambda: InertiaTensor(1, 1, None),
        lambda: LinkPhysics(mu=None),
    ):
        with pytest.raises(RobotModelError, match="must be a finite number, found None"):
            make()


def test_the_numbers_of_a_joint_are_lowered_in_the_units_of_its_motion():
    spec = """
linkforge: 1
name: slide
links: {base: , cart: }
joints:
  rail:
    {type: prismatic, parent: base, child: cart, axis: x,
     limits: {lower: 0, upper: 40 mm, effort: 2 kN, velocity: 20 cm/s}, dynamics: {friction: 3 N}}
"""
    urdf = render_urdf(compile_text(spec).result())
    assert '<limit lower="0" upper="0.04" effort="2000" velocity="0.2"/>' in urdf
    assert '<dynamics damping="0" friction="3"/>' in urdf
