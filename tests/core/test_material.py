"""Colors and materials."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Color, Material


def test_a_color_is_opaque_by_default():
    assert Color(0.1, 0.2, 0.3).to_tuple() == (0.1, 0.2, 0.3, 1.0)
    assert str(Color(0, 0.5, 1)) == "0 0.5 1 1.0"


def test_the_named_colors():
    assert Color.white().to_tuple() == (1, 1, 1, 1)
    assert Color.black().to_tuple() == (0, 0, 0, 1)
    assert Color.grey().to_tuple() == (0.7, 0.7, 0.7, 1)


@pytest.mark.parametrize("bad", [-0.1, 1.1, 255, math.nan, math.inf])
def test_a_component_lies_between_zero_and_one(bad):
    with pytest.raises(RobotValidationError) as caught:
        Color(0, 0, bad)
    assert caught.value.code is ValidationErrorCode.OUT_OF_RANGE
    assert caught.value.field == (2,)


def test_a_material_has_a_color_or_a_texture_or_both_but_needs_no_name():
    assert Material("", Color.white()).name == ""
    assert Material("wood", texture="wood.png").color is None
    assert Material("wood", Color.white(), "wood.png").texture == "wood.png"
    with pytest.raises(RobotValidationError) as caught:
        Material("wood")
    assert caught.value.code is ValidationErrorCode.VALUE_EMPTY


def test_a_prefix_goes_to_the_name_and_not_to_the_file():
    assert Material("wood", texture="wood.png").with_prefix("left_") == Material("left_wood", texture="wood.png")
