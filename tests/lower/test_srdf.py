import pytest

from linkforge_compile.core import (
    Chain,
    CollisionPair,
    EndEffector,
    JointProperty,
    LinkSphereApproximation,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    SrdfSphere,
    VirtualJoint,
)
from tests.lower.specs import lowered, robot_of


def semantic_of(text: str) -> SemanticRobotDescription:
    return robot_of("name: arm\nsemantic:\n" + text).semantic


def test_every_field_of_the_semantic_part():
    assert semantic_of("""
  virtual_joints: {world_joint: {type: planar, parent_frame: world, child_link: base}}
  groups:
    arm: {chain: {base_link: base, tip_link: tool0}}
    hand: {links: [palm], joints: [grip], chains: [{base_link: palm, tip_link: tip}]}
    all: {subgroups: [arm, hand]}
  end_effectors: {gripper: {group: hand, parent_link: tool0, parent_group: arm}}
  passive_joints: [caster]
  disabled_collisions: {base: {upper: Adjacent, tool0: }}
  enabled_collisions: {palm: {tip: }}
  no_default_collision_links: [tool0]
  joint_properties: {shoulder: {angle_wraparound: true, note: 007, none: null, nothing: }}
  link_sphere_approximations: {base: [{center: [0, 0, 10 cm], radius: 0.1}], tool0: }
""") == SemanticRobotDescription(
        robot_name="arm",
        virtual_joints=(VirtualJoint("world_joint", "planar", "world", "base"),),
        groups=(
            PlanningGroup("arm", chains=(Chain("base", "tool0"),)),
            PlanningGroup("hand", ("palm",), ("grip",), (Chain("palm", "tip"),)),
            PlanningGroup("all", subgroups=("arm", "hand")),
        ),
        end_effectors=(EndEffector("gripper", "hand", "tool0", "arm"),),
        passive_joints=(PassiveJoint("caster"),),
        disabled_collisions=(CollisionPair("base", "upper", "Adjacent"), CollisionPair("base", "tool0")),
        enabled_collisions=(CollisionPair("palm", "tip"),),
        no_default_collision_links=("tool0",),
        joint_properties=(
            JointProperty("shoulder", "angle_wraparound", "true"),
            JointProperty("shoulder", "note", "007"),
            JointProperty("shoulder", "none", "null"),
        ),
        link_sphere_approximations=(
            LinkSphereApproximation("base", (SrdfSphere(0, 0, 0.1, 0.1),)),
            LinkSphereApproximation("tool0"),
        ),
    )


def test_both_links_of_a_pair_are_found_in_the_text():
    (pair,) = semantic_of("  disabled_collisions:\n    base: {upper: Never}").disabled_collisions
    assert str(pair.source.at("link1")) == "spec.yaml:4:5"
    assert str(pair.source.at("link2")) == "spec.yaml:4:12"
    assert str(pair.source.at("reason")) == "spec.yaml:4:19"


def states_of(text: str) -> dict[str, dict[str, tuple[float, ...]]]:
    groups = "  groups: {arm: {joints: [a]}, hand: {joints: [h]}, both: {subgroups: [arm, hand]}}\n"
    states = semantic_of(f"{groups}  group_states:\n{text}").group_states
    return {f"{state.group}/{state.name}": dict(state.joint_values) for state in states}


def test_a_state_gives_positions_by_joint():
    states = states_of("    arm: {home: {a: 1, rail: 20 mm, drift: [1, 2, 1 rad], unsaid: }, rest: }")
    assert states == {"arm/home": {"a": (1,), "rail": (0.02,), "drift": (1, 2, 1)}, "arm/rest": {}}


def test_a_state_has_the_positions_of_the_states_it_names_in_any_order():
    states = states_of("""
    both: {ready: {arm: up, hand: open, rail: 3}}
    arm: {up: {a: 1}}
    hand: {open: {h: 2, arm: up}}
""")
    assert states["both/ready"] == {"a": (1,), "h": (2,), "rail": (3,)}
    assert list(states) == ["both/ready", "arm/up", "hand/open"]


def test_a_faulty_state_and_its_users_are_reported_once():
    result = lowered(
        """
        name: arm
        semantic:
          groups: {arm: {joints: [a]}, both: {subgroups: [arm]}}
          group_states:
            arm:
              up: {a: .inf}   # E[LF5004]:15 joint 'a' must be a finite number, found .inf
              flat: [1]   # E[LF5001]:13 state 'flat' of group 'arm' takes a map of positions by joint, found a list
            both: {up: {arm: up}, flat: {arm: flat}}
        """
    )
    assert result.robot.semantic.group_states == ()


def test_a_chain_of_a_thousand_states_is_no_recursion():
    chain = "".join(f"    g{i}: {{s: {{g{i + 1}: s}}}}\n" for i in range(1000)) + "    g1000: {s: {a: 1}}\n"
    groups = "".join(f"    g{i}: {{joints: [a]}}\n" for i in range(1001))
    states = semantic_of(f"  groups:\n{groups}  group_states:\n{chain}").group_states
    assert len(states) == 1001
    assert all(dict(state.joint_values) == {"a": (1,)} for state in states)


def test_a_faulty_group_is_a_gap():
    result = lowered(
        """
        name: arm
        semantic:
          groups:
            arm:
              chain: {base_link: base}
              # ^E[LF5005]:14 group 'arm' has no 'chain.tip_link'; write one, such as 'tip_link: tool0'
        """
    )
    assert "arm" in result.unresolved


@pytest.mark.parametrize("text", ["", "semantic:"])
def test_a_robot_without_semantics_has_no_semantic_part(text):
    assert not robot_of(f"name: arm\n{text}").has_semantic
