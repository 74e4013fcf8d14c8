"""What expressions refuse and where it is reported; untrusted expressions run no code and end in time."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Value, parse_template
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.units import Dimension, Quantity
from tests.expressions.compute import compute, whole

CANNOT = "an expression cannot contain"

NAMES: dict[str, Value] = {
    "reach": Quantity(0.5, Dimension.LENGTH),
    "tilt": Quantity(0.25, Dimension.ANGLE),
    "count": 3,
    "zero": 0,
    "side": "left",
    "on": True,
    "nothing": None,
    "sizes": (4, 2, 7, 1),
    "row": {"mass": 2, "limits": {"effort": 9}},
    "endless": float("inf"),
}


@pytest.mark.parametrize(
    ("text", "place", "problem"),
    [
        ("$(count count)", "c", "something is missing or unexpected here"),
        ("$(count + )", ")", "something is missing or unexpected here"),
        ("$(on && on)", "&&", "write 'and' for '&&'"),
        ("$(on || on)", "||", "write 'or' for '||'"),
        ("$(!on)", "!", "write 'not' for '!'"),
        ("$(count = 3)", "=", "compare two values with '=='"),
        ("$(on ? 1 : 2)", "?", "write: a if condition else b"),
        ("$(1 if on)", "if", "'if' needs an 'else'"),
        ("$(count # note)", "#", "expressions cannot contain comments"),
        ("$(${side})", "${", "write names without '$' here"),
        ("$(90 deg + tilt)", "90 deg", "units are not allowed here; declare '90 deg' in 'variables'"),
        ("$(count − 1)", "−", "write '-' for '−'"),
        ("$(row.class)", ".class", "'class' is a reserved word; read that key with ['class']"),
        ("$(arg side)", "arg side", "'$(arg ...)' and '$(eval ...)' are xacro; write $(side)"),
        ("$(find ur)/x", "find ur", "'$(find ...)' is xacro; write package://ur/..."),
    ],
)
def test_habits_from_elsewhere_are_reported_what_is_written_here(text: str, place: str, problem: str):
    assert compute(text, dict(NAMES)) == (FAULT, [(place, f"cannot read this expression: {problem}")])


@pytest.mark.parametrize(
    ("text", "place", "sentence"),
    [
        ("a $(side", "$(", "'$(' has no closing ')'; for a literal '$(' write '$$('"),
        ("$(f('a)", "'", "no closing quote for the text that begins here"),
        ("$( )", "$( )", "expected an expression between '$(' and ')', found nothing"),
        ("$(2 ^ 3)", "^", f"{CANNOT} '^'; write '**' for powers"),
        ("$((on) & (on))", "&", f"{CANNOT} '&'; write 'and' between conditions"),
        ("$(count is not 3)", "is not", f"{CANNOT} 'is not'; compare values with '!='"),
        ("$(True)", "True", f"{CANNOT} 'True'; write 'true'"),
        ("$(sizes[1:2])", "1:2", f"{CANNOT} a slice; read items one by one: list[0]"),
        (
            "$(m.sin(1))",
            "m.sin",
            "an expression cannot call 'm.sin'; write sin(angle)",
        ),
        ("$(ä + count)", "ä", "no parameter, variable or 'for' name 'ä' here"),
        ("$(rech)", "rech", "no parameter, variable or 'for' name 'rech' here; did you mean 'reach'?"),
        ("$(1 if on else rech)", "rech", "no parameter, variable or 'for' name 'rech' here; did you mean 'reach'?"),
        ("$(sinn(1))", "sinn", "no function named 'sinn'; did you mean 'sin'?"),
        ("$(sin)", "sin", "'sin' is a function; write sin(angle)"),
        ("$(atan2(1))", "atan2(1)", "expected atan2(y, x), found 1 argument"),
        ("$(link('base'))", "link", "no function named 'link'"),
        ("$(joint(count))", "count", "joint() takes text, found a number"),
        ("$(path())", "path()", "expected path(file), found 0 arguments"),
        ("$(on + 1)", "on", "'+' takes a number, found true"),
        ("$('a' * 3)", "'a'", "'*' takes a number, found the text 'a'"),
        ("$(not count)", "count", "'not' takes true or false, found a number"),
        ("$(1 if 'false' else 2)", "'false'", "'if' takes true or false, found the text 'false'"),
        ("$(on == 'true')", "on == 'true'", "'==' compares values of one kind, found true and the text 'true'"),
        ("$(row == 1)", "row", "'==' takes single values, found a map"),
        ("$(reach + tilt)", "reach + tilt", "'+' takes values of one dimension, found a length and an angle"),
        ("$(0 < reach < tilt)", "0 < reach < tilt", "'<' takes values of one dimension, found a length and an angle"),
        ("$(max(tilt, reach))", "max(tilt, reach)", "max() takes values of one dimension, found an angle and a length"),
        ("$(cos(reach))", "reach", "cos() takes an angle, found a length"),
        ("$(radians(tilt))", "tilt", "radians() takes a bare number, found an angle"),
        ("$(2 ** reach)", "reach", "'**' takes a bare exponent, found a length"),
        ("$(1 / (zero))", "zero", "'/' divides by zero"),
        ("$(sqrt(-4))", "-4", "sqrt() takes 0 or more, found -4"),
        ("$(acos(1.5))", "1.5", "acos() takes -1 to 1, found 1.5"),
        ("$((-8) ** 0.5)", "-8", "'**' takes a base of 0 or more, found -8"),
        ("$(9 ** 9 ** 9)", "9 ** 9 ** 9", "the result of '**' is not a finite number"),
        ("$(10.0 ** 400)", "10.0 ** 400", "the result of '**' is not a finite number"),
        ("$(sin(endless))", "sin(endless)", "the result of sin() is not a finite number"),
        ("$(floor(endless))", "floor(endless)", "the result of floor() is not a finite number"),
        ("$(1e999)", "1e999", "the result of this number is not a finite number"),
        ("$(row.limts)", "limts", "no key 'limts' in this map; did you mean 'limits'?"),
        ("$(row['mas'])", "'mas'", "no key 'mas' in this map; did you mean 'mass'?"),
        ("$(sizes[4])", "4", "no item 4 in a list of 4; the first is 0"),
        ("$(sizes[1.0])", "1.0", "a list takes a whole number in its brackets, found a number"),
        ("$(join(side))", "side", "join() takes a list, found the text 'left'"),
        ("$(join(sizes, 1))", "1", "join() takes text between the items, found a number"),
        ("$(split(sizes))", "sizes", "split() takes text, found a list"),
        ("$(split('1 1e999'))", "split('1 1e999')", "the result of split() is not a finite number"),
        ("$(merge(row, sizes))", "sizes", "merge() takes a map, found a list"),
        ("$(side.x)", "side.x", "'.x' takes a map or a vector's x, y, z, found the text 'left'"),
        ("$(count.__class__)", "count.__class__", "'.__class__' takes a map or a vector's x, y, z, found a number"),
        ("arm_$(sizes)", "sizes", "a list cannot be inserted into text; join() makes one text of its items"),
        ("arm_$(nothing)", "nothing", "null cannot be inserted into text"),
    ],
)
def test_a_fault_is_reported_at_its_own_characters(text: str, place: str, sentence: str):
    assert compute(text, dict(NAMES)) == (FAULT, [(place, sentence)])


@pytest.mark.parametrize(
    "expression",
    [
        "lambda: 1",
        "[1, 2]",
        "(1, 2)",
        "{'a': 1}",
        "{1}",
        "[x for x in sizes]",
        "(x for x in sizes)",
        "(x := 1)",
        "f'{side}'",
        "min(*sizes)",
        "round(1, ndigits=2)",
        "await count",
        "(yield)",
        "count @ 2",
        "count | 2",
        "~count",
        "count << 2",
        "count is 3",
        "1j",
        "b'a'",
        "...",
        "'\\x00'",
        "'\\ud800'",
        "().__class__.__base__.__subclasses__()",
        "(lambda: len(().__class__.__base__.__subclasses__()))()",
    ],
)
def test_what_the_language_has_not_is_refused_with_what_to_write_instead(expression: str):
    result = compute(f"$({expression})", dict(NAMES))
    assert result.value is FAULT
    assert result.reported
    assert all(sentence.startswith("an expression cannot ") for _, sentence in result.reported)


@pytest.mark.parametrize("expression", ["open('x')", "__import__('os')", "eval('1')", "print(1)"])
def test_python_s_own_functions_are_unknown(expression: str):
    ((_, sentence),) = compute(f"$({expression})").reported
    assert sentence.startswith("no function named")


@pytest.mark.parametrize(
    "expression",
    ["1" + " + 1" * 300, "-" * 1_900 + "1", "(" * 900 + "1" + ")" * 900, "x" * 3_000, "[" * 900 + "]" * 900],
)
def test_the_size_of_an_expression_is_bounded(expression: str):
    result = compute(f"$({expression})")
    assert result.value is FAULT
    assert len(result.reported) == 1


def test_text_does_not_grow_without_end():
    names: dict[str, Value] = {"long": "x" * 40_000}
    assert compute("$(long + long)", dict(names)).reported == [
        ("long + long", "the text grows beyond 65,536 characters")
    ]
    assert compute("$(long)$(long)", dict(names)).reported == [
        ("$(long)$(long)", "the text grows beyond 65,536 characters")
    ]


def test_a_name_at_fault_is_not_reported_again():
    assert compute("$(broken + 1)", {"broken": FAULT}) == (FAULT, [])
    assert compute("arm_$(broken)", {"broken": FAULT}) == (FAULT, [])


def test_every_unknown_name_of_a_text_is_reported():
    result = compute("$(alpha + beta)_$(gamma)")
    assert [place for place, _ in result.reported] == ["alpha", "beta", "gamma"]


def test_a_fault_in_quotes_is_reported_inside_the_quotes():
    file = SourceFile("x", 'size: "$(1 ^ 2)"')
    sink = Diagnostics()
    parse_template("$(1 ^ 2)", Span(file, 1, 7, 1, 17), sink)
    assert [str(one.span) for one in sink] == ["x:1:12"]


def test_where_text_is_not_as_written_the_whole_scalar_is_reported():
    file = SourceFile("x", 'size: "\\x24(1 ^ 2)"')
    sink = Diagnostics()
    scalar = Span(file, 1, 7, 1, 20)
    parse_template("$(1 ^ 2)", scalar, sink)
    assert [one.span for one in sink] == [scalar]


def test_names_that_mean_something_cannot_be_declared():
    assert {"sin", "pi", "true", "lambda", "prefix", "name", "standalone", "link"} <= RESERVED_NAMES
    assert "reach" not in RESERVED_NAMES


PIECES = [
    *"abxy0123456789.,+-*/%()[]'\"=<>!&|^~?:#$\\{} \n\täµ²",
    "$(",
    ")",
    "reach",
    "sizes",
    "row",
    " if ",
    " else ",
    " and ",
    "not ",
]
PIECES += ["sin(", "round(", "**", "1e999", "max(", "lambda", " for ", " in ", "\\ud800", "ﬁ"]


@given(st.one_of(st.text(), st.lists(st.sampled_from(PIECES), max_size=20).map(lambda pieces: f"$({''.join(pieces)})")))
def test_no_text_breaks_an_expression_and_every_span_lies_in_the_text(text: str):
    sink = Diagnostics()
    span = whole(text)
    parse_template(text, span, sink)
    compute(text, dict(NAMES))
    for reported in sink:
        assert reported.span is not None
        assert span.start <= reported.span.start <= reported.span.end <= span.end


@pytest.mark.parametrize("items", [((1, 2), 3), (None,), ("a" * 40_000, "b" * 40_000)])
def test_join_takes_single_values_of_limited_length(items: tuple[Value, ...]):
    result = compute("$(join(items))", {"items": items})
    assert [text for text, _ in result.reported] in (["items"], ["join(items)"])
