"""Laws that hold for every robot."""

import copy
import pickle
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from linkforge_compile.core import Link, Robot, RobotModelError
from tests.strategies import prefixes, robots

COLLECTIONS = ("links", "joints", "sensors", "transmissions", "ros2_controls", "gazebo_elements", "extra_elements")

# No name that is drawn holds a t or a y, so "at" and "by" are free.
some = settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@some
@given(robots(), prefixes, prefixes)
def test_prefixing_all_composes(robot, inner, outer):
    twice, once = robot.clone(), robot.clone()
    twice.prefix_all(inner)
    twice.prefix_all(outer)
    once.prefix_all(outer + inner)
    assert twice == once


@some
@given(robots(), prefixes)
def test_merging_keeps_every_part_once_and_in_order(component, prefix):
    whole = Robot("whole", links=[Link("at")]).merge(component, "at", "by", prefix=prefix)
    expected = component.clone()
    expected.prefix_all(prefix)
    for collection in COLLECTIONS:
        own = {"links": 1}.get(collection, 0)
        end = {"joints": -1}.get(collection)
        assert getattr(whole, collection)[own:end] == getattr(expected, collection), collection
    assert whole.materials == expected.materials
    assert whole.joint("by").child == expected.root_link.name
    assert len(whole.joints) == len(whole.links) - 1


@some
@given(robots(), prefixes)
def test_merging_under_a_prefix_and_prefixing_before_are_the_same(component, prefix):
    prefixed = component.clone()
    prefixed.prefix_all(prefix)
    one, other = Robot("whole", links=[Link("at")]), Robot("whole", links=[Link("at")])
    assert one.merge(component, "at", "by", prefix=prefix) == other.merge(prefixed, "at", "by")


@some
@given(robots(), prefixes)
def test_merging_twice_under_one_prefix_fails_whole(component, prefix):
    robot = Robot("whole", links=[Link("at")]).merge(component, "at", "by", prefix=prefix)
    before = robot.clone()
    with pytest.raises(RobotModelError):
        robot.merge(component, "at", "again", prefix=prefix)
    assert robot == before
    assert robot.merge(component, "at", "again", prefix=f"t{prefix}").links[: len(before.links)] == before.links


@some
@given(robots())
def test_copies_and_pickles_are_equal_and_of_their_own(robot):
    for other in (robot.clone(), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))):
        assert other == robot
        assert other.has_semantic == robot.has_semantic
        other.links[0].name += "x"
        assert other != robot


@some
@given(robots())
def test_normalizing_again_changes_nothing(robot):
    once = robot.normalized()
    assert once.normalized() == once


@some
@given(robots(), st.data())
def test_normalized_robots_are_equal_whatever_the_order_of_their_parts(robot, data):
    other = robot.clone()
    for collection in COLLECTIONS[:-1]:
        setattr(other, collection, data.draw(st.permutations(getattr(other, collection)), label=collection))
    if robot.has_semantic:
        groups = data.draw(st.permutations(robot.semantic.groups), label="groups")
        pairs = data.draw(st.permutations(robot.semantic.disabled_collisions), label="pairs")
        other.semantic = replace(robot.semantic, groups=groups, disabled_collisions=pairs)
    assert other.normalized() == robot.normalized()
