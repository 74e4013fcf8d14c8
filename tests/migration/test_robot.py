"""A xacro without macros: arguments, properties and conditions."""

from pathlib import Path

from tests.migration.migrated import migrated

LINK = '<link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>'


def test_properties_become_variables_and_arguments_parameters(tmp_path: Path):
    spec = migrated(
        tmp_path,
        """
        <xacro:arg name="reach" default="0.5"/>
        <!-- of the whole arm -->
        <xacro:property name="width" value="0.1"/>
        <xacro:property name="half" value="${width / 2}"/> <!-- in metres -->
        <link name="base">
          <visual>
            <origin xyz="0 0 ${half}" rpy="0 ${pi/2} -${width}"/>
            <geometry><box size="$(arg reach) ${width} ${2 * width}"/></geometry>
          </visual>
        </link>
        """,
    ).robot
    assert spec.endswith("""\
parameters:
  reach: {type: length, default: 0.5}

variables:
  # of the whole arm
  width: 0.1
  # in metres
  half: $(width / 2)

links:
  base:
    visual:
      box: [$(reach), $(width), $(2 * width)]
      origin: {xyz: [0, 0, $(half)], rpy: [0, 90 deg, $(-width)]}
""")


def test_a_condition_becomes_when_and_all_its_outcomes_are_proved(tmp_path: Path):
    made = migrated(
        tmp_path,
        f"""
        <xacro:arg name="camera" default="false"/>
        <xacro:arg name="model" default="small"/>
        {LINK}
        <xacro:if value="$(arg camera)">
          <link name="camera"/>
          <joint name="camera_joint" type="fixed"><parent link="base"/><child link="camera"/></joint>
        </xacro:if>
        <xacro:unless value="${{'$(arg model)' == 'small'}}">
          <link name="tower"><collision><geometry><sphere radius="1"/></geometry></collision></link>
          <joint name="tower_joint" type="fixed"><parent link="base"/><child link="tower"/></joint>
        </xacro:unless>
        """,
    )
    assert "camera: {when: $(camera)}" in made.robot
    assert "when: $(model != 'small')" in made.robot
    assert len(made.proved.comparisons) == 2  # `model` is compared with its default


def test_alternatives_inside_of_an_element_are_merged(tmp_path: Path):
    spec = migrated(
        tmp_path,
        """
        <xacro:arg name="mesh" default="false"/>
        <xacro:arg name="mass" default="2"/>
        <link name="base">
          <visual>
            <geometry>
              <xacro:if value="$(arg mesh)"><mesh filename="package://p/base.stl"/></xacro:if>
              <xacro:unless value="$(arg mesh)"><sphere radius="1"/></xacro:unless>
            </geometry>
          </visual>
          <inertial>
            <mass value="${$(arg mass) * 2}"/>
            <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
          </inertial>
        </link>
        """,
    ).robot
    assert "visual: [{when: $(mesh), mesh: package://p/base.stl}, {when: $(not mesh), sphere: 1}]" in spec
    assert "mass: $(mass * 2)" in spec
