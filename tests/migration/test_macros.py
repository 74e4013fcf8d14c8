"""Macros: modules, calls that are alike, content in place, and inertia."""

from pathlib import Path

from tests.migration.migrated import migrated

WHEEL = """
<xacro:macro name="wheel" params="name parent reflect radius:=0.05 *origin">
  <!-- of aluminium -->
  <xacro:property name="width" value="0.02"/>
  <link name="${name}_wheel">
    <visual>
      <origin rpy="${pi/2} 0 0"/>
      <geometry><cylinder radius="${radius}" length="${width}"/></geometry>
      <material name="black"/>
    </visual>
    <inertial>
      <mass value="0.1"/>
      <origin xyz="0 ${reflect * width} 0"/>
      <inertia ixx="1e-4" iyy="1e-4" izz="2e-4" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <joint name="${name}_joint" type="continuous">
    <parent link="${parent}"/>
    <child link="${name}_wheel"/>
    <xacro:insert_block name="origin"/>
    <axis xyz="0 1 0"/>
  </joint>
  <gazebo reference="${name}_joint"><preserveFixedJoint>true</preserveFixedJoint></gazebo>
</xacro:macro>
"""
BASE = """
<material name="black"><color rgba="0 0 0 1"/></material>
<link name="base"><collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>
"""
WHEELS = f"""
{BASE}
<xacro:property name="track" value="0.3"/>
<xacro:wheel name="left" parent="base" reflect="1"><origin xyz="0 ${{track/2}} 0"/></xacro:wheel>
<xacro:wheel name="right" parent="base" reflect="-1"><origin xyz="0 ${{-track/2}} 0"/></xacro:wheel>
"""


def test_a_macro_becomes_a_module_with_the_joint_that_attaches_it_as_its_mount(tmp_path: Path):
    made = migrated(tmp_path, WHEEL + WHEELS)
    assert (
        made.files["wheel.robot.yaml"]
        == """\
linkforge: 1
name: wheel
include: [robot_shared.yaml]

parameters:
  # in the xacro: name
  base_name: {type: string}
  reflect: {type: number}
  radius: {type: length, default: 0.05}

variables:
  # of aluminium
  width: 0.02

mount:
  $(base_name)_joint:
    type: continuous
    child: $(base_name)_wheel
    axis: y
    gazebo: {preserveFixedJoint: true}

links:
  $(base_name)_wheel:
    visual:
      cylinder: {radius: $(radius), length: $(width)}
      origin: {rpy: [90 deg, 0, 0]}
      material: black
    inertial:
      mass: 0.1
      origin: [0, $(reflect * width), 0]
      inertia: {ixx: 1e-4, iyy: 1e-4, izz: 2e-4}
"""
    )


def test_calls_that_are_alike_become_one_entry_with_for(tmp_path: Path):
    spec = migrated(tmp_path, WHEEL + WHEELS).robot
    assert spec.endswith("""\
modules:
  $(wheel.base_name):
    for: {wheel: $(wheels)}
    use: wheel.robot.yaml
    parent: base
    origin: $(wheel.origin)
    prefix: ""
    with: {base_name: $(wheel.base_name), reflect: $(wheel.reflect)}
""")
    assert "- {base_name: left, reflect: 1, origin: [0, $(track / 2), 0]}" in spec


def test_a_macro_sees_the_constants_around_it_and_gets_what_depends_on_arguments(tmp_path: Path):
    made = migrated(
        tmp_path,
        """
        <xacro:arg name="scale" default="2"/>
        <xacro:property name="unit" value="0.01"/>
        <xacro:property name="size" value="${unit * $(arg scale)}"/>
        <xacro:macro name="box" params="name">
          <link name="${name}"><visual><geometry><box size="${unit} ${size} ${size}"/></geometry></visual></link>
          <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
        </xacro:macro>
        <link name="base"/>
        <xacro:box name="one"/>
        """,
    )
    module = made.files["box.robot.yaml"]
    assert "name: box\ninclude: [robot_shared.yaml]\n" in module
    assert made.files["robot_shared.yaml"] == "linkforge: 1\n\nvariables:\n  unit: 0.01\n"
    assert "  size: {type: length}\n" in module
    assert "with: {base_name: one, size: $(size)}" in made.robot


def test_an_inertia_that_is_that_of_the_shape_is_left_out(tmp_path: Path):
    spec = migrated(
        tmp_path,
        """
        <xacro:macro name="box_inertia" params="m x y z">
          <inertial>
            <mass value="${m}"/>
            <inertia ixx="${m / 12 * (y * y + z * z)}" ixy="0" ixz="0"
                     iyy="${m / 12 * (x * x + z * z)}" iyz="0" izz="${m / 12 * (x * x + y * y)}"/>
          </inertial>
        </xacro:macro>
        <link name="base">
          <collision><geometry><box size="1 1 1"/></geometry></collision>
          <xacro:box_inertia m="12" x="1" y="1" z="1"/>
        </link>
        <link name="other">
          <collision><geometry><box size="1 1 1"/></geometry></collision>
          <xacro:box_inertia m="12" x="1" y="1" z="2"/>
        </link>
        <joint name="j" type="fixed"><parent link="base"/><child link="other"/></joint>
        """,
    ).robot
    assert "inertial: {mass: 12}}\n" in spec
    assert "inertia: {ixx: 5.0, iyy: 5.0, izz: 2.0}" in spec


