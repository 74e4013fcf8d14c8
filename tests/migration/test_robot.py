"""A xacro without macros: arguments, properties and conditions."""

from pathlib import Path

import pytest

from linkforge_compile import compile_text
from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.prove import Migrator
from tests.migration.migrated import migrated, write

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
    assert len(made.proved.comparisons) == 4  # `model` is compared with its default, so another value is tried


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


def test_a_second_ros2_control_of_the_same_name_is_not_lost(tmp_path: Path):
    control = """
<ros2_control name="system" type="system">
  <hardware><plugin>p/P</plugin><param name="side">SIDE</param></hardware>
  <joint name="SIDE"><command_interface name="position"/></joint>
</ros2_control>
"""
    arms = """
<link name="base"/>
<link name="left_arm"/>
<link name="right_arm"/>
<joint name="left" type="continuous"><parent link="base"/><child link="left_arm"/></joint>
<joint name="right" type="continuous"><parent link="base"/><child link="right_arm"/></joint>
"""
    made = migrated(tmp_path, arms + control.replace("SIDE", "left") + control.replace("SIDE", "right"))
    assert "side: left" in made.robot
    assert '<param name="side">right</param>' in made.robot


def test_a_robot_that_stays_a_xacro_has_the_name_of_the_xacro(tmp_path: Path):
    main = tmp_path / "robot.xacro"
    main.write_text(
        """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="$(arg name)_arm">
<xacro:arg name="name" default="left"/>
<link name="base"/>
<xacro:element xacro:name="link" name="tip"/>
<joint name="tip_joint" type="fixed"><parent link="base"/><child link="tip"/></joint>
</robot>
""",
        "utf-8",
    )
    proved = Migrator(main, {"name": "left"}, tmp_path / "specs", Settings((), {}).loader(main), Diagnostics()).run()
    assert proved.is_equal, [one.message for one in proved.diagnostics]
    assert "\nname: $(base_name)_arm\n" in proved.files["robot.robot.yaml"]


def test_the_command_that_makes_the_specs_names_the_packages_that_they_need(tmp_path: Path):
    for name in ("arm_description", "other_description"):
        (tmp_path / name / "urdf").mkdir(parents=True)
    (tmp_path / "arm_description" / "urdf" / "part.xacro").write_text("<robot><link name='base'/></robot>", "utf-8")
    main = write(tmp_path, robot='<xacro:include filename="$(find arm_description)/urdf/part.xacro"/>')
    packages = {name: tmp_path / name for name in ("arm_description", "other_description")}
    proved = Migrator(main, {}, tmp_path / "specs", Settings((), packages).loader(main), Diagnostics()).run()
    text = proved.files["robot.robot.yaml"]
    assert text.startswith("# linkforge migrate ../robot.xacro --package arm_description=../arm_description -o .\n")


def test_a_property_that_conditions_in_conditions_define_has_the_value_of_all_of_them(tmp_path: Path):
    choice = """
<xacro:{outer} value="$(arg gpu)">
  <xacro:if value="${{'$(arg engine)' == 'classic'}}"><xacro:property name="ray" value="{classic}"/></xacro:if>
  <xacro:if value="${{'$(arg engine)' == 'harmonic'}}"><xacro:property name="ray" value="{harmonic}"/></xacro:if>
</xacro:{outer}>
"""
    text = f"""
<xacro:arg name="gpu" default="true"/>
<xacro:arg name="engine" default="classic"/>
{choice.format(outer="if", classic="gpu_ray", harmonic="gpu_lidar")}
{choice.format(outer="unless", classic="ray", harmonic="lidar")}
{LINK}
<gazebo reference="base"><sensor name="s" type="${{ray}}"/></gazebo>
"""
    assert sum(one.is_equal for one in migrated(tmp_path, text).proved.comparisons) == 4


