"""A module with a virtual joint of its own that is attached to a link."""

from linkforge_compile.core import EndEffector, JointProperty, PassiveJoint, PlanningGroup, VirtualJoint
from linkforge_compile.core.models.srdf import GroupState, SemanticRobotDescription
from linkforge_compile.lower.mount import without_virtual_joint

WHOLE = SemanticRobotDescription(
    virtual_joints=(VirtualJoint("ground", "fixed", "world", "base"),),
    groups=(
        PlanningGroup("all", joints=("ground", "hip"), subgroups=("nested", "leg")),
        PlanningGroup("leg", joints=("hip",)),
        PlanningGroup("stand", joints=("ground",)),
        PlanningGroup("nested", subgroups=("stand",)),
    ),
    group_states=(GroupState("home", "all", {"ground": 0, "hip": 1}), GroupState("here", "stand", {"ground": 0})),
    end_effectors=(EndEffector("foot", "leg", "base", "stand"), EndEffector("floor", "nested", "base")),
    passive_joints=(PassiveJoint("ground"), PassiveJoint("hip")),
    joint_properties=(JointProperty("ground", "weight", "1"), JointProperty("hip", "weight", "1")),
)


def test_all_that_names_a_virtual_joint_goes_with_it():
    assert without_virtual_joint(WHOLE, "ground").semantic == SemanticRobotDescription(
        groups=(PlanningGroup("all", joints=("hip",), subgroups=("leg",)), PlanningGroup("leg", joints=("hip",))),
        group_states=(GroupState("home", "all", {"hip": 1}),),
        end_effectors=(EndEffector("foot", "leg", "base"),),
        passive_joints=(PassiveJoint("hip"),),
        joint_properties=(JointProperty("hip", "weight", "1"),),
    )


def test_removed_and_changed_entries_are_named():
    left = without_virtual_joint(WHOLE, "ground")
    assert left.removed == ("group 'stand'", "group 'nested'", "end effector 'floor'", "state 'here'")
    assert left.changed == (
        "group 'all'",
        "state 'home' of group 'all'",
        "end effector 'foot'",
        "passive_joints",
        "joint_properties",
    )


def test_a_virtual_joint_that_nothing_names_goes_alone():
    bare = SemanticRobotDescription(virtual_joints=WHOLE.virtual_joints, groups=WHOLE.groups[1:2])
    left = without_virtual_joint(bare, "ground")
    assert left.semantic.groups == bare.groups
    assert left.words == ""
