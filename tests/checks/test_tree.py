import pytest

from linkforge_compile.checks import check
from linkforge_compile.core import Robot
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import body, fixed, messages_of, robot


def test_a_tree_is_fine():
    assert messages_of(robot("base arm hand", fixed("a", "base", "arm"), fixed("h", "arm", "hand"))) == []


def test_a_robot_without_links_is_reported_by_its_name():
    assert messages_of(Robot("ghost")) == ["LF5401 robot 'ghost' has no links; a robot has at least one"]


def test_a_joint_built_in_python_is_named_with_its_missing_link():
    assert messages_of(robot("base forearm", fixed("elbow", "base", "fore_arm"))) == [
        "LF4102 joint 'elbow': no link named 'fore_arm'; did you mean 'forearm'?"
    ]


def test_two_joints_with_one_missing_link_are_two_faults():
    subject = robot("base", fixed("a", "bse", "base"), fixed("b", "base", "bse"))
    assert len(messages_of(subject)) == 2


def test_what_is_known_to_be_missing_is_not_reported_again():
    subject = robot("base", fixed("elbow", "base", "lost"), fixed("wrist", "base", "left_hand"))
    assert messages_of(subject, UnresolvedNames(frozenset({"lost"}), ("left_",))) == []


def test_a_second_parent_is_reported_at_the_second_joint():
    subject = robot("base left right hand", fixed("l", "base", "left"), fixed("r", "base", "right"))
    subject.joints += (fixed("first", "left", "hand"), fixed("second", "right", "hand"))
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.message == (
        "joint 'second': link 'hand' is the child of two joints, 'first' and 'second'; correct the 'child' of one"
    )
    assert [note.message for note in diagnostic.notes] == ["joint 'first' attaches 'hand' to 'left'"]


@pytest.mark.parametrize("closing_joint_first", [False, True])
def test_a_joint_back_up_the_tree_is_one_circle_and_no_second_parent(closing_joint_first: bool):
    joints = [fixed("down", "base", "a"), fixed("on", "a", "b"), fixed("back", "b", "a")]
    subject = robot("base a b", *reversed(joints) if closing_joint_first else joints)
    assert messages_of(subject) == ["LF5403 joint 'back': links are each other's parents in a cycle: a → b → a"]


def test_a_circle_without_a_root_is_reported_once_with_all_its_joints():
    subject = robot("a b c", fixed("ab", "a", "b"), fixed("bc", "b", "c"), fixed("ca", "c", "a"))
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.message == "joint 'ca': links are each other's parents in a cycle: a → b → c → a"
    assert [note.message for note in diagnostic.notes] == ["joint 'ab' leads to 'b'", "joint 'bc' leads to 'c'"]


def test_two_joints_back_to_one_link_are_two_circles():
    subject = robot("a b", fixed("down", "a", "b"), fixed("up", "b", "a"), fixed("again", "b", "a"))
    assert messages_of(subject) == [
        "LF5403 joint 'up': links are each other's parents in a cycle: a → b → a",
        "LF5403 joint 'again': links are each other's parents in a cycle: a → b → a",
    ]


@pytest.mark.parametrize(
    ("links", "root"),
    [
        ("mount bracket arm elbow hand", "mount"),
        ("arm elbow hand mount bracket", "arm"),
        ("arm elbow hand world bracket", "world"),
    ],
)
def test_the_root_is_the_world_or_what_was_written_first(links: str, root: str):
    """Of two trees the larger one is the arm, whose joint to its base is missing."""
    base = "world" if root == "world" else "mount"
    joints = (fixed("a", base, "bracket"), fixed("b", "arm", "elbow"), fixed("c", "elbow", "hand"))
    (diagnostic,) = check(robot(links, *joints), UnresolvedNames())
    assert f" from '{root}' to " in diagnostic.message


def test_several_roots_are_reported_once_with_a_note_for_each():
    subject = robot("camera base arm lidar", fixed("shoulder", "base", "arm"))
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.message == (
        "the robot has 3 roots, 'camera', 'base' and 'lidar'; "
        "connect them, for example with a fixed joint from 'base' to 'camera'"
    )
    assert [note.message for note in diagnostic.notes] == [
        "'base' is the root of 2 links",
        "'camera' has no joints",
        "'lidar' has no joints",
    ]


def test_base_link_is_the_parent_in_the_advice_even_where_more_links_hang_on_another():
    message = messages_of(robot("base_link base arm", fixed("weld", "base", "arm")))[0]
    assert message.endswith("for example with a fixed joint from 'base_link' to 'base'")


def test_many_roots_are_counted_and_not_all_spelled_out():
    message = messages_of(robot(" ".join(f"l{number}" for number in range(100))))[0]
    assert message.startswith("LF5404 the robot has 100 roots, ")
    assert "'l6' and 93 more" in message


def test_a_link_that_a_misspelt_joint_left_alone_is_no_second_fault():
    subject = robot("base arm hand", fixed("a", "base", "arm"), fixed("h", "arm", "hnad"))
    assert messages_of(subject) == ["LF4102 joint 'h': no link named 'hnad'; did you mean 'hand'?"]


def test_a_link_that_a_copied_child_left_alone_is_no_second_fault():
    subject = robot("base arm hand", fixed("a", "base", "arm"), fixed("h", "base", "arm"))
    assert [one[:6] for one in messages_of(subject)] == ["LF5402"]


def test_the_tree_is_not_checked_while_parts_of_it_are_missing():
    assert messages_of(robot("base camera"), UnresolvedNames(frozenset({"mount"}))) == []
    assert messages_of(Robot("r"), UnresolvedNames(prefixes=("",))) == []


def test_a_chain_of_10000_links_is_checked_without_recursion():
    links = [body(f"l{number}") for number in range(10_000)]
    joints = [fixed(f"j{number}", f"l{number}", f"l{number + 1}") for number in range(9_999)]
    chain = Robot("r", links=links, joints=joints)
    assert messages_of(chain) == []
    chain.add_joint(fixed("back", "l9999", "l0"))
    assert messages_of(chain) == [
        "LF5403 joint 'back': links are each other's parents in a cycle: l0 → l1 → l2 → l3 → l4 → … → l9999 → l0"
    ]


def test_a_raw_joint_may_be_the_one_that_is_missed():
    raw = '<joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint>'
    assert messages_of(robot("base arm", extra_elements=(raw,))) == []
