"""Test patterns of parameters, which RE2 runs in bounded time."""

import re
import sys
import time

import pytest

from linkforge_compile.expand.parameters import MAX_TEXT, Pattern, PatternError


@pytest.mark.parametrize(
    ("pattern", "text", "is_in"),
    [
        ("^[a-z_]+$", "left_arm", True),
        ("^[a-z_]+$", "Left", False),
        ("arm", "left_arm_2", True),
        (r"^(left|right)_\w{3}$", "right_arm", True),
        (r"(?i)\bARM\b", "an arm", True),
        # As docs/language.md says, otherwise than in Python:
        (r"\w", "é", False),
        (r"\pL", "é", True),
        (r"^\d$", "٣", False),
        ("a$", "a\n", False),
        (r"a\z", "a", True),
    ],
)
def test_a_pattern_matches_somewhere_in_the_text(pattern: str, text: str, is_in: bool):
    assert Pattern(pattern).is_in(text) is is_in


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
        "(a?){1000}z",
        "((a?){30}|(b?){30}){30}z",
    ],
)
def test_every_pattern_runs_in_bounded_time(pattern: str):
    started = time.process_time()
    assert not Pattern(pattern).is_in("a" * (MAX_TEXT - 1) + "!")
    assert time.process_time() - started < 1


@pytest.mark.parametrize(
    ("pattern", "reason"),
    [
        ("(", "missing ) at '('"),
        (r"(a)\1", r"invalid escape sequence at '\1'"),
        ("a(?!b)", "invalid perl operator at '(?!'"),
        ("(?<=a)b", "invalid perl operator at '(?<='"),
        ("a++", "bad repetition operator at '++'"),
        (r"a\Z", r"invalid escape sequence at '\Z'"),
        ("((a{99}){99}){99}", "invalid repetition size at '{99}'"),
        (r"\pL{1000}", "pattern too large - compile failed"),
        ("a" * 501, "it is longer than 500 characters"),
    ],
)
def test_what_is_no_pattern_is_refused_in_the_words_of_re2(pattern: str, reason: str):
    with pytest.raises(PatternError, match=f"^{re.escape(reason)}$"):
        Pattern(pattern)


def test_without_its_package_a_pattern_is_refused(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "re2", None)
    with pytest.raises(PatternError, match="google-re2"):
        Pattern("a")


def test_a_byte_of_an_argument_that_is_no_text_is_a_character():
    assert Pattern("^.$").is_in("\udcff")
    assert not Pattern("^[a-z]$").is_in("\udcff")
    assert not Pattern("\ud800").is_in("a")


def test_long_text_is_not_looked_through():
    assert Pattern("a").is_in("a" * MAX_TEXT)
    assert not Pattern("a").is_in("a" * (MAX_TEXT + 1))
