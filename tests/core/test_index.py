"""The collections of a robot are tuples that answer to names as well."""

import copy
import pickle

import pytest

from linkforge_compile.core import (
    IMUInfo,
    Index,
    Joint,
    Link,
    Robot,
    RobotValidationError,
    Sensor,
    SensorType,
    ValidationErrorCode,
)
from linkforge_compile.core.models.named_table import PartList

A, B, C = Link("a"), Link("b"), Link("c")


def linked(*links: Link) -> Index[Link]:
    return Robot("r", links=links).links


def test_it_compares_and_adds_as_a_tuple():
    index, pair, single = linked(A, B), (A, B), (C,)
    assert index == pair
    assert pair == index
    assert index == linked(A, B)
    assert index != [A, B]
    assert index + single == (A, B, C)
    assert single + index == (C, A, B)
    assert repr(index) == repr(pair)
    joints = (Joint("j", "fixed", "a", "b"),)
    assert hash(Robot("r", joints=joints).joints) == hash(joints)


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


def test_what_was_read_stays_as_it_was_when_parts_are_added():
    robot = Robot("r", links=[A])
    short = robot.links
    robot.add_link(B)
    assert (short, robot.links) == ((A,), (A, B))
    assert short.get("b") is None
    assert "b" not in short
    robot.add_link(Link("a", extra_attributes={"x": "1"}), overwrite=True)
    assert short["a"] is A


def test_links_can_be_added_while_the_links_are_walked():
    robot = Robot("r", links=[A, B])
    for link in robot.links:
        robot.add_link(Link(f"{link.name}_copy"))
    assert robot.links.names == ("a", "b", "a_copy", "b_copy")


def test_what_was_refused_can_be_added_without_its_repetition():
    robot = Robot("r", links=[A])
    with pytest.raises(RobotValidationError, match="Duplicate link name: 'b'") as refused:
        robot.add_parts(joints=[Joint("j", "fixed", "a", "b")], links=[B, Link("b")])
    assert (refused.value.code, refused.value.value) == (ValidationErrorCode.DUPLICATE_NAME, "b")
    assert (robot.links, robot.joints) == ((A,), ())
    robot.add_parts(links=[B])
    assert robot.links == (A, B)


def test_where_names_repeat_the_first_one_answers():
    first, second = (Sensor("s", SensorType.IMU, link, imu_info=IMUInfo()) for link in "ab")
    robot = Robot("r", sensors=[first, second])
    assert robot.sensors.get("s") is robot.sensor("s") is first


def test_a_link_that_is_renamed_in_place_is_found_by_its_new_name_alone():
    link = Link("old")
    robot = Robot("r", links=[A, link])
    index = robot.links
    assert index.get("old") is link
    link.name = "new"
    for finder in (index.get, robot.links.get, robot.get_link):
        assert finder("new") is link
        assert finder("old") is None
    robot.add_link(Link("old"))
    with pytest.raises(RobotValidationError, match="Duplicate"):
        robot.add_link(Link("new"))


def test_copies_and_pickles_are_equal_and_answer():
    robot = Robot("r", links=[A, B])
    index = robot.links
    robot.add_link(C)
    for other in (copy.copy(index), copy.deepcopy(index), pickle.loads(pickle.dumps(index))):
        assert other == index
        assert other.get("b") == B
        assert other.get("c") is None
    assert copy.deepcopy(index)[0] is not A


def test_a_copy_of_a_robot_has_lists_of_its_own():
    robot = Robot("r", links=[A, B]).disable_collisions("a", "b")
    other = copy.copy(robot)
    other.add_link(C)
    other.disable_collisions("a", "c")
    assert (len(robot.links), len(robot.semantic.disabled_collisions)) == (2, 1)
    assert (len(other.links), len(other.semantic.disabled_collisions)) == (3, 2)


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


def test_adding_part_after_part_makes_a_table_only_where_one_is_read(monkeypatch):
    made = []
    monkeypatch.setattr(PartList, "table", property(made.append))
    robot = Robot("r")
    for number in range(3):
        robot.add_link(Link(f"l{number}"))
    robot.add_joint(Joint("j", "fixed", "l0", "l1"))
    assert made == []
