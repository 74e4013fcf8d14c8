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
