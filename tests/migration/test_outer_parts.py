"""What of a macro is about other parts: the file that uses the module has it."""

from pathlib import Path

from tests.migration.migrated import migrated

BASE = '<link name="base"><collision><geometry><sphere radius="1"/></geometry></collision></link>'


def test_a_joint_that_a_condition_leaves_out_is_written_where_the_module_is_used(tmp_path: Path):
    text = f"""
<xacro:arg name="fixed" default="true"/>
<xacro:macro name="arm" params="prefix parent is_fixed">
  <xacro:if value="${{is_fixed}}">
    <joint name="${{prefix}}joint" type="fixed"><parent link="${{parent}}"/><child link="${{prefix}}arm"/></joint>
  </xacro:if>
  <link name="${{prefix}}arm"/>
</xacro:macro>
{BASE}
<xacro:arm prefix="left_" parent="base" is_fixed="true"/>
<xacro:arm prefix="right_" parent="base" is_fixed="$(arg fixed)"/>
<xacro:unless value="$(arg fixed)">
  <joint name="free" type="floating"><parent link="base"/><child link="right_arm"/></joint>
</xacro:unless>
"""
    made = migrated(tmp_path, text)
    assert "right_joint: {when: $(fixed), type: fixed, parent: base, child: right_arm}" in made.robot
    assert "use: arm.robot.yaml" in made.robot
    assert "mount" not in made.files["arm.robot.yaml"]


def test_a_link_beside_the_tree_of_a_module_is_written_where_the_module_is_used(tmp_path: Path):
    text = f"""
<xacro:macro name="leg" params="name">
  <joint name="${{name}}_hip" type="continuous"><parent link="base"/><child link="${{name}}_thigh"/></joint>
  <link name="${{name}}_thigh"/>
  <joint name="${{name}}_knee" type="continuous"><parent link="${{name}}_thigh"/><child link="${{name}}_calf"/></joint>
  <link name="${{name}}_calf"/>
  <joint name="${{name}}_rotor_joint" type="fixed"><parent link="base"/><child link="${{name}}_rotor"/></joint>
  <link name="${{name}}_rotor"/>
  <gazebo reference="${{name}}_rotor"><mu1>0.5</mu1></gazebo>
</xacro:macro>
{BASE}
<xacro:leg name="left"/>
<xacro:leg name="right"/>
"""
    made = migrated(tmp_path, text)
    module = made.files["leg.robot.yaml"]
    assert "mount:\n  $(base_name)_hip: {type: continuous, child: $(base_name)_thigh, axis: x}\n" in module
    assert "rotor" not in module
    assert "left_rotor: {gazebo: {mu1: 0.5}}" in made.robot
    assert "right_rotor_joint: {type: fixed, parent: base, child: right_rotor}" in made.robot


def test_what_two_calls_write_under_one_name_is_not_in_the_module(tmp_path: Path):
    text = f"""
<xacro:macro name="arm" params="prefix">
  <joint name="${{prefix}}joint" type="continuous"><parent link="base"/><child link="${{prefix}}arm"/></joint>
  <link name="${{prefix}}arm"/>
  <ros2_control name="system" type="system">
    <hardware><plugin>p/P</plugin></hardware>
    <joint name="${{prefix}}joint"><command_interface name="position"/></joint>
  </ros2_control>
</xacro:macro>
{BASE}
<xacro:arm prefix="left_"/>
<xacro:arm prefix="right_"/>
"""
    made = migrated(tmp_path, text)
    assert "ros2_control" not in made.files["arm.robot.yaml"]
    assert "left_joint: {command_interfaces: [position]}" in made.robot


def test_a_joint_that_names_the_root_of_one_call_is_written_where_the_module_is_used(tmp_path: Path):
    text = f"""
<xacro:macro name="castor" params="prefix">
  <link name="${{prefix}}_link"/>
  <joint name="${{prefix}}_joint" type="continuous"><parent link="base"/><child link="front_link"/></joint>
</xacro:macro>
{BASE}
<xacro:castor prefix="front"/>
"""
    made = migrated(tmp_path, text)
    assert made.files["castor.robot.yaml"].endswith("links:\n  $(name_prefix)_link: {}\n")
    assert "front_joint: {type: continuous, parent: base, child: front_link, axis: x}" in made.robot


def test_an_unknown_element_under_a_condition_keeps_the_argument(tmp_path: Path):
    text = f"""
<xacro:arg name="debug" default="false"/>
{BASE}
<xacro:if value="$(arg debug)"><sensor name="s"/></xacro:if>
"""
    made = migrated(tmp_path, text)
    assert "debug: {type: boolean, default: false, enum: [false]}" in made.robot
