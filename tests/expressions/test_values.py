"""Values of expressions: Python's numbers, quantities that keep their dimension, text inside of text."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.syntax import has_expression
from linkforge_compile.units import Dimension, Quantity
from tests.expressions.compute import compute

LENGTH = Quantity(0.5, Dimension.LENGTH)
ANGLE = Quantity(0.25, Dimension.ANGLE)
NAMES: dict[str, Value] = {
    "reach": LENGTH,
    "tilt": ANGLE,
    "count": 3,
    "side": "left",
    "on": True,
    "nothing": None,
    "xyz": (1, 2.5, LENGTH),
    "sizes": (4, 2, 7, 1),
    "row": {"mass": 2, "limits": {"x": 9}, "1": "one", "class": "c"},
    "µ": 0.8,
}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("plain", "plain"),
        ("$(2 * 3)", 6),
        ("$(6 / 3)", 2.0),
        ("$(1/2)", 0.5),
        ("$(7 // 2 + 7 % 4)", 6),
        ("$(2 ** -1)", 0.5),
        ("$( (-2) ** 2 )", 4),
        ("$(1 ** 99999)", 1),
        ("$(0 < count <= 3)", True),
        ("$(count != 3 or not on)", False),
        ("$(1 if on else count / 0)", 1),
        ("$('left' == side)", True),
        ("$(nothing == null)", True),
        ("$(nothing != count)", True),
        ("$(2 in sizes and 5 not in sizes)", True),
        ("$('mass' in row and 1 in row and 'ef' in side)", True),
        ("$(side + '_arm')", "left_arm"),
        ("$(true)", True),
        ("$(null)", None),
        ("$(pi)", math.pi),
        ("$(xyz)", NAMES["xyz"]),
        ("$(xyz.y + xyz[0] + xyz[-2])", 6.0),
        ("$(row.mass)", 2),
        ("$(row['limits'].x)", 9),
        ("$(row[1])", "one"),
        ("$(row['class'])", "c"),
        ("$(µ)", 0.8),
        ("$(min(sizes) + max(1, 2, 3))", 4),
        ("$(round(2.5))", 2),
        ("$(round(2.567, 1))", 2.6),
        ("$(floor(-0.5) + ceil(0.5))", 0),
        ("$(abs(-2) + sqrt(16))", 6.0),
        ("$(len(sizes) + len(row) + len(side))", 12),
        ("$(merge(row, row.limits))", {**NAMES["row"], "x": 9}),
        ("$(merge(row.limits, row, row.limits).x)", 9),
        ("$(join(xyz))", "1 2.5 0.5"),
        ("at $(join(sizes, ', ')).", "at 4, 2, 7, 1."),
        ("$(split(' 1 -2.5e-1\\tleft 1.2.3 '))", (1, -0.25, "left", "1.2.3")),
        ("$(split(''))", ()),
        ("$(split(join(sizes))[1] + 1)", 3),
        ("$(int('12') + int(2.9))", 14),
        ("$(float('1e-3'))", 0.001),
        ("$(str(4.0) + str(on))", "4true"),
        ("$(degrees(pi))", 180.0),
        ("$('a)b')", "a)b"),
        ("$(\n  count\n  + 1\n)", 4),
    ],
)
def test_an_expression_gives_a_value_of_its_own_type(text: str, value: Value):
    result = compute(text, dict(NAMES))
    assert result.reported == []
    assert (result.value, type(result.value)) == (value, type(value))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("wheel_$(side)_$(count)", "wheel_left_3"),
        ("$(0.1 + 0.2) and $(4.0) and $(on)", "0.30000000000000004 and 4 and true"),
        (" $(side)", " left"),
        ("$(reach) m", "0.5 m"),
        ("$$(side) costs $5", "$(side) costs $5"),
        ("$$$(side)", "$$(side)"),
    ],
)
def test_inside_text_a_value_is_its_shortest_text(text: str, value: str):
    assert compute(text, dict(NAMES)) == (value, [])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$(reach + 1)", Quantity(1.5, Dimension.LENGTH)),
        ("$(1 - reach)", Quantity(0.5, Dimension.LENGTH)),
        ("$(-reach % 0.2)", Quantity(-0.5 % 0.2, Dimension.LENGTH)),
        ("$(2 * reach / 4)", Quantity(0.25, Dimension.LENGTH)),
        ("$(min(reach, 2, 3))", LENGTH),
        ("$(max(xyz))", Quantity(2.5, Dimension.LENGTH)),
        ("$(abs(-tilt))", ANGLE),
        ("$(round(tilt, 1))", Quantity(0.2, Dimension.ANGLE)),
        ("$(reach if reach > 0.1 else 0)", LENGTH),
        ("$(radians(180))", Quantity(math.pi, Dimension.ANGLE)),
        ("$(asin(1))", Quantity(math.pi / 2, Dimension.ANGLE)),
        ("$(atan2(reach, reach))", Quantity(math.pi / 4, Dimension.ANGLE)),
        ("$(1 / reach)", 2.0),
        ("$(reach * reach)", 0.25),
        ("$(reach / reach)", 1.0),
        ("$(tilt / reach)", 0.5),
        ("$(reach ** 2)", 0.25),
        ("$(sqrt(reach * 2 * reach))", math.sqrt(0.5)),
        ("$(sin(tilt) - sin(0.25))", 0.0),
        ("$(degrees(tilt))", math.degrees(0.25)),
        ("$(float(reach))", 0.5),
        ("$(reach == 0.5)", True),
    ],
)
def test_quantities_keep_their_dimension_until_a_product_makes_another(text: str, value: Value):
    assert compute(text, dict(NAMES)) == (value, [])


def test_the_fast_check_sees_every_dollar_and_parenthesis():
    assert has_expression("a $(b)")
    assert has_expression("$$(b)")
    assert not has_expression("$5 (b)")


LEAVES = st.integers(0, 10**6).map(str) | st.floats(0, 1e6, allow_nan=False).map(repr)
ARITHMETIC = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "//", "%"]), inner).map(
            lambda parts: f"({' '.join(parts)})"
        ),
        st.tuples(inner, st.integers(-3, 3)).map(lambda parts: f"({parts[0]} ** {parts[1]})"),
        inner.map(lambda operand: f"-{operand}"),
        st.tuples(inner, inner).map(lambda parts: f"max({', '.join(parts)})"),
        inner.map(lambda operand: f"abs({operand})"),
        st.tuples(inner, inner, inner).map(lambda parts: f"({parts[0]} if {parts[1]} < {parts[2]} else {parts[1]})"),
    ),
    max_leaves=12,
)


REFUSED = ("divides by zero", "is not a finite number")


@given(ARITHMETIC)
def test_arithmetic_agrees_with_python(expression: str):
    result = compute(f"$({expression})")
    if result.value is FAULT:
        ((_, sentence),) = result.reported
        assert sentence.endswith(REFUSED)
        return
    wanted = eval(expression)  # the judge: Python itself, on an expression that this test made
    assert (result.value, type(result.value)) == (wanted, type(wanted))


@given(ARITHMETIC)
def test_quantities_reckon_as_their_numbers_do(expression: str):
    bare, length = (
        compute(f"$({expression})"),
        compute(f"$(({expression}) * one)", {"one": Quantity(1.0, Dimension.LENGTH)}),
    )
    if bare.value is FAULT:
        assert length.value is FAULT
    else:
        assert length.value == Quantity(float(bare.value), Dimension.LENGTH)  # type: ignore[arg-type]  # a number
