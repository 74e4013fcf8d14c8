"""The semantic description and its parts."""

import math

import pytest
from hypothesis import given

from linkforge_compile.core.exceptions import RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere
from tests.strategies import semantics


@pytest.mark.parametrize(
    ("make", "code", "field"),
    [
        (lambda: VirtualJoint(" ", "fixed", "world", "base"), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: VirtualJoint("v", "revolute", "world", "base"), ValidationErrorCode.INVALID_VALUE, ("type",)),
        (lambda: GroupState("", "arm"), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: GroupState("home", " "), ValidationErrorCode.NAME_EMPTY, ("group",)),
        (lambda: EndEffector("", "hand", "tool"), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: EndEffector("e", "", "tool"), ValidationErrorCode.NAME_EMPTY, ("group",)),
        (lambda: PassiveJoint("\n"), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: CollisionPair("", "b"), ValidationErrorCode.NAME_EMPTY, ("link1",)),
        (lambda: CollisionPair("a", ""), ValidationErrorCode.NAME_EMPTY, ("link2",)),
        (lambda: CollisionPair("a", "a"), ValidationErrorCode.INVALID_VALUE, ("link2",)),
        (lambda: Chain(" ", "b"), ValidationErrorCode.NAME_EMPTY, ("base_link",)),
        (lambda: Chain("a", " "), ValidationErrorCode.NAME_EMPTY, ("tip_link",)),
        (lambda: PlanningGroup(""), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: PlanningGroup("arm"), ValidationErrorCode.VALUE_EMPTY, ()),
        (lambda: SrdfSphere(0, 0, 0, -1), ValidationErrorCode.INVALID_VALUE, ("radius",)),
        (lambda: LinkSphereApproximation(""), ValidationErrorCode.NAME_EMPTY, ("link",)),
        (lambda: JointProperty("", "p", "v"), ValidationErrorCode.VALUE_EMPTY, ("joint_name",)),
        (lambda: JointProperty("j", "p", " "), ValidationErrorCode.VALUE_EMPTY, ("value",)),
    ],
)
def test_what_means_nothing_is_refused(make, code, field):
    with pytest.raises(RobotValidationError) as caught:
        make()
    assert caught.value.code is code
    assert caught.value.field == field


def test_what_srdf_allows():
    assert Chain("a", "a").tip_link == "a"
    assert SrdfSphere(0, 0, 0, 0).radius == 0
    assert EndEffector("e", "hand", "").parent_link == ""
    assert PlanningGroup("all", subgroups=["arm"]).links == ()


def test_positions_become_tuples():
    state = GroupState("home", "arm", {"a": 1, "b": [1, 2.5], "c": "pi", "d": (0,), "e": {3}})
    assert state.joint_values == {"a": (1.0,), "b": (1, 2.5), "c": ("pi",), "d": (0,), "e": (3,)}


def test_a_position_is_a_number():
    with pytest.raises(RobotMathError) as caught:
        GroupState("home", "arm", {"a": [0, math.nan]})
    assert caught.value.field == ("a", 1)
    with pytest.raises(RobotMathError) as caught:
        SrdfSphere(0, math.inf, 0, 1)
    assert caught.value.field == ("center", 1)


def test_a_pair_is_not_its_mirror_but_has_its_key():
    forth, back = CollisionPair("b", "a"), CollisionPair("a", "b")
    assert forth != back
    assert forth.key == back.key == ("a", "b")


WHOLE = SemanticRobotDescription(
    "arm",
    [VirtualJoint("v", "fixed", "world", "base")],
    [PlanningGroup("g", ["l"], ["j"], [Chain("base", "tip")], ["h"])],
    [GroupState("home", "g", {"j": 1})],
    [EndEffector("e", "h", "tip", "g")],
    [PassiveJoint("p")],
    [CollisionPair("a", "b", "Never")],
    [CollisionPair("a", "c")],
    ["d"],
    [LinkSphereApproximation("l", [SrdfSphere(0, 0, 0, 1)])],
    [JointProperty("j", "wraps", "true")],
)


