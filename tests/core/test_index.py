"""An index is a tuple to whoever compares or adds it, and answers to names."""

import copy
import pickle
from operator import attrgetter

import pytest

from linkforge_compile.core import Index, Joint, Link, Robot, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.index import Filing, Repeats

A, B, C = Link("a"), Link("b"), Link("c")
PARENT = attrgetter("parent")


def linked(*links: Link) -> Index[Link]:
    return Index(links, Filing("link"))


def test_it_compares_and_adds_as_a_tuple():
    index, pair, single = linked(A, B), (A, B), (C,)
    assert index == pair
    assert pair == index
    assert index == linked(A, B)
    assert index != [A, B]
    assert index + single == (A, B, C)
    assert single + index == (C, A, B)
    assert repr(index) == repr(pair)
    assert hash(Index((1, 2))) == hash((1, 2))


def test_it_gives_items_by_position_slice_and_name():
    index = linked(A, B, C)
    assert (index[0], index[-1], index["b"]) == (A, C, B)
    assert index[1:] == (B, C)
    with pytest.raises(IndexError):
        index[3]
    with pytest.raises(RobotValidationError, match="'d' not found") as refused:
        index["d"]
    assert refused.value.code is ValidationErrorCode.NOT_FOUND


def test_it_holds_names_as_well_as_items():
    index = linked(A, B)
    assert "a" in index
    assert B in index
    assert "c" not in index
    assert C not in index
    assert index.get("c") is None
    assert index.names == ("a", "b")


def test_it_matches_as_a_sequence():
    match linked(A, B):
        case [first, *rest]:
            assert (first, rest) == (A, [B])


def test_a_longer_one_leaves_the_shorter_as_it_was():
    short = linked(A)
    long = short.extended((B,))
    assert (short, long) == ((A,), (A, B))
    assert short.get("b") is None
    assert "b" not in short


def test_two_that_grow_from_one_do_not_meet():
    root = linked(A)
    left, right = root.extended((B,)), root.extended((C,))
    assert (left, right) == ((A, B), (A, C))
    assert left.get("c") is None
    assert right.get("b") is None


def test_a_repeated_name_is_refused_also_among_what_is_added():
    with pytest.raises(RobotValidationError, match="Duplicate link name: 'b'") as refused:
        linked(A).extended((B, Link("b")))
    assert (refused.value.code, refused.value.value) == (ValidationErrorCode.DUPLICATE_NAME, "b")


def test_what_was_refused_can_be_added_without_its_repetition():
    index = linked(A)
    with pytest.raises(RobotValidationError):
        index.extended((B, A))
    assert index.extended((B,)) == (A, B)


def test_where_names_repeat_the_first_one_answers():
    index = Index(("left", "link"), Filing("word", key=lambda word: word[0], repeats=Repeats.KEPT))
    assert index.get("l") == "left"
    assert index.extended(("last",)).get("l") == "left"


def test_it_finds_items_by_any_key_in_their_order():
    joints = [Joint(name, "fixed", parent, name) for name, parent in (("x", "a"), ("y", "b"), ("z", "a"))]
    index = Index(joints, Filing("joint"))
    assert [joint.name for joint in index.where(PARENT, "a")] == ["x", "z"]
    longer = index.extended((Joint("w", "fixed", "a", "w"),))
    assert [joint.name for joint in longer.where(PARENT, "a")] == ["x", "z", "w"]
    assert [joint.name for joint in index.where(PARENT, "a")] == ["x", "z"]
    assert list(index.where(PARENT, "nobody")) == []


def test_a_link_that_is_renamed_in_place_is_found_by_its_new_name_alone():
    link = Link("old")
    index = linked(A, link)
    assert index.get("old") is link
    link.name = "new"
    assert index.get("new") is link
    assert index.get("old") is None


def test_copies_and_pickles_are_equal_and_answer():
    index = linked(A, B).extended((C,))
    for other in (copy.copy(index), copy.deepcopy(index), pickle.loads(pickle.dumps(index))):
        assert other == index
        assert other.get("c") == C
    assert copy.deepcopy(index)[0] is not A


def test_assigning_a_collection_rebuilds_its_index():
    robot = Robot("r", links=[Link("a")])
    robot.links = [Link("b")]
    assert robot.get_link("a") is None
    assert robot.has_link("b")


def test_assigning_two_links_of_one_name_leaves_the_robot_as_it_was():
    robot = Robot("r", links=[Link("a")])
    with pytest.raises(RobotValidationError, match="Duplicate"):
        robot.links = [Link("b"), Link("b")]
    assert robot.links == (Link("a"),)
