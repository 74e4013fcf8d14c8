from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.formats.render import render_srdf
from tests.formats.inside import srdf, xml


def test_a_robot_without_semantics_is_an_empty_element():
    assert render_srdf(Robot("r")) == '<?xml version="1.0"?>\n<robot name="r"/>\n'


def test_everything_in_the_order_of_moveit():
    written = srdf(
        virtual_joints=[VirtualJoint("world_joint", "planar", "odom", "base")],
        groups=[
            PlanningGroup("arm", chains=[Chain("base", "tool0")]),
            PlanningGroup("both", ["tool0"], ["finger"], subgroups=["arm", "hand"]),
        ],
        group_states=[GroupState("home", "arm", {"shoulder": 0.0, "world_joint": [0.5, 0, -1]})],
        end_effectors=[EndEffector("hand", "hand", "tool0", "arm"), EndEffector("hook", "hook", "tool0")],
        passive_joints=[PassiveJoint("caster")],
        disabled_collisions=[CollisionPair("base", "upper", "Adjacent"), CollisionPair("a", "b")],
        enabled_collisions=[CollisionPair("base", "tool0", "Needed")],
        no_default_collision_links=["cover"],
        link_sphere_approximations=[LinkSphereApproximation("base", [SrdfSphere(0, 0.1, 0.2, 0.3)])],
        joint_properties=[JointProperty("shoulder", "angle_wraparound", "true")],
    )
    assert written == xml("""
        <group name="arm">
          <chain base_link="base" tip_link="tool0"/>
        </group>
        <group name="both">
          <link name="tool0"/>
          <joint name="finger"/>
          <group name="arm"/>
          <group name="hand"/>
        </group>
        <group_state name="home" group="arm">
          <joint name="shoulder" value="0"/>
          <joint name="world_joint" value="0.5 0 -1"/>
        </group_state>
        <end_effector name="hand" parent_link="tool0" group="hand" parent_group="arm"/>
        <end_effector name="hook" parent_link="tool0" group="hook"/>
        <virtual_joint name="world_joint" type="planar" parent_frame="odom" child_link="base"/>
        <passive_joint name="caster"/>
        <joint_property joint_name="shoulder" property_name="angle_wraparound" value="true"/>
        <link_sphere_approximation link="base">
          <sphere center="0 0.1 0.2" radius="0.3"/>
        </link_sphere_approximation>
        <disable_default_collisions link="cover"/>
        <enable_collisions link1="base" link2="tool0" reason="Needed"/>
        <disable_collisions link1="base" link2="upper" reason="Adjacent"/>
        <disable_collisions link1="a" link2="b"/>
    """)


def test_extras_stand_last():
    assert srdf(extra_elements=["<note>see <b>page 3</b></note>"]) == "<note>see <b>page 3</b></note>\n"
