"""Plain scalars follow YAML 1.2's core schema, unlike PyYAML's loaders."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.syntax import scalar_value


@pytest.mark.parametrize("text", ["", "~", "null", "Null", "NULL"])
def test_null_has_five_spellings(text: str):
    assert scalar_value(text) is None


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("FALSE", False),
        ("0", 0),
        ("-12", -12),
        ("+7", 7),
        ("010", 10),
        ("0o10", 8),
        ("0x1F", 31),
        ("1e-3", 0.001),
        ("1E3", 1000.0),
        (".5", 0.5),
        ("-1.", -1.0),
        ("685_230", "685_230"),
        (".inf", math.inf),
        ("-.INF", -math.inf),
    ],
)
def test_plain_text_becomes_a_value_of_its_own_type(text: str, value: object):
    result = scalar_value(text)
    assert (result, type(result)) == (value, type(value))


def test_nan_is_a_number():
    assert math.isnan(scalar_value(".nan"))  # type: ignore[arg-type]  # a float, as it says


@pytest.mark.parametrize(
    "text",
    ["on", "no", "yes", "1:30", "90 deg", "nULL", "e3", ".", "-", "0b1", "1 2", "inf", "٣", "²", "1e", "<<", "="],
)
def test_everything_else_is_text(text: str):
    assert scalar_value(text) == text


@pytest.mark.parametrize(
    ("text", "value"), [("9" * 5_000, math.inf), ("-" + "9" * 309, -math.inf), ("1e999", math.inf)]
)
def test_numbers_beyond_a_double_are_infinite_and_do_not_hang(text: str, value: float):
    assert scalar_value(text) == value


@given(st.integers(-(10**300), 10**300))
def test_whole_numbers_keep_every_digit(number: int):
    assert scalar_value(str(number)) == number


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_that_python_writes_are_read_back(number: float):
    assert scalar_value(repr(number)) == number


@given(st.text())
def test_no_text_is_refused(text: str):
    scalar_value(text)
