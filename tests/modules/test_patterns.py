"""Patterns of parameters: what Python's own matcher says, in time that nobody can make long."""

import re
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.modules.patterns import MAX_TEXT, Pattern, PatternError

ATOMS = [
    "a",
    "b",
    ".",
    r"\d",
    r"\w",
    r"\s",
    r"\S",
    "[ab]",
    "[^a]",
    "[a-c_1]",
    r"[^\w]",
    "_",
    "1",
    "^",
    "$",
    r"\b",
    r"\Z",
]
SUFFIXES = ["", "*", "+", "?", "{2}", "{1,3}", "{2,}", "*?", "+?"]
PATTERNS = st.recursive(
    st.sampled_from(ATOMS),
    lambda inner: st.one_of(
        st.tuples(inner, inner).map("".join),
        st.tuples(inner, inner).map(lambda two: f"(?:{two[0]}|{two[1]})"),
        st.tuples(inner, st.sampled_from(SUFFIXES)).map(lambda one: f"({one[0]}){one[1]}"),
    ),
    max_leaves=8,
)


@given(PATTERNS, st.text("ab_1 \n", max_size=8))
def test_it_matches_what_python_matches(pattern: str, text: str):
    assert Pattern(pattern).is_in(text) == bool(re.search(pattern, text))


@pytest.mark.parametrize(
    "pattern",
    [
        "(a+)+$",
        "(a|a)*b",
        "(a|aa)+$",
        "(.*)*b",
        ".*.*.*.*.*.*.*.*b",
        "((((((a?)*)*)*)*)*)*b",
        "(a{0,40}){0,20}b",
        "(?:){1,1900}b",
    ],
)
def test_no_pattern_takes_long(pattern: str):
    started = time.process_time()
    Pattern(pattern).is_in("a" * (MAX_TEXT - 1) + "!")
    assert time.process_time() - started < 5


@pytest.mark.parametrize(
    ("pattern", "reason"),
    [
        ("(", "missing ), unterminated subpattern"),
        (r"(a)\1", "a reference to a group cannot be matched in bounded time"),
        ("a(?!b)", "look-around cannot be matched in bounded time"),
        ("(?<=a)b", "look-around cannot be matched in bounded time"),
        ("(?i)a", "flags such as (?i) are not part of it"),
        ("a(?i:b)", "a group with flags cannot be matched in bounded time"),
        (r"\Ba", r"\B cannot be matched in bounded time"),
        ("(a{0,99}){0,99}", "it counts further than 2,000 steps"),
        ("(?:){1,60000}", "it counts further than 2,000 steps"),
        ("a" * 501, "it is longer than 500 characters"),
    ],
)
def test_what_cannot_be_bounded_is_refused(pattern: str, reason: str):
    with pytest.raises(PatternError, match=re.escape(reason)):
        Pattern(pattern)


def test_long_text_is_not_looked_through():
    assert Pattern("a").is_in("a" * MAX_TEXT)
    assert not Pattern("a").is_in("a" * (MAX_TEXT + 1))
