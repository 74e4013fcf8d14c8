import math

import pytest

from linkforge_compile.core import (
    Chain,
    EndEffector,
    GroupState,
    PlanningGroup,
    Robot,
    SemanticRobotDescription,
    VirtualJoint,
)
from tests.checks.robots import fixed, robot, told, turning


def two_arms(**semantic: object) -> Robot:
    """Return a torso with a left and a right arm; each has a shoulder that turns in [-1, 1] and a fixed hand."""
    joints = [
        joint
        for side in ("left", "right")
        for joint in (
            turning(f"{side}_shoulder", "torso", f"{side}_arm"),
            fixed(f"{side}_wrist", f"{side}_arm", f"{side}_hand"),
        )
    ]
    description = SemanticRobotDescription(**semantic)  # type: ignore[arg-type]
    return robot("torso left_arm left_hand right_arm right_hand", *joints, semantic=description)


def chain(name: str, base: str, tip: str) -> PlanningGroup:
    return PlanningGroup(name, chains=(Chain(base, tip),))


LEFT = chain("left", "torso", "left_hand")


def test_groups_that_contain_one_another_are_told_once():
    groups = (LEFT, PlanningGroup("a", subgroups=("left", "b")), PlanningGroup("b", subgroups=("a",)))
    assert told(two_arms(groups=groups)) == [
        "LF5601 planning group 'b': planning groups contain one another in a circle: a → b → a"
    ]


def test_a_chain_of_one_link_is_fine():
    assert told(two_arms(groups=(chain("g", "torso", "torso"),))) == []


def test_a_chain_with_its_ends_swapped_is_an_error():
    assert told(two_arms(groups=(chain("g", "left_hand", "torso"),))) == [
        "LF5602 planning group 'g': no chain leads from 'left_hand' down to 'torso'; "
        "'left_hand' hangs below 'torso': swap them"
    ]


def test_a_chain_from_hand_to_hand_is_a_warning():
    assert told(two_arms(groups=(chain("g", "left_hand", "right_hand"),))) == [
        "LF5603 planning group 'g': 'right_hand' does not hang below 'left_hand'; "
        "MoveIt goes up to 'torso' and down again"
    ]


@pytest.mark.parametrize("position", [-1.0, 1.0, 1.00004, math.sin(1)])
def test_a_state_within_its_limits_is_fine(position: float):
    assert told(two_arms(groups=(LEFT,), group_states=(GroupState("s", "left", {"left_shoulder": position}),))) == []


def test_a_state_outside_its_limits_is_told_in_radians():
    state = GroupState("up", "left", {"left_shoulder": 1.5})
    assert told(two_arms(groups=(LEFT,), group_states=(state,))) == [
        "LF5606 state 'up' of group 'left': joint 'left_shoulder' goes from -1 to 1 rad, found 1.5"
    ]


def test_a_state_of_a_joint_that_is_not_in_its_group_is_told():
    state = GroupState("up", "left", {"right_shoulder": 0})
    assert told(two_arms(groups=(LEFT,), group_states=(state,))) == [
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
def test_a_joint_is_in_a_group_however_that_is_said(group: PlanningGroup):
    messages = told(two_arms(groups=(LEFT, group), group_states=(GroupState("s", "g", {"left_shoulder": 0}),)))
    assert not [message for message in messages if message.startswith("LF5604")]


def test_what_a_group_holds_is_not_judged_while_one_of_its_names_is_unknown():
    group = PlanningGroup("g", joints=("left_shoulder", "lost"))
    messages = told(two_arms(groups=(group,), group_states=(GroupState("s", "g", {"right_shoulder": 0}),)))
    assert messages == ["LF4103 planning group 'g': no joint named 'lost'"]


def test_a_value_for_each_coordinate_of_the_joint():
    virtual = VirtualJoint("world_joint", "planar", "world", "torso")
    group = PlanningGroup("all", joints=("world_joint", "left_shoulder", "left_wrist"))
    state = GroupState("s", "all", {"world_joint": (0.0, 0.0), "left_shoulder": (0.0, 0.0), "left_wrist": 0})
    assert told(two_arms(virtual_joints=(virtual,), groups=(group,), group_states=(state,))) == [
        "LF5605 state 's' of group 'all': state of planar joint 'world_joint' takes 3 values: x, y and angle, found 2",
        "LF5605 state 's' of group 'all': state of revolute joint 'left_shoulder' takes 1 value, found 2",
        "LF5605 state 's' of group 'all': state of fixed joint 'left_wrist' takes no value, found 1",
    ]


HAND = PlanningGroup("hand", links=("left_hand",))


def test_an_end_effector_on_the_tip_of_its_parent_group_is_fine():
    assert told(two_arms(groups=(LEFT, HAND), end_effectors=(EndEffector("e", "hand", "left_hand", "left"),))) == []


def test_the_base_link_of_a_chain_is_not_in_its_group():
    assert told(two_arms(groups=(LEFT, HAND), end_effectors=(EndEffector("e", "hand", "torso", "left"),))) == [
        "LF5608 end effector 'e': parent link 'torso' is not in parent group 'left'"
    ]


def test_a_group_cannot_be_its_own_parent():
    assert told(two_arms(groups=(HAND,), end_effectors=(EndEffector("e", "hand", "left_hand", "hand"),))) == [
        "LF5607 end effector 'e': group 'hand' of this end effector cannot be its own parent group"
    ]
