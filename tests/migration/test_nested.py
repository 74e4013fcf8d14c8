"""Macros that call macros."""

from pathlib import Path

from tests.migration.migrated import migrated

LINK = '<link name="${name}"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>'
JOINT = '<joint name="${name}_joint" type="fixed"><parent link="${parent}"/><child link="${name}"/></joint>'


def test_a_macro_whose_joint_is_in_a_macro_of_it_has_the_joint_and_uses_that_as_a_module(tmp_path: Path):
    made = migrated(
        tmp_path,
        f"""
        <xacro:macro name="part" params="name parent">{LINK}{JOINT}</xacro:macro>
        <xacro:macro name="arm" params="name parent">
          <xacro:part name="${{name}}_upper" parent="${{parent}}"/>
          <xacro:part name="${{name}}_lower" parent="${{name}}_upper"/>
        </xacro:macro>
        <link name="base"/>
        <xacro:arm name="left" parent="base"/>
        <xacro:part name="head" parent="base"/>
        """,
    )
    assert sorted(made.files) == ["arm.robot.yaml", "part.robot.yaml", "robot.robot.yaml"]
    assert (
        "mount:\n  $(base_name)_upper_joint: {type: fixed, child: $(base_name)_upper}" in made.files["arm.robot.yaml"]
    )
    assert "use: part.robot.yaml" in made.files["arm.robot.yaml"]


def test_a_module_uses_the_modules_of_its_macros(tmp_path: Path):
    made = migrated(
        tmp_path,
        f"""
        <xacro:macro name="finger" params="name parent">{LINK}{JOINT}</xacro:macro>
        <xacro:macro name="hand" params="name parent">
          {LINK}{JOINT}
          <xacro:finger name="${{name}}_thumb" parent="${{name}}"/>
          <xacro:finger name="${{name}}_index" parent="${{name}}"/>
        </xacro:macro>
        <link name="base"/>
        <xacro:hand name="left" parent="base"/>
        """,
    )
    hand = made.files["hand.robot.yaml"]
    assert "use: finger.robot.yaml" in hand
    assert "parent: $(base_name)" in hand


def test_a_macro_that_only_a_module_with_other_values_calls_is_a_module(tmp_path: Path):
    text = """
<xacro:macro name="plug" params="parent">
  <link name="plug"/>
  <joint name="plug_joint" type="fixed"><parent link="${parent}"/><child link="plug"/></joint>
</xacro:macro>
<xacro:macro name="camera" params="with_plug:=false">
  <link name="camera"/>
  <xacro:if value="${with_plug}"><xacro:plug parent="camera"/></xacro:if>
</xacro:macro>
<xacro:camera/>
"""
    made = migrated(tmp_path, text)
    assert "plug: {when: $(with_plug), use: plug.robot.yaml, parent: camera" in made.files["camera.robot.yaml"]


def test_settings_of_a_joint_go_with_it_to_the_file_that_has_it(tmp_path: Path):
    text = """
<link name="base"/>
<xacro:macro name="drop" params="name parent *origin">
  <joint name="${name}_joint" type="continuous">
    <parent link="${parent}"/><child link="${name}"/><xacro:insert_block name="origin"/><axis xyz="0 1 0"/>
  </joint>
  <gazebo reference="${name}_joint"><springStiffness>400</springStiffness></gazebo>
  <link name="${name}"/>
</xacro:macro>
<xacro:macro name="wheel" params="name parent *origin">
  <xacro:drop name="${name}_drop" parent="${parent}"><xacro:insert_block name="origin"/></xacro:drop>
  <link name="${name}"/>
  <joint name="${name}_joint" type="fixed"><parent link="${name}_drop"/><child link="${name}"/></joint>
</xacro:macro>
<xacro:wheel name="left" parent="base"><origin xyz="0 0.1 0"/></xacro:wheel>
"""
    made = migrated(tmp_path, text)
    assert "drop.robot.yaml" in made.files
    assert "springStiffness" in made.files["wheel.robot.yaml"]


def test_a_link_that_hangs_on_one_of_two_others_by_an_argument_is_a_part_of_the_tree(tmp_path: Path):
    text = """
<xacro:arg name="sim" default="false"/>
<xacro:macro name="arm" params="sim side:=''">
  <xacro:property name="prefix" value="${'' if side == '' else side + '_'}"/>
  <xacro:property name="parent" value="${'' if sim else 'base'}"/>
  <link name="${prefix}arm"/>
  <xacro:unless value="${parent == ''}">
    <link name="${parent}"/>
    <joint name="base_joint" type="fixed"><parent link="${parent}"/><child link="${prefix}arm"/></joint>
  </xacro:unless>
  <xacro:if value="${sim}">
    <link name="world"/>
    <joint name="world_joint" type="fixed"><parent link="world"/><child link="arm"/></joint>
  </xacro:if>
</xacro:macro>
<xacro:arm sim="$(arg sim)"/>
"""
    made = migrated(tmp_path, text)
    assert "arm.robot.yaml" in made.files
    assert "when: $(sim)" in made.files["arm.robot.yaml"]


def test_a_parameter_of_the_macro_around_is_one_of_the_module_too(tmp_path: Path):
    text = """
<xacro:property name="package" value="shop"/>
<xacro:macro name="part" params="name">
  <link name="${arm_id}_${name}"><visual><geometry><mesh filename="package://${package}/${arm_id}.stl"/></geometry></visual></link>
</xacro:macro>
<xacro:macro name="arm" params="arm_id">
  <xacro:part name="upper"/>
  <joint name="joint" type="fixed"><parent link="${arm_id}_upper"/><child link="${arm_id}_lower"/></joint>
  <xacro:part name="lower"/>
</xacro:macro>
<xacro:arm arm_id="fer"/>
"""
    made = migrated(tmp_path, text)
    part = made.files["part.robot.yaml"]
    assert "  base_name: {type: string}\n  arm_id: {type: string}\n\nvariables:\n  package: shop\n" in part
    assert "fer" not in part
    assert "with: {base_name: $(part.base_name), arm_id: $(arm_id)}" in made.files["arm.robot.yaml"]