def test_alternatives_of_names_in_settings_take_the_prefix_of_a_module(tmp_path: Path):
    text = f"""
<xacro:arg name="engine" default="classic"/>
{LINK}
<xacro:if value="${{'$(arg engine)' == 'classic'}}">
  <gazebo reference="base"><sensor name="ray_of_classic" type="ray"/></gazebo>
</xacro:if>
<xacro:if value="${{'$(arg engine)' == 'harmonic'}}">
  <gazebo reference="base"><sensor name="ray_of_harmonic" type="ray"/></gazebo>
</xacro:if>
"""
    robot = migrated(tmp_path, text).robot
    assert "$(prefix + 'ray_of_classic' if engine == 'classic' else prefix + 'ray_of_harmonic')" in robot


def test_a_rotation_that_only_one_alternative_has_is_zero_in_the_other(tmp_path: Path):
    text = """
<xacro:arg name="tilted" default="true"/>
<link name="base">
  <visual>
    <xacro:if value="$(arg tilted)"><origin xyz="0 0 1" rpy="0.5 0 0"/></xacro:if>
    <xacro:unless value="$(arg tilted)"><origin xyz="0 0 2"/></xacro:unless>
    <geometry><sphere radius="1"/></geometry>
  </visual>
</link>
"""
    robot = migrated(tmp_path, text).robot
    assert "origin: {xyz: [0, 0, $(1 if tilted else 2)], rpy: [$(0.5 if tilted else 0), 0, 0]}" in robot


def test_a_property_that_is_an_argument_is_the_parameter_and_its_values_are_proved(tmp_path: Path):
    made = migrated(
        tmp_path,
        """
        <xacro:arg name="model" default="large"/>
        <xacro:property name="model" value="$(arg model)"/>
        <link name="base">
          <collision><geometry><sphere radius="${2.0 if model == 'large' else 1.0}"/></geometry></collision>
        </link>
        """,
    )
    assert "model_2" not in made.robot
    assert [one.arguments for one in made.proved.comparisons] == [{}, {"model": "none_of_these"}]


def test_a_property_that_a_condition_sets_is_forwarded_to_a_macro_under_the_condition(tmp_path: Path):
    made = migrated(
        tmp_path,
        """
        <xacro:arg name="model" default="large"/>
        <xacro:macro name="ball" params="name radius:=^|0.1">
          <link name="${name}"><collision><geometry><sphere radius="${radius}"/></geometry></collision></link>
        </xacro:macro>
        <xacro:if value="${'$(arg model)' == 'large'}"><xacro:property name="radius" value="0.2"/></xacro:if>
        <xacro:ball name="base"/>
        """,
    )
    assert "radius: $(0.2 if model == 'large' else 0.1)" in made.robot


def test_the_text_of_a_default_is_that_of_the_xacro(tmp_path: Path):
    made = migrated(
        tmp_path,
        f"""
        <xacro:arg name="serial" default="00123"/>
        <xacro:arg name="version" default="1.10"/>
        <xacro:arg name="debug" default="True"/>
        {LINK}
        <gazebo><plugin name="p" filename="f">
          <serial>$(arg serial)</serial><label>v$(arg version)</label><debug>$(arg debug)</debug>
        </plugin></gazebo>
        """,
    )
    assert 'serial: 00123\n  version: "1.10"\n' in made.robot
    assert made.proved.comparisons[0].arguments == {}


def test_a_tag_of_gazebo_that_is_twice_on_a_condition_only_is_translated(tmp_path: Path):
    text = """
<xacro:arg name="gripper" default="tool"/>
<xacro:property name="gripper" value="$(arg gripper)"/>
<link name="base"/>
<gazebo reference="base">
  <selfCollide>true</selfCollide>
  <material>Gazebo/White</material>
  <xacro:if value="${gripper == 'base'}"><material>Gazebo/Grey</material></xacro:if>
</gazebo>
"""
    migrated(tmp_path, text, {"gripper": "base"})
    migrated(tmp_path, text, {"gripper": "tool"})


