"""Units: what people write after a number, converted without loss, and numbers back as text."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.units import (
    UNITS,
    Dimension,
    Quantity,
    number_text,
    parse_quantity,
    pattern_of,
    spellings_of,
    suggested_unit,
    unit_text,
    units_of,
)

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "value", "dimension"),
    [
        ("25 mm", 0.025, Dimension.LENGTH),
        ("25mm", 0.025, Dimension.LENGTH),
        ("+.5 in", 0.0127, Dimension.LENGTH),
        ("5. µm", 5e-6, Dimension.LENGTH),
        ("-90 deg", -math.pi / 2, Dimension.ANGLE),
        ("90°", math.pi / 2, Dimension.ANGLE),
        ("60 rpm", 2 * math.pi, Dimension.ANGULAR_VELOCITY),
        ("1e3 g", 1.0, Dimension.MASS),
        ("5 N·m", 5.0, Dimension.TORQUE),
        ("5 Nm", 5.0, Dimension.TORQUE),
        ("2700 kg/m³", 2700.0, Dimension.DENSITY),
        ("2.7 g/cm^3", 2700.0, Dimension.DENSITY),
        ("3 kg*m**2", 3.0, Dimension.INERTIA),
        ("36 km/h", 10.0, Dimension.VELOCITY),
    ],
)
def test_a_number_and_a_unit_are_a_quantity_in_si(text: str, value: float, dimension: Dimension):
    assert parse_quantity(text) == Quantity(value, dimension)


@pytest.mark.parametrize(
    "text", ["", "mm", "5", "5 parsec", "1_000 mm", "٣ mm", "² mm", "0x10 mm", "inf m", "nan m", "5 N m", "1,5 mm"]
)
def test_anything_else_is_no_quantity(text: str):
    assert parse_quantity(text) is None


def test_an_unknown_unit_is_still_seen_as_one():
    assert unit_text("5 parsec") == "parsec"
    assert unit_text("5") is None
    assert unit_text("left arm") is None


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e999 mm", math.inf),
        ("-1e400 km", -math.inf),
        (f"{'9' * 320} kg", math.inf),
        (f"-{'9' * 320} mm", -math.inf),
        ("1e-999 deg", 0.0),
    ],
)
def test_a_number_beyond_a_double_is_infinite_and_quick(text: str, value: float):
    quantity = parse_quantity(text)
    assert quantity is not None
    assert quantity.value == value


def test_digits_without_end_are_refused_rather_than_computed():
    assert parse_quantity("1e999999999 mm") is None
    assert parse_quantity("9" * 100_000 + " mm") is None


@given(finite, st.sampled_from([unit for unit in UNITS.values() if not unit.per_pi]))
def test_decimal_units_convert_to_the_nearest_double(number: float, unit):
    quantity = parse_quantity(f"{number!r} {unit.name}")
    assert quantity is not None
    exact = Fraction(repr(number)) * Fraction(unit.numerator, unit.denominator)
    try:
        assert quantity.value == float(exact)
    except OverflowError:
        assert quantity.value == math.copysign(math.inf, number)


@given(finite)
def test_degrees_are_what_radians_gives(degrees: float):
    quantity = parse_quantity(f"{degrees!r} deg")
    assert quantity is not None
    assert quantity.value == math.radians(degrees)


def test_every_dimension_names_its_si_unit_first():
    for dimension in Dimension:
        assert units_of(dimension)[0] == dimension.si_unit
        assert UNITS[dimension.si_unit].to_si("1") == 1


@given(finite)
def test_number_text_reads_back_to_the_same_double(number: float):
    text = number_text(number)
    assert float(text) == number
    assert len(text) <= len(repr(number))


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (4.0, "4"),
        (-0.0, "0"),
        (0.1, "0.1"),
        (1e-07, "1e-7"),
        (1.5e300, "1.5e300"),
        (1e16, "1e16"),
        (10**20, "100000000000000000000"),
    ],
)
def test_numbers_are_as_short_as_they_can_be(number: float, text: str):
    assert number_text(number) == text


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble, np.asarray])
def test_a_float_of_numpy_is_spelled_as_the_double_that_it_is(kind):
    assert number_text(kind(0.5)) == "0.5"
    assert float(number_text(kind(0.1))) == float(kind(0.1))


@pytest.mark.parametrize("kind", [np.int8, np.int32, np.int64, np.uint8, np.uint64, np.asarray])
def test_an_integer_of_numpy_is_spelled_with_every_digit(kind):
    assert number_text(kind(100)) == "100"


@pytest.mark.parametrize(("word", "unit"), [("degrees", "deg"), ("°/s", "deg/s"), ("nm", "N*m"), ("kg*m2", "kg*m^2")])
def test_a_word_for_a_unit_is_known_and_not_taken(word: str, unit: str):
    meant = suggested_unit(word)
    assert meant is not None
    assert meant.name == unit
    assert parse_quantity(f"1 {word}") is None


@pytest.mark.parametrize(
    ("word", "unit"),
    [
        ("milimeter", "mm"),
        ("milimeters", "mm"),
        ("Centimters", "cm"),
        ("meteres", "m"),
        ("inchs", "in"),
        ("degress", "deg"),
        ("radain", "rad"),
        ("secound", "s"),
        ("killogram", "kg"),
        ("micometer", "um"),
    ],
)
def test_a_misspelt_word_for_a_unit_is_known(word: str, unit: str):
    meant = suggested_unit(word)
    assert meant is not None
    assert meant.name == unit


@pytest.mark.parametrize(
    "word", ["decimeter", "nanometer", "picometer", "furlong", "grads", "miles", "hours", "milliampere", "micrograms"]
)
def test_a_word_for_a_unit_that_is_not_there_suggests_none(word: str):
    assert suggested_unit(word) is None


def test_no_unit_is_a_word_for_another():
    assert [unit for unit in UNITS if suggested_unit(unit)] == []


SPELLINGS = {spelling for name in UNITS for spelling in (name, *spellings_of(name))}
WRITTEN = [
    spelling.replace("*", product).replace("^2", square).replace("^3", cube)
    for spelling in sorted(SPELLINGS)
    for product, square, cube in (("*", "^2", "^3"), ("·", "²", "³"), ("⋅", "**2", "**3"))
]


@pytest.mark.parametrize("dimension", Dimension)
def test_the_pattern_of_a_dimension_matches_its_units_and_no_other(dimension: Dimension):
    matched = {unit for unit in [*WRITTEN, "parsec", "kg*m2", "m m", ""] if re.fullmatch(pattern_of([dimension]), unit)}
    assert matched == {unit for unit in WRITTEN if parse_quantity(f"1 {unit}").dimension is dimension}