def test_a_macro_of_ros2_control_is_written_where_it_is_called(tmp_path: Path):
    made = migrated(
        tmp_path,
        """
        <xacro:arg name="mock" default="true"/>
        <xacro:macro name="control" params="name mock">
          <ros2_control name="${name}" type="system">
            <hardware>
              <xacro:if value="${mock}"><plugin>mock_components/GenericSystem</plugin></xacro:if>
              <xacro:unless value="${mock}">
                <plugin>acme/Driver</plugin>
                <param name="port">${1000 + 1}</param>
                <param name="verbose">${mock}</param>
              </xacro:unless>
            </hardware>
            <joint name="j"><command_interface name="position"/><state_interface name="position"/></joint>
          </ros2_control>
        </xacro:macro>
        <link name="base"/>
        <link name="arm"/>
        <joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint>
        <xacro:control name="arm" mock="$(arg mock)"/>
        """,
    )
    assert "hardware_plugin: $('mock_components/GenericSystem' if mock else 'acme/Driver')" in made.robot
    assert "port: {when: $(not mock), value: 1001}" in made.robot


def test_the_type_of_a_joint_may_depend_on_a_condition(tmp_path: Path):
    spec = migrated(
        tmp_path,
        """
        <xacro:arg name="endless" default="false"/>
        <xacro:property name="kind" value="${'continuous' if $(arg endless) else 'revolute'}"/>
        <link name="base"/>
        <link name="arm"/>
        """.replace("$(arg endless) else", "xacro.arg('endless') == 'true' else")
        + """
        <joint name="j" type="${kind}">
          <parent link="base"/><child link="arm"/>
          <xacro:if value="${kind == 'revolute'}"><limit lower="-1" upper="1" effort="1" velocity="1"/></xacro:if>
        </joint>
        """,
    ).robot
    assert "type: $('continuous' if endless else 'revolute')" in spec


def test_a_macro_that_calls_itself_is_written_out(tmp_path: Path):
    spec = migrated(
        tmp_path,
        """
        <xacro:macro name="chain" params="i n">
          <link name="link_${i}"/>
          <xacro:if value="${i > 0}">
            <joint name="joint_${i}" type="fixed"><parent link="link_${i - 1}"/><child link="link_${i}"/></joint>
          </xacro:if>
          <xacro:if value="${i &lt; n}"><xacro:chain i="${i + 1}" n="${n}"/></xacro:if>
        </xacro:macro>
        <xacro:chain i="0" n="3"/>
        """,
    ).robot
    assert "  joint_3: {type: fixed, parent: link_2, child: link_3}" in spec


def test_a_name_that_a_prefix_would_change_fixes_only_the_prefix(tmp_path: Path):
    text = """
<xacro:macro name="rover" params="joint_prefix:='' antenna:=true height:=0.1">
  <link name="body"/>
  <link name="left"/>
  <link name="right"/>
  <joint name="${joint_prefix}left_joint" type="continuous">
    <parent link="body"/><child link="left"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="${joint_prefix}right_joint" type="continuous">
    <parent link="body"/><child link="right"/><axis xyz="0 1 0"/><mimic joint="left_joint"/>
  </joint>
  <xacro:if value="${antenna}">
    <link name="antenna"/>
    <joint name="antenna_joint" type="fixed">
      <parent link="body"/><child link="antenna"/><origin xyz="0 0 ${height}"/>
    </joint>
  </xacro:if>
</xacro:macro>
<xacro:rover/>
"""
    module = migrated(tmp_path, text).files["rover.robot.yaml"]
    assert "parameters:\n  antenna: true\n  height: {type: length, default: 0.1}\n" in module
    assert "mimic: {joint: left_joint}" in module


def test_entries_are_named_by_all_words_of_a_call_where_one_is_not_enough(tmp_path: Path):
    text = """
<link name="base"/>
<xacro:macro name="wheel" params="prefix suffix reflect x">
  <link name="${prefix}_${suffix}"/>
  <joint name="${prefix}_${suffix}_joint" type="fixed">
    <parent link="base"/><child link="${prefix}_${suffix}"/><origin xyz="${x} ${reflect * width / 2} 0"/>
  </joint>
</xacro:macro>
<xacro:property name="width" value="0.4"/>
<xacro:wheel prefix="front" suffix="left" reflect="1" x="0.2"/>
<xacro:wheel prefix="front" suffix="right" reflect="-1" x="0.2"/>
<xacro:wheel prefix="rear" suffix="left" reflect="1" x="-0.2"/>
"""
    made = migrated(tmp_path, text)
    assert "{entry: front_left, name_prefix: front, suffix: left, origin: [0.2, $(width / 2), 0]}" in made.robot
    assert "{entry: front_right, name_prefix: front, suffix: right, origin: [0.2, $(-width / 2), 0]}" in made.robot


def test_numbers_that_a_plugin_reads_are_spelled_as_python_does_for_every_outcome(tmp_path: Path):
    text = """<link name="base"/>
<xacro:arg name="model" default="short"/>
<xacro:property name="reach" value="10.0"/>
<xacro:if value="${'$(arg model)' == 'long'}"><xacro:property name="reach" value="14.5"/></xacro:if>
<gazebo><plugin name="lidar" filename="lidar.so"><reach>${reach}</reach></plugin></gazebo>"""
    assert "parameters: {reach: $(14.5 if model == 'long' else '10.0')}" in migrated(tmp_path, text).robot
