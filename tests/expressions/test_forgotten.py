import pytest

from linkforge_compile.expressions import as_one_expression, forgotten_expression
from linkforge_compile.source import SourceFile

NAMES = {"track", "row", "a"}


def place_of(text: str):
    return SourceFile("test.yaml", text).whole


@pytest.mark.parametrize(
    ("text", "meant"),
    {
        "track / 2": "$(track / 2)",
        " track ": "$(track)",
        "row.mass[0]": "$(row.mass[0])",
        "max(a, track)": "$(max(a, track))",
        "1/2": "$(1/2)",
        "not a": "$(not a)",
        "pi": "$(pi)",
    }.items(),
)
def test_text_that_computes_with_known_names_is_a_forgotten_expression(text: str, meant: str):
    assert forgotten_expression(text, place_of(text), NAMES) == meant


@pytest.mark.parametrize(
    "text",
    [
        "",
        "width / 2",
        "trackk",
        "5",
        "-5",
        "- -5",
        "'a'",
        "true",
        "null",
        "90 deg",
        "a) + (a",
        "$(a) / 2",
        "a b",
        "a, a",
    ],
)
def test_other_text_is_kept_as_it_is(text: str):
    assert forgotten_expression(text, place_of(text), NAMES) is None


@pytest.mark.parametrize(
    ("text", "meant"),
    {
        "$(track) / 2": "$(track / 2)",
        "-$(a)": "$(-a)",
        "$(a + 1) * $(track)": "$((a + 1) * track)",
        "$(a) > 3 and $(not a)": "$(a > 3 and (not a))",
    }.items(),
)
def test_text_around_expressions_is_put_into_one(text: str, meant: str):
    assert as_one_expression(text, place_of(text), NAMES) == meant


@pytest.mark.parametrize("text", ["$(track / 2)", "$(a) mm", "wheel_$(a)", "$(a)$(track)", "$(a / 2"])
def test_text_that_would_be_no_expression_is_left_alone(text: str):
    assert as_one_expression(text, place_of(text), NAMES) is None
