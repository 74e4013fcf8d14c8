"""What several specs declare alike is in one file."""

from pathlib import Path

from tests.migration.migrated import migrated

WHEEL = """
<xacro:macro name="wheel" params="name parent">
  <link name="${name}">
    <visual>
      <geometry><cylinder radius="${wheel_radius}" length="${wheel_width}"/></geometry>
      <material name="rubber"/>
    </visual>
  </link>
  <joint name="${name}_joint" type="fixed"><parent link="${parent}"/><child link="${name}"/></joint>
</xacro:macro>
"""


def test_a_property_that_the_robot_and_a_module_use_is_written_once(tmp_path: Path):
    common = f"""
<!-- Measured with a load of 20 kg. -->
<xacro:property name="wheel_radius" value="${{0.2 / 2}}"/>
<xacro:property name="wheel_width" value="0.05"/>
<material name="rubber"><color rgba="0 0 0 1"/></material>
{WHEEL}
"""
    text = """
<xacro:include filename="common.xacro"/>
<link name="footprint"/>
<link name="base"><visual><geometry><box size="1 1 1"/></geometry><material name="rubber"/></visual></link>
<joint name="base_joint" type="fixed">
  <parent link="footprint"/><child link="base"/><origin xyz="0 0 ${wheel_radius}"/>
</joint>
<xacro:wheel name="left" parent="base"/>
"""
    made = migrated(tmp_path, text, common=common)
    assert (
        made.files["robot_shared.yaml"]
        == """\
linkforge: 1

variables:
  # Measured with a load of 20 kg.
  wheel_radius: $(0.2 / 2)

materials:
  rubber: {color: [0, 0, 0]}
"""
    )
    assert "name: robot\ninclude: [robot_shared.yaml]\n\nlinks:" in made.robot
    assert "include: [robot_shared.yaml]" in made.files["wheel.robot.yaml"]
    assert "variables:\n  wheel_width: 0.05\n" in made.files["wheel.robot.yaml"]


def test_properties_of_two_macros_with_one_name_and_value_stay_apart(tmp_path: Path):
    macro = """
<xacro:macro name="{0}" params="name">
  <xacro:property name="rate" value="62"/>
  <link name="${{name}}"/>
  <gazebo reference="${{name}}"><rate>${{rate}}</rate></gazebo>
</xacro:macro>
<xacro:{0} name="{0}_link"/>
"""
    joint = '<joint name="j" type="fixed"><parent link="cliff_link"/><child link="bump_link"/></joint>'
    made = migrated(tmp_path, macro.format("cliff") + macro.format("bump") + joint)
    assert [*made.files] == ["robot.robot.yaml", "bump.robot.yaml", "cliff.robot.yaml"]


def test_a_name_that_means_something_else_in_one_of_the_specs_is_not_shared(tmp_path: Path):
    text = f"""
<xacro:property name="wheel_radius" value="0.1"/>
<xacro:property name="wheel_width" value="0.05"/>
<material name="rubber"><color rgba="0 0 0 1"/></material>
{WHEEL}
<xacro:macro name="caster" params="wheel_radius">
  <link name="caster">
    <visual><geometry><cylinder radius="${{wheel_radius}}" length="${{wheel_width}}"/></geometry></visual>
  </link>
  <joint name="caster_joint" type="fixed"><parent link="base"/><child link="caster"/></joint>
</xacro:macro>
<link name="base"><visual><geometry><sphere radius="${{wheel_radius}}"/></geometry></visual></link>
<xacro:wheel name="left" parent="base"/>
<xacro:caster wheel_radius="0.02"/>
"""
    made = migrated(tmp_path, text)
    assert made.files["robot_shared.yaml"].startswith("linkforge: 1\n\nvariables:\n  wheel_width: 0.05\n\nmaterials:")


def test_a_material_that_only_modules_have_is_none_of_a_robot_without_them(tmp_path: Path):
    text = """
<xacro:arg name="cameras" default="false"/>
<xacro:property name="size" value="0.1"/>
<xacro:macro name="eye" params="name">
  <link name="${name}"><visual>
    <geometry><sphere radius="${size}"/></geometry><material name="gray"><color rgba="0.5 0.5 0.5 1"/></material>
  </visual></link>
  <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro>
<xacro:macro name="ear" params="name">
  <link name="${name}"><visual>
    <geometry><box size="1 1 1"/></geometry><material name="gray"><color rgba="0.5 0.5 0.5 1"/></material>
  </visual></link>
  <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro>
<link name="base"><visual><geometry><sphere radius="${size}"/></geometry></visual></link>
<xacro:if value="$(arg cameras)"><xacro:eye name="left"/><xacro:ear name="right"/></xacro:if>"""
    made = migrated(tmp_path, text)
    assert "materials" not in made.files["robot_shared.yaml"]