def test_a_prefix_reaches_every_name_but_the_frame_of_the_world():
    assert WHOLE.with_prefix("x_") == SemanticRobotDescription(
        "x_arm",
        [VirtualJoint("x_v", "fixed", "world", "x_base")],
        [PlanningGroup("x_g", ["x_l"], ["x_j"], [Chain("x_base", "x_tip")], ["x_h"])],
        [GroupState("x_home", "x_g", {"x_j": 1})],
        [EndEffector("x_e", "x_h", "x_tip", "x_g")],
        [PassiveJoint("x_p")],
        [CollisionPair("x_a", "x_b", "Never")],
        [CollisionPair("x_a", "x_c")],
        ["x_d"],
        [LinkSphereApproximation("x_l", [SrdfSphere(0, 0, 0, 1)])],
        [JointProperty("x_j", "wraps", "true")],
    )


def test_merging_appends_the_other_and_keeps_the_name():
    merged = WHOLE.merge_with(WHOLE.with_prefix("x_"))
    assert merged.robot_name == "arm"
    assert [group.name for group in merged.groups] == ["g", "x_g"]
    assert [pair.key for pair in merged.disabled_collisions] == [("a", "b"), ("x_a", "x_b")]
    assert merged.no_default_collision_links == ("d", "x_d")


@pytest.mark.parametrize(
    ("collection", "name"),
    [
        ("virtual_joints", "v"),
        ("groups", "g"),
        ("group_states", "g/home"),
        ("end_effectors", "e"),
        ("passive_joints", "p"),
        ("link_sphere_approximations", "l"),
        ("joint_properties", "j/wraps"),
    ],
)
def test_merging_never_lets_one_of_two_namesakes_vanish(collection, name):
    part = SemanticRobotDescription(**{collection: getattr(WHOLE, collection)})
    with pytest.raises(RobotValidationError) as caught:
        WHOLE.merge_with(part)
    assert caught.value.code is ValidationErrorCode.DUPLICATE_NAME
    assert caught.value.value == name


def test_states_of_one_name_in_two_groups_are_two_states():
    home = SemanticRobotDescription(group_states=[GroupState("home", "other", {"k": 0})])
    assert [state.group for state in WHOLE.merge_with(home).group_states] == ["g", "other"]


def test_a_pair_disabled_by_both_is_written_once_with_the_first_reason():
    other = SemanticRobotDescription(
        disabled_collisions=[CollisionPair("b", "a", "Default"), CollisionPair("c", "d"), CollisionPair("d", "c")],
        no_default_collision_links=["d"],
    )
    merged = WHOLE.merge_with(other)
    assert merged.disabled_collisions == (CollisionPair("a", "b", "Never"), CollisionPair("c", "d"))
    assert merged.no_default_collision_links == ("d",)


def test_merging_loses_no_extras():
    ours = SemanticRobotDescription(extra_elements=["<a/>"], extra_attributes={"x": "1"})
    theirs = SemanticRobotDescription(extra_elements=["<b/>"], extra_attributes={"x": "2", "y": "3"})
    merged = ours.merge_with(theirs)
    assert merged.extra_elements == ("<a/>", "<b/>")
    assert dict(merged.extra_attributes) == {"x": "1", "y": "3"}


def test_normalizing_sorts_by_name_and_pairs_by_their_links():
    mixed = SemanticRobotDescription(
        groups=[PlanningGroup("b", ["z", "y"]), PlanningGroup("a", ["x"])],
        group_states=[GroupState("a", "h"), GroupState("b", "g")],
        disabled_collisions=[CollisionPair("c", "b"), CollisionPair("z", "a")],
    ).normalized()
    assert [group.name for group in mixed.groups] == ["a", "b"]
    assert mixed.groups[1].links == ("z", "y")
    assert [state.name for state in mixed.group_states] == ["b", "a"]
    assert mixed.disabled_collisions == (CollisionPair("z", "a"), CollisionPair("c", "b"))


@given(semantics)
def test_normalizing_twice_is_normalizing_once(semantic):
    assert semantic.normalized().normalized() == semantic.normalized()