def test_a_word_that_chooses_the_hardware_has_only_the_values_that_do(tmp_path: Path):
    text = """
<xacro:arg name="mode" default="mock"/>
<xacro:macro name="arm" params="mode:=mock">
  <link name="base"/>
  <link name="tip"/>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
  <ros2_control name="arm" type="system">
    <xacro:if value="${mode == 'mock'}"><hardware><plugin>m/Mock</plugin></hardware></xacro:if>
    <xacro:if value="${mode == 'real'}">
      <hardware><plugin>r/Real</plugin><param name="port">3</param></hardware>
    </xacro:if>
    <joint name="elbow"><command_interface name="position"/></joint>
  </ros2_control>
</xacro:macro>
<xacro:arm mode="$(arg mode)"/>
"""
    made = migrated(tmp_path, text)
    declared = "mode: {type: string, default: mock, enum: [mock, real]}"
    assert declared in made.robot
    assert declared in made.files["arm.robot.yaml"]
    assert "extra" not in made.files["arm.robot.yaml"]
    assert len(made.proved.comparisons) == 2


def test_the_environment_is_read_once_and_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    text = '<link name="base"/><gazebo><serial>$(optenv  ROBOT_SERIAL  no serial)</serial></gazebo>'
    monkeypatch.delenv("ROBOT_SERIAL", raising=False)
    made = migrated(tmp_path, text)
    assert "serial: no serial" in made.robot
    (note,) = made.proved.diagnostics
    assert (note.code.id, note.span and note.span.line) == ("LF8052", 2)
    monkeypatch.setenv("ROBOT_SERIAL", "A7")
    assert "serial: A7" in migrated(tmp_path, text).robot


@pytest.mark.parametrize("flag", ["true", "True", "1", "${1 == 1}"])
def test_flags_of_instructions_are_read_as_xacro_reads_them(flag: str, tmp_path: Path):
    text = f"""
<xacro:property name="a" value="1"/>
<xacro:property name="b" value="${{a}}" lazy_eval="{flag}"/>
<xacro:property name="c" value="1"/>
<xacro:property name="c" remove="{flag}"/>
<xacro:property name="c" default="3"/>
<xacro:property name="a" value="2"/>
<link name="base"><collision><geometry><box size="${{a}} ${{b}} ${{c}}"/></geometry></collision></link>"""
    made = migrated(tmp_path, text)
    box = compile_text(made.robot).result().links["base"].collisions[0].geometry
    assert (box.size.x, box.size.y, box.size.z) == (2, 2, 3)


def test_a_parameter_of_some_of_three_drivers_has_a_condition(tmp_path: Path):
    text = """
<xacro:arg name="driver" default="a"/>
<xacro:arg name="ip" default="10.0.0.1"/>
<xacro:property name="driver" value="$(arg driver)"/>
<link name="base"/>
<link name="tip"/>
<joint name="elbow" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
<ros2_control name="arm" type="system">
  <hardware>
    <xacro:if value="${driver == 'a'}"><plugin>a/A</plugin><param name="ip">$(arg ip)</param></xacro:if>
    <xacro:if value="${driver == 'b'}"><plugin>b/B</plugin></xacro:if>
    <xacro:if value="${driver == 'c'}"><plugin>c/C</plugin><param name="ip">0.0.0.0</param></xacro:if>
  </hardware>
  <joint name="elbow"><command_interface name="position"/></joint>
</ros2_control>
"""
    made = migrated(tmp_path, text)
    assert "enum: [a, b, c]" in made.robot
    assert "value: $(ip if driver == 'a' else '0.0.0.0')" in made.robot
    assert "extra" not in made.robot


def test_namespaces_that_the_root_declares_are_kept(tmp_path: Path):
    main = write(tmp_path, robot='<link name="base"/>')
    declared = main.read_text("utf-8").replace("<robot ", '<robot xmlns:sensor="http://example.org/sensor" ')
    main.write_text(declared, "utf-8")
    proved = Migrator(main, {}, tmp_path / "specs", Settings((), {}).loader(main), Diagnostics()).run()
    assert proved.is_equal
    assert "xmlns:sensor: http://example.org/sensor" in proved.files[proved.main]
