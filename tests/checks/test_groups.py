from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.checks.groups import LinkSets
from linkforge_compile.core import Chain, EndEffector, GroupState, PlanningGroup, SemanticRobotDescription
from tests.checks.robots import LEFT, chain, fixed, messages_of, robot, two_arms

HAND = PlanningGroup("hand", links=("left_hand",))


def test_groups_that_contain_one_another_are_reported_once():
    groups = (LEFT, PlanningGroup("a", subgroups=("left", "b")), PlanningGroup("b", subgroups=("a",)))
    assert messages_of(two_arms(groups=groups)) == [
        "LF5601 planning group 'b': planning groups contain each other in a cycle: a → b → a"
    ]


def test_a_chain_of_one_link_makes_a_group_without_joints():
    state = GroupState("home", "g", {"left_shoulder": 0})
    groups = (
        chain("g", "torso", "torso"),
        PlanningGroup("h", subgroups=("g",)),
        PlanningGroup("root", links=("torso",)),
    )
    assert messages_of(two_arms(groups=groups, group_states=(state,))) == [
        "LF5617 planning group 'g' has no joint, so MoveIt ignores it",
        "LF5617 planning group 'h' has no joint, so MoveIt ignores it",
    ]


def test_a_chain_with_its_ends_swapped_is_an_error():
    assert messages_of(two_arms(groups=(chain("g", "left_hand", "torso"),))) == [
        "LF5602 planning group 'g': no chain leads from 'left_hand' down to 'torso', "
        "because 'left_hand' is below 'torso'; swap them"
    ]


def test_a_chain_from_hand_to_hand_is_a_warning():
    assert messages_of(two_arms(groups=(chain("g", "left_hand", "right_hand"),))) == [
        "LF5603 planning group 'g': 'right_hand' is not below 'left_hand'; MoveIt goes up to 'torso' and down again"
    ]


def test_an_end_effector_on_the_tip_of_its_parent_group_is_fine():
    assert (
        messages_of(two_arms(groups=(LEFT, HAND), end_effectors=(EndEffector("e", "hand", "left_hand", "left"),))) == []
    )


def test_the_base_link_of_a_chain_is_not_in_its_group():
    assert messages_of(two_arms(groups=(LEFT, HAND), end_effectors=(EndEffector("e", "hand", "torso", "left"),))) == [
        "LF5608 end effector 'e': parent link 'torso' is not in parent group 'left'"
    ]


def test_a_group_cannot_be_its_own_parent():
    assert messages_of(two_arms(groups=(HAND,), end_effectors=(EndEffector("e", "hand", "left_hand", "hand"),))) == [
        "LF5607 end effector 'e': group 'hand' of this end effector cannot be its own parent group"
    ]


def test_an_end_effector_that_no_group_carries_is_noted():
    hand_alone = two_arms(groups=(HAND,), end_effectors=(EndEffector("e", "hand", "left_arm"),))
    assert messages_of(hand_alone) == [
        "LF5616 end effector 'e': no planning group contains parent link 'left_arm', so MoveIt finds no arm for it"
    ]
    assert messages_of(two_arms(groups=(LEFT, HAND), end_effectors=(EndEffector("e", "hand", "left_arm"),))) == []


@given(st.lists(st.integers(0, 9), min_size=1, max_size=9), st.integers(0, 9), st.integers(0, 9))
def test_a_chain_moves_what_hangs_between_its_ends_and_the_link_where_its_branches_meet(
    parents: list[int], base: int, tip: int
):
    """A parent that is not above its link represents an unconnected link."""
    above = {f"l{link}": f"l{parent}" for link, parent in enumerate(parents, start=1) if parent < link}
    names = ["l0", *(f"l{link}" for link in range(1, len(parents) + 1))]
    ends = Chain(names[base % len(names)], names[tip % len(names)])
    links = LinkSets(robot(" ".join(names), *(fixed(f"j_{child}", above[child], child) for child in above)))

    def way_up(link: str) -> list[str]:
        return [link, *(way_up(above[link]) if link in above else [])]

    from_base, from_tip = way_up(ends.base_link), way_up(ends.tip_link)
    meeting = next((link for link in from_tip if link in from_base), None)
    moved = set(from_base) ^ set(from_tip) | {link for link in (meeting,) if link and link != ends.base_link}
    assert links.meeting_link(ends) == meeting
    assert links.between(ends) == (links.of(moved) if meeting else None)


def test_a_way_up_goes_round_a_circle_once():
    links = LinkSets(robot("a b c", fixed("j", "a", "b"), fixed("k", "b", "a"), fixed("l", "b", "c")))
    assert [links.meeting_link(Chain(*ends)) for ends in ("bc", "ca", "cc", "ab")] == ["b", "a", "c", "a"]
    assert links.between(Chain("b", "c")) == links.of("c")


def test_a_group_that_refers_to_a_cycle_is_checked_as_others_are():
    circle = (fixed("j", "a", "b"), fixed("k", "b", "a"), fixed("l", "b", "c"))
    effector = EndEffector("e", parent_link="d", group="arm")
    semantic = SemanticRobotDescription(groups=(chain("arm", "b", "c"),), end_effectors=(effector,))
    codes = [one[:6] for one in messages_of(robot("a b c d", *circle, semantic=semantic))]
    assert codes == ["LF5403", "LF5616"]
