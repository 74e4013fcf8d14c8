import pytest

from linkforge_compile.core import (
    Chain,
    CollisionPair,
    EndEffector,
    GroupState,
    JointProperty,
    LinkSphereApproximation,
    PassiveJoint,
    PlanningGroup,
    Robot,
    Ros2Control,
    Ros2ControlJoint,
    SemanticRobotDescription,
    VirtualJoint,
)
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import messages_of, robot, turning


def arm(**semantic: object) -> Robot:
    """Return a robot of the links base, arm and hand, the joints shoulder and wrist, and the group `all`."""
    semantic = {"groups": (), **semantic}
    semantic["groups"] = (PlanningGroup("all", joints=("shoulder", "wrist")), *semantic["groups"])  # type: ignore[misc]
    shoulder, wrist = turning("shoulder", "base", "arm"), turning("wrist", "arm", "hand")
    return robot("base arm hand", shoulder, wrist, semantic=SemanticRobotDescription(**semantic))  # type: ignore[arg-type]


NAMES_NOTHING = {
    "LF4102 planning group 'g': no link named 'lost'": {"groups": (PlanningGroup("g", links=("lost",)),)},
    "LF4103 planning group 'g': no joint named 'lost'": {"groups": (PlanningGroup("g", joints=("lost",)),)},
    "LF4104 planning group 'g': no planning group named 'lost'": {"groups": (PlanningGroup("g", subgroups=("lost",)),)},
    "LF4102 planning group 'h': no link named 'lost'": {
        "groups": (PlanningGroup("h", chains=(Chain("lost", "arm"),)),)
    },
    "LF4102 planning group 'i': no link named 'lost'": {
        "groups": (PlanningGroup("i", chains=(Chain("arm", "lost"),)),)
    },
    "LF4104 group state 's': no planning group named 'lost'": {"group_states": (GroupState("s", "lost"),)},
    "LF4103 state 's' of group 'all': no joint named 'lost'": {"group_states": (GroupState("s", "all", {"lost": 0}),)},
    "LF4104 end effector 'e': no planning group named 'lost'": {"end_effectors": (EndEffector("e", "lost", "arm"),)},
    "LF4102 end effector 'e': no link named 'lost'": {"end_effectors": (EndEffector("e", "all", "lost"),)},
    "LF4104 end effector 'f': no planning group named 'lost'": {
        "end_effectors": (EndEffector("f", "all", "arm", "lost"),)
    },
    "LF4102 virtual joint 'v': no link named 'lost'": {
        "virtual_joints": (VirtualJoint("v", "fixed", "world", "lost"),)
    },
    "LF4103 passive_joints: no joint named 'lost'": {"passive_joints": (PassiveJoint("lost"),)},
    "LF4102 collision pair 'arm', 'lost': no link named 'lost'": {
        "disabled_collisions": (CollisionPair("arm", "lost"),)
    },
    "LF4102 collision pair 'lost', 'arm': no link named 'lost'": {
        "enabled_collisions": (CollisionPair("lost", "arm"),)
    },
    "LF4102 no_default_collision_links: no link named 'lost'": {"no_default_collision_links": ("lost",)},
    "LF4102 link_sphere_approximations: no link named 'lost'": {
        "link_sphere_approximations": (LinkSphereApproximation("lost"),)
    },
    "LF4103 joint property 'p': no joint named 'lost'": {"joint_properties": (JointProperty("lost", "p", "1"),)},
}


@pytest.mark.parametrize(("message", "semantic"), NAMES_NOTHING.items(), ids=NAMES_NOTHING)
def test_a_name_that_nothing_bears_is_reported_once(message: str, semantic: dict[str, object]):
    assert messages_of(arm(**semantic)) == [message]


@pytest.mark.parametrize("semantic", NAMES_NOTHING.values(), ids=NAMES_NOTHING)
def test_a_name_that_is_known_to_be_missing_is_not_reported_again(semantic: dict[str, object]):
    assert messages_of(arm(**semantic), UnresolvedNames(frozenset({"lost"}))) == []


def test_groups_and_states_may_name_virtual_joints():
    floating = VirtualJoint("world_joint", "floating", "world", "base")
    group = PlanningGroup("base", joints=("world_joint",))
    state = GroupState("home", "base", {"world_joint": (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)})
    assert messages_of(arm(virtual_joints=(floating,), groups=(group,), group_states=(state,))) == []


def test_a_virtual_joint_holds_the_root():
    assert messages_of(arm(virtual_joints=(VirtualJoint("v", "fixed", "world", "arm"),))) == [
        "LF5609 virtual joint 'v': MoveIt skips a virtual joint to 'arm', which is not the root 'base'"
    ]


def test_a_pair_under_both_of_its_links_is_listed_twice():
    pairs = (CollisionPair("base", "arm"), CollisionPair("arm", "hand"), CollisionPair("arm", "base"))
    assert messages_of(arm(disabled_collisions=pairs)) == ["LF5610 the pair of 'arm' and 'base' is listed twice"]


def test_a_passive_joint_is_not_commanded():
    subject = arm(passive_joints=(PassiveJoint("wrist"),))
    subject.ros2_controls = [
        Ros2Control("hw", hardware_plugin="mock", joints=[Ros2ControlJoint("wrist", ("position",), ("position",))])
    ]
    assert messages_of(subject) == ["LF5611 passive joint 'wrist' is commanded by ros2_control 'hw'"]


def test_a_passive_joint_may_be_read():
    subject = arm(passive_joints=(PassiveJoint("wrist"),))
    joint = Ros2ControlJoint("wrist", (), ("position",))
    subject.ros2_controls = [Ros2Control("hw", hardware_plugin="mock", joints=[joint])]
    assert messages_of(subject) == []


def test_a_virtual_joint_has_a_name_of_its_own():
    assert messages_of(arm(virtual_joints=(VirtualJoint("wrist", "fixed", "world", "base"),))) == [
        "LF5615 virtual joint 'wrist' has the name of another joint, and MoveIt confuses the two; rename it"
    ]


def test_an_enabled_pair_is_an_exception():
    pair = CollisionPair("base", "hand")
    assert messages_of(arm(no_default_collision_links=("hand",), enabled_collisions=(pair,))) == []
    assert messages_of(arm(enabled_collisions=(pair,))) == [
        "LF5618 the pair of 'base' and 'hand' is checked anyway: neither is in 'no_default_collision_links'"
    ]


def test_a_pair_is_not_enabled_and_disabled():
    pair, other = CollisionPair("base", "hand"), CollisionPair("hand", "base", "Never")
    assert messages_of(arm(enabled_collisions=(pair,), disabled_collisions=(other,))) == [
        "LF5612 the pair of 'base' and 'hand' is also disabled, which MoveIt keeps; remove one"
    ]
