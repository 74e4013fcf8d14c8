"""A pattern of ours is what `re` would make of it, as soon as it is used."""

import copy
import pickle
import re
from importlib import import_module
from pathlib import Path

import pytest

from linkforge_compile.pattern import Characters, pattern

PACKAGE = Path(__file__).parents[1] / "linkforge_compile"
USERS = [
    file.relative_to(PACKAGE.parent).with_suffix("").as_posix().replace("/", ".")
    for file in sorted(PACKAGE.rglob("*.py"))
    if "from linkforge_compile.pattern import" in file.read_text("utf-8")
]


def test_it_does_what_the_compiled_one_does():
    unit = pattern(r"(?P<number>\d+) *MM", re.IGNORECASE)
    assert unit.fullmatch("3 mm")["number"] == "3"
    assert unit.fullmatch("3 m") is None
    assert unit.fullmatch("4 mm")["number"] == "4"
    assert unit.sub("-", "1 mm, 2 mm") == "-, -"
    assert (unit.pattern, unit.groups) == (r"(?P<number>\d+) *MM", 1)
    assert pattern(rb"\d").findall(b"1a2") == [b"1", b"2"]


@pytest.mark.parametrize("through", [lambda one: pickle.loads(pickle.dumps(one)), copy.copy, copy.deepcopy])
def test_its_copies_are_compiled(through):
    assert through(pattern("a", re.IGNORECASE)) == re.compile("a", re.IGNORECASE)


def test_one_that_is_not_made_yet_has_no_attributes():
    assert not hasattr(pattern.__new__(pattern), "fullmatch")


def test_it_is_compiled_as_it_is_used():
    faulty = pattern("(")
    with pytest.raises(re.error, match="missing \\)"):
        faulty.search("a")


def test_what_no_pattern_has_is_told_so():
    with pytest.raises(AttributeError, match="fulmatch"):
        pattern("a").fulmatch("a")


@pytest.mark.parametrize("module", USERS)
def test_no_faulty_one_waits_for_a_user(module):
    values = vars(import_module(module)).values()
    waiting = [value for value in values if isinstance(value, pattern)]
    assert all(isinstance(value.pattern, str | bytes) for value in waiting)
    sets = [value for value in values if isinstance(value, Characters)]
    assert all(value.search("e") is value.search("é") is None for value in sets)
    assert waiting or sets


@pytest.mark.parametrize("text", ["", "plain", "a\tb", "é", "é\t", "\u2028", "a\ud800", "b\x7f"])
def test_characters_are_found_as_by_a_pattern(text: str):
    ours, theirs = Characters("\t\x7f", "\u2028\ud800-\udfff"), re.compile("[\t\x7f\u2028\ud800-\udfff]")
    found, sought = ours.search(text), theirs.search(text)
    assert (found and found.span()) == (sought and sought.span())
    assert ours.sub("?", text) == theirs.sub("?", text)
