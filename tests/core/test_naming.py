"""What is a name, and what a prefix does to it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.core.naming import is_valid_name, prefixed, prefixed_topic


@pytest.mark.parametrize(
    "name", ["base_link", "tool-0", "arm.v2", "ur/base", "2nd_link", "-x", "Größe", "链接", "हिन्दी", "re\u0301gulateur"]
)
def test_letters_and_digits_of_any_script_are_names(name):
    assert is_valid_name(name)


@pytest.mark.parametrize("name", ["", "a b", "a\n", "a\tb", "a\x00", "a$", "a:b", "$(name)", "a'b", "a\u00a0b", "<a>"])
def test_space_control_and_other_punctuation_are_not(name):
    assert not is_valid_name(name)


def test_hyphens_can_be_refused():
    assert not is_valid_name("tool-0", allow_hyphen=False)
    assert is_valid_name("tool_0", allow_hyphen=False)


@given(st.text(min_size=1))
def test_a_name_of_letters_and_digits_is_always_one(text):
    assert is_valid_name(text) or not text.isalnum()


def test_what_has_no_name_gets_none():
    assert prefixed("left_", "arm") == "left_arm"
    assert prefixed("left_", None) is None
    assert prefixed("left_", "") == ""


@pytest.mark.parametrize(
    ("topic", "expected"), [("scan", "left_scan"), ("/scan", "/scan"), ("~/scan", "~/scan"), (None, None)]
)
def test_an_absolute_topic_is_kept(topic, expected):
    assert prefixed_topic("left_", topic) == expected
