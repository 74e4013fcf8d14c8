import math
from dataclasses import replace

import pytest

from linkforge_compile.core import (
    GroupState,
    JointLimits,
    JointMimic,
    PassiveJoint,
    PlanningGroup,
    Robot,
    SemanticRobotDescription,
    VirtualJoint,
)
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import LEFT, chain, messages_of, robot, turning, two_arms


@pytest.mark.parametrize("position", [-1.0, 1.0, 1.00004, math.sin(1)])
def test_a_state_within_its_limits_is_fine(position: float):
    assert (
        messages_of(two_arms(groups=(LEFT,), group_states=(GroupState("s", "left", {"left_shoulder": position}),)))
        == []
    )


def test_a_state_outside_its_limits_is_reported_in_radians():
    state = GroupState("up", "left", {"left_shoulder": 1.5})
    assert messages_of(two_arms(groups=(LEFT,), group_states=(state,))) == [
        "LF5606 state 'up' of group 'left': joint 'left_shoulder' goes from -1 to 1 rad, found 1.5"
    ]


def test_a_state_of_a_joint_that_is_not_in_its_group_is_reported():
    state = GroupState("up", "left", {"right_shoulder": 0})
    assert messages_of(two_arms(groups=(LEFT,), group_states=(state,))) == [
        "LF5604 state 'up' of group 'left': joint 'right_shoulder' is not in group 'left', so state 'up' cannot set it"
    ]


@pytest.mark.parametrize(
    "group",
    [
        PlanningGroup("g", links=("left_arm",)),
        PlanningGroup("g", joints=("left_shoulder",)),
        PlanningGroup("g", subgroups=("left",)),
        chain("g", "right_hand", "left_hand"),
    ],
)
def test_a_joint_is_in_a_group_in_every_form(group: PlanningGroup):
    messages = messages_of(two_arms(groups=(LEFT, group), group_states=(GroupState("s", "g", {"left_shoulder": 0}),)))
    assert not [message for message in messages if message.startswith("LF5604")]


def test_a_group_with_an_unknown_name_is_not_checked_further():
    group = PlanningGroup("g", joints=("left_shoulder", "lost"))
    messages = messages_of(two_arms(groups=(group,), group_states=(GroupState("s", "g", {"right_shoulder": 0}),)))
    assert messages == ["LF4103 planning group 'g': no joint named 'lost'"]


def test_a_value_for_each_coordinate_of_the_joint():
    virtual = VirtualJoint("world_joint", "planar", "world", "torso")
    group = PlanningGroup("all", joints=("world_joint", "left_shoulder", "left_wrist"))
    state = GroupState("s", "all", {"world_joint": (0.0, 0.0), "left_shoulder": (0.0, 0.0), "left_wrist": 0})
    assert messages_of(two_arms(virtual_joints=(virtual,), groups=(group,), group_states=(state,))) == [
        "LF5605 state 's' of group 'all': state of planar joint 'world_joint' takes 3 values: x, y and angle, "
        "found 2 values, [0, 0]",
        "LF5605 state 's' of group 'all': state of revolute joint 'left_shoulder' takes 1 value, "
        "found 2 values, [0, 0]",
        "LF5605 state 's' of group 'all': state of fixed joint 'left_wrist' takes no value, "
        "found the value 0; leave it out",
    ]


BOTH = PlanningGroup("both", subgroups=("left", "right"))
RIGHT = chain("right", "torso", "right_hand")


def test_a_state_that_leaves_a_joint_open_is_noted():
    subject = two_arms(groups=(LEFT, RIGHT, BOTH), group_states=(GroupState("up", "both", {"left_shoulder": 0}),))
    assert messages_of(subject) == ["LF5613 state 'up' of group 'both' does not place 'right_shoulder'"]
    assert messages_of(subject, UnresolvedNames(frozenset({"lost"}))) == []


def test_fixed_and_passive_joints_need_no_place():
    subject = two_arms(
        groups=(LEFT,), group_states=(GroupState("up", "left"),), passive_joints=(PassiveJoint("left_shoulder"),)
    )
    assert messages_of(subject) == []


def test_a_joint_that_is_misspelt_is_not_missed_as_well():
    states = (GroupState("up", "left", {"left_sholder": 0}),)
    assert messages_of(two_arms(groups=(LEFT,), group_states=states)) == [
        "LF4103 state 'up' of group 'left': no joint named 'left_sholder'; did you mean 'left_shoulder'?"
    ]


def gripper(**fingers: float) -> Robot:
    """Return two fingers, the right at minus twice the left and 0.1, in a state `s` with these positions."""
    left = turning("left", "palm", "left_tip")
    limits = JointLimits(-2.0, 2.2)
    right = replace(turning("right", "palm", "right_tip", limits=limits), mimic=JointMimic("left", -2.0, 0.1))
    group = PlanningGroup("g", joints=("left", "right"))
    semantic = SemanticRobotDescription(groups=(group,), group_states=(GroupState("s", "g", fingers),))
    return robot("palm left_tip right_tip", left, right, semantic=semantic)


def test_a_follower_need_not_be_placed():
    assert messages_of(gripper(left=0.2)) == []


def test_a_follower_is_where_its_leader_puts_it():
    assert messages_of(gripper(left=0.2, right=-0.3)) == []
    assert messages_of(gripper(left=0.1234, right=-0.147)) == []
    assert messages_of(gripper(left=0.2, right=0.3)) == [
        "LF5614 state 's' of group 'g': joint 'right' mimics 'left', which puts it at -0.3 in this state, found 0.3"
    ]
