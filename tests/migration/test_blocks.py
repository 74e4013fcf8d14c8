"""Blocks of calls as parameters of modules."""

from pathlib import Path

import pytest

from tests.migration.migrated import migrated

POST = """
<xacro:arg name="solid" default="true"/>
<link name="base"/>
<xacro:macro name="post" params="name *shape **more *place *origin">
  <link name="${name}">
    <visual><geometry><xacro:insert_block name="shape"/></geometry></visual>
    <xacro:if value="$(arg solid)"><xacro:insert_block name="more"/></xacro:if>
  </link>
  <joint name="${name}_joint" type="fixed">
    <parent link="base"/><child link="${name}"/><xacro:insert_block name="origin"/>
  </joint>
  <link name="${name}_tip"/>
  <joint name="${name}_tip_joint" type="fixed">
    <parent link="${name}"/><child link="${name}_tip"/><xacro:insert_block name="place"/>
  </joint>
</xacro:macro>
<xacro:post name="pole">
  <cylinder radius="0.02" length="1"/>
  <more>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><geometry><sphere radius="0.2"/></geometry></collision>
  </more>
  <origin xyz="0 0 2" rpy="0 0 ${pi/2}"/>
  <origin xyz="0 0 1"/>
</xacro:post>
<xacro:post name="pile"><box size="1 1 1"/><more/><origin/><origin xyz="1 0 1"/></xacro:post>
"""


def test_blocks_of_a_link_and_of_another_joint_are_parameters(tmp_path: Path):
    made = migrated(tmp_path, POST)
    module = made.files["post.robot.yaml"]
    assert "  shape: {type: map}\n  more: []\n  place: {type: map}\n" in module
    assert "$(base_name): {visual: $(shape), collision: $(more if solid else null)}" in module
    assert "origin: $(place)" in module
    assert (
        """\
      shape: {cylinder: {radius: 0.02, length: 1}}
      more: [{sphere: 0.1}, {sphere: 0.2}]
      place: {xyz: [0, 0, 2], rpy: [0, 0, 90 deg]}
"""
        in made.robot
    )
    assert "place: {xyz: [0, 0, 0]}" in made.robot


def test_a_block_that_a_module_hands_on_is_its_parameter_too(tmp_path: Path):
    text = """
<link name="base"/>
<xacro:macro name="ball" params="name **shapes">
  <link name="${name}"><xacro:insert_block name="shapes"/></link>
</xacro:macro>
<xacro:macro name="pair" params="name **shapes">
  <xacro:ball name="${name}_a"><shapes><xacro:insert_block name="shapes"/></shapes></xacro:ball>
  <joint name="${name}_joint" type="fixed"><parent link="${name}_a"/><child link="${name}_b"/></joint>
  <link name="${name}_b"/>
</xacro:macro>
<xacro:pair name="p"><shapes><collision><geometry><sphere radius="0.1"/></geometry></collision></shapes></xacro:pair>
<joint name="joint" type="fixed"><parent link="base"/><child link="p_a"/></joint>
"""
    made = migrated(tmp_path, text)
    assert "with: {base_name: $(base_name)_a, shapes: $(shapes)}" in made.files["pair.robot.yaml"]
    assert "shapes: [{sphere: 0.1}]" in made.robot


BALL = '<geometry><sphere radius="1"/></geometry>'


@pytest.mark.parametrize(
    "block",
    [
        f"<visual>{BALL}</visual><collision>{BALL}</collision>",
        f'<visual>{BALL}<material name="red"/></visual>',
    ],
    ids=["two kinds", "a material of the robot"],
)
def test_a_block_that_no_parameter_holds_is_written_in_place(tmp_path: Path, block: str):
    text = f"""
<material name="red"><color rgba="1 0 0 1"/></material>
<xacro:macro name="ball" params="name **more">
  <link name="${{name}}"><xacro:insert_block name="more"/></link>
</xacro:macro>
<xacro:ball name="a"><more>{block}</more></xacro:ball>
"""
    made = migrated(tmp_path, text)
    assert [*made.files] == ["robot.robot.yaml"]
    assert any("it inserts a block of its call" in one.message for one in made.proved.diagnostics)
