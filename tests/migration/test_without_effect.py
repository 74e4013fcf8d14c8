"""What no URDF reader acts on is omitted with a note; nothing else is."""

from pathlib import Path

import pytest

from tests.migration.migrated import migrated

LINKS = '<link name="base"/><link name="tool"/>'


def test_the_axis_and_limit_of_a_fixed_joint_are_left_out(tmp_path: Path):
    text = f"""{LINKS}
<joint name="wrist" type="fixed">
  <parent link="base"/><child link="tool"/>
  <axis xyz="0 1 0"/>
  <limit lower="-1" upper="1" effort="5" velocity="2"/>
</joint>"""
    made = migrated(tmp_path, text)
    assert "wrist: {type: fixed, parent: base, child: tool}" in made.robot
    notes = [one for one in made.proved.diagnostics if one.code.id == "LF8048"]
    assert [(one.span.line, one.message.split()[0]) for one in notes if one.span] == [(5, "<axis>"), (6, "<limit>")]


def test_the_axis_of_a_joint_that_is_fixed_for_some_arguments_only_stays_for_the_others(tmp_path: Path):
    text = f"""{LINKS}
<xacro:arg name="free" default="false"/>
<xacro:property name="kind" value="${{'continuous' if '$(arg free)' == 'true' else 'fixed'}}"/>
<joint name="wrist" type="${{kind}}">
  <parent link="base"/><child link="tool"/>
  <axis xyz="0 1 0"/>
</joint>"""
    made = migrated(tmp_path, text)
    assert len(made.proved.comparisons) == 2
    assert "axis: $('y' if" in made.robot
    assert "extra" not in made.robot


def test_an_element_that_is_not_known_stays_as_raw_xml(tmp_path: Path):
    text = f"""{LINKS}
<joint name="wrist" type="fixed">
  <parent link="base"/><child link="tool"/>
  <axis xyz="0 1 0"/>
  <brake torque="3"/>
</joint>"""
    made = migrated(tmp_path, text)
    assert '<brake torque="3"/>' in made.robot
    assert "<axis" not in made.robot


def test_the_axis_of_the_joint_that_attaches_a_module_is_left_out(tmp_path: Path):
    text = """<link name="base"/>
<xacro:macro name="arm" params="prefix parent">
  <joint name="${prefix}joint" type="fixed">
    <parent link="${parent}"/><child link="${prefix}arm"/><axis xyz="0 0 1"/>
  </joint>
  <link name="${prefix}arm"/>
</xacro:macro>
<xacro:arm prefix="left_" parent="base"/>
<xacro:arm prefix="right_" parent="base"/>"""
    made = migrated(tmp_path, text)
    assert "extra" not in made.files["arm.robot.yaml"]
    assert [one.code.id for one in made.proved.diagnostics].count("LF8048") == 1


def test_the_material_of_a_collision_and_a_gazebo_block_in_a_link_are_left_out(tmp_path: Path):
    paint = '<material name="red"><color rgba="1 0 0 1"/></material>'
    shape = '<geometry><sphere radius="1"/></geometry>'
    made = migrated(
        tmp_path,
        f"""<link name="base">
  <visual>{shape}{paint}</visual>
  <collision>{shape}{paint}</collision>
  <gazebo reference="base"><material>Gazebo/Red</material></gazebo>
</link>""",
    )
    assert "base: {visual: {sphere: 1, material: red}, collision: visual}" in made.robot
    messages = [one.message for one in made.proved.diagnostics if one.code.id == "LF8048"]
    assert messages == [
        "<material> is omitted: URDF readers ignore it in a collision",
        "<gazebo> is omitted: URDF readers ignore it in a link",
    ]


def test_a_color_that_a_visual_takes_from_a_collision_is_a_difference(tmp_path: Path):
    shape = '<geometry><sphere radius="1"/></geometry>'
    paint = '<material name="red"><color rgba="1 0 0 1"/></material>'
    text = f"""<link name="base">
  <visual>{shape}<material name="red"/></visual>
  <collision>{shape}{paint}</collision>
</link>"""
    with pytest.raises(AssertionError, match="the specs give a different robot: links/base/collision"):
        migrated(tmp_path, text)


def test_elements_of_a_plugin_that_get_another_order_are_noted_at_the_plugin(tmp_path: Path):
    text = """<link name="base"/>
<gazebo><plugin name="p" filename="p.so"><a>1</a><b/><a>2</a></plugin></gazebo>
<gazebo><plugin name="q" filename="q.so"><a>1</a><a>2</a><b/></plugin></gazebo>"""
    [note] = [one for one in migrated(tmp_path, text).proved.diagnostics if one.code.id == "LF8026"]
    assert note.span is not None
    assert note.span.line == 3


def test_text_that_no_reader_uses_is_omitted_with_a_warning_at_its_element(tmp_path: Path):
    text = """<link name="base"/>
<xacro:macro name="wheel" params="name">
  <link name="${name}"><visual><geometry><sphere radius="1"/>--></geometry></visual></link>
  <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro>
<xacro:wheel name="left"/>
<xacro:wheel name="right"/>"""
    made = migrated(tmp_path, text)
    assert "visual: {sphere: 1}" in made.files["wheel.robot.yaml"]
    [warning] = [one for one in made.proved.diagnostics if one.code.id == "LF8101"]
    assert warning.message == "text is not allowed in <geometry>; '-->' is omitted"
    assert warning.span is not None
    assert warning.span.line == 4
