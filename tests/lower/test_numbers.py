import math

import pytest

from linkforge_compile.core.fields import ABOVE_ZERO, NOT_NEGATIVE, ZERO_TO_ONE, Bound
from linkforge_compile.diagnostics.codes.model import (
    LONG_LENGTH,
    NOT_FINITE,
    OUT_OF_RANGE,
    UNKNOWN_UNIT,
    WIDE_ANGLE,
    WRONG_DIMENSION,
    WRONG_KIND,
)
from linkforge_compile.lower.numbers import (
    NumberType,
    Refusal,
    describe_node,
    si_number,
    suspicious_unit,
)
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.nodes import YamlList, YamlScalar
from linkforge_compile.units import Dimension, Quantity

SPAN = SourceFile("spec.yaml", "").whole
ANGLE, LENGTH, MASS = (NumberType((dimension,)) for dimension in (Dimension.ANGLE, Dimension.LENGTH, Dimension.MASS))


def scalar(value) -> YamlScalar:
    return YamlScalar(str(value), value, SPAN)


@pytest.mark.parametrize(
    ("value", "kind", "number"),
    [
        (3, MASS, 3.0),
        (2.5, LENGTH, 2.5),
        ("25 mm", LENGTH, 0.025),
        ("90deg", ANGLE, math.pi / 2),
        (Quantity(0.8, Dimension.LENGTH), LENGTH, 0.8),
        ("2 m", NumberType((Dimension.ANGLE, Dimension.LENGTH)), 2.0),
    ],
)
def test_a_bare_number_is_si_and_a_quantity_is_converted(value, kind, number):
    assert si_number(scalar(value), kind) == number


@pytest.mark.parametrize(
    ("value", "kind", "code"),
    [
        ("3 mm", MASS, WRONG_DIMENSION),
        ("3 mm", NumberType(), WRONG_DIMENSION),
        (Quantity(1.0, Dimension.ANGLE), LENGTH, WRONG_DIMENSION),
        ("3 furlong", LENGTH, UNKNOWN_UNIT),
        ("3 furlong", NumberType(), WRONG_KIND),
        ("three", LENGTH, WRONG_KIND),
        ("3", LENGTH, WRONG_KIND),
        (True, NumberType(), WRONG_KIND),
        (math.inf, LENGTH, NOT_FINITE),
        (math.nan, LENGTH, NOT_FINITE),
        (10**400, LENGTH, NOT_FINITE),
        (0, NumberType((Dimension.LENGTH,), ABOVE_ZERO), OUT_OF_RANGE),
    ],
)
def test_what_is_no_such_number_is_refused_with_its_code(value, kind, code):
    refusal = si_number(scalar(value), kind)
    assert isinstance(refusal, Refusal)
    assert refusal.code is code


def test_an_unknown_unit_is_compared_with_the_units_of_the_field():
    refusal = si_number(scalar("3 mmm"), LENGTH)
    assert isinstance(refusal, Refusal)
    assert "mm" in refusal.near
    assert "kg" not in refusal.near


@pytest.mark.parametrize(
    ("value", "number", "kind", "code"),
    [
        (90, 90.0, ANGLE, WIDE_ANGLE),
        (-6.3, -6.3, ANGLE, WIDE_ANGLE),
        (6.2832, 6.2832, ANGLE, None),
        ("720 deg", 4 * math.pi, ANGLE, None),
        (800, 800.0, LENGTH, LONG_LENGTH),
        ("800 m", 800.0, LENGTH, LONG_LENGTH),
        (40, 40.0, LENGTH, LONG_LENGTH),
        (30, 30.0, LENGTH, None),
        (800, 800.0, MASS, None),
    ],
)
def test_degrees_and_millimetres_without_a_unit_are_doubted(value, number, kind, code):
    assert suspicious_unit(scalar(value), number, kind) is code


def test_numbers_are_shown_as_they_are_and_text_in_quotes():
    shown = [describe_node(scalar(value)) for value in (-1.2, "3 mm", True, Quantity(0.8, Dimension.LENGTH))]
    assert shown == ["-1.2", "'3 mm'", "'True'", "'0.8 m'"]
    assert describe_node(YamlList((), SPAN)) == "a list"


BOUNDS = [ABOVE_ZERO, NOT_NEGATIVE, ZERO_TO_ONE]


@pytest.mark.parametrize("bound", BOUNDS, ids=lambda bound: bound.words)
def test_what_is_taken_without_a_look_keeps_to_its_bound(bound: Bound):
    between = (bound.least + (bound.most - bound.least) * tenth / 10 for tenth in range(1, 10))
    assert all(map(bound.holds, (bound.least, bound.most, *filter(math.isfinite, between))))
    assert not bound.holds(math.nextafter(bound.least, -math.inf))
