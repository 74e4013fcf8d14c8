"""Data of YAML files."""

from pathlib import Path

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import CannotTranslateError
from tests.cli.in_process import linkforge
from tests.migration.migrated import migrated, write

LIMITS = """\
elbow: {upper: 1.5}
elbow: {upper: 2.5}
wrist: {upper: 0.5, note: "$(none)"}
"""


def test_data_that_a_spec_cannot_read_becomes_a_variable_that_is_a_map(tmp_path: Path):
    (tmp_path / "limits.yaml").write_text(LIMITS, "utf-8")
    text = """
<xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>
<link name="base"/>
<link name="arm"/>
<joint name="elbow" type="revolute">
  <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  <limit lower="0" upper="${limits['elbow']['upper']}" effort="1" velocity="1"/>
</joint>
"""
    made = migrated(tmp_path, text)
    assert (
        """\
variables:
  # from ../limits.yaml, which a spec cannot read directly
  limits: {elbow: {upper: 2.5}, wrist: {upper: 0.5, note: $$(none)}}
"""
        in made.robot
    )
    assert "upper: $(limits.elbow.upper)" in made.robot


def test_a_boolean_of_data_whose_file_an_argument_names_is_written_as_python_writes_it(tmp_path: Path):
    package = tmp_path / "arm_description"
    package.mkdir()
    (package / "hardware.yaml").write_text("open_loop: true\nport: 30200\n", "utf-8")
    text = """
<xacro:arg name="config" default="$(find arm_description)/hardware.yaml"/>
<xacro:macro name="arm" params="config_file">
  <xacro:property name="hardware" value="${xacro.load_yaml(config_file)}"/>
  <link name="base"/>
  <link name="arm"/>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <ros2_control name="arm" type="system">
    <hardware>
      <plugin>p/P</plugin>
      <param name="open_loop">${hardware['open_loop']}</param>
      <param name="port">${hardware['port']}</param>
    </hardware>
    <joint name="elbow"><command_interface name="position"/></joint>
  </ros2_control>
</xacro:macro>
<xacro:arm config_file="$(arg config)"/>
"""
    module = migrated(tmp_path, text, packages={"arm_description": package}).files["arm.robot.yaml"]
    assert "data:\n  hardware: $(config_file)\n" in module
    assert "open_loop: $('True' if hardware.open_loop else 'False')" in module


def test_python_that_asks_for_the_class_of_a_value_is_computed(tmp_path: Path):
    text = """
<xacro:property name="fingers" value="${dict(thumb=1, index=2)}"/>
<xacro:if value="${python.isinstance(fingers, dict) and not python.isinstance(fingers, (list, str))}">
  <link name="hand_${fingers['index']}"/>
</xacro:if>
"""
    assert "links:\n  hand_2: {}\n" in migrated(tmp_path, text).robot


TAGGED = """\
base: {size: !millimeters 250, tilt: !degrees pi/2 * 10}
"""


def test_a_file_with_the_tags_of_units_is_data_of_the_spec(tmp_path: Path):
    (tmp_path / "sizes.yaml").write_text(TAGGED, "utf-8")
    text = """
<xacro:property name="sizes" value="${xacro.load_yaml('sizes.yaml')}"/>
<link name="base"><visual>
  <origin xyz="0 0 0" rpy="0 0 ${sizes['base']['tilt']}"/>
  <geometry><sphere radius="${sizes['base']['size']}"/></geometry>
</visual></link>
"""
    made = migrated(tmp_path, text)
    assert "data:\n  sizes: ../sizes.yaml\n" in made.robot
    assert "sphere: $(sizes.base.size)" in made.robot


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"a: \xff", "cannot be read: 'utf-8' codec can't decode byte 0xff"),
        (b"a: !degrees none", "cannot be read: 'none' after !degrees is not a number (line 1, column 4)"),
        (b"a: {", "cannot be read: expected the node content, but found '<stream end>' (line 1, column 5)"),
    ],
)
def test_a_faulty_file_of_data_is_told_on_one_line(tmp_path: Path, data: bytes, reason: str):
    (tmp_path / "sizes.yaml").write_bytes(data)
    main = write(tmp_path, robot='<link name="a"/>')
    sources = Sources(main, Settings().loader(main), Diagnostics())
    with pytest.raises(CannotTranslateError) as found:
        sources.data(tmp_path / "sizes.yaml")
    assert reason in found.value.reason
    assert "\n" not in found.value.reason


def test_a_file_that_is_no_yaml_is_told_with_its_place(tmp_path: Path):
    (tmp_path / "sizes.yaml").write_text("a: [1\n", "utf-8")
    write(tmp_path, robot="""<link name="${xacro.load_yaml('sizes.yaml')['a']}"/>""")
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert "sizes.yaml' is not YAML: expected ',' or ']', but got '<stream end>' (line 2, column 1), in" in ran.stderr


def test_a_vector_that_is_a_text_of_data_is_split(tmp_path: Path):
    (tmp_path / "camera.yaml").write_text("front: {xyz: 0 0 1e-1, rpy: 0 0 0.5}\nrear: {xyz: 0 0 0.2}\n", "utf-8")
    text = """
<xacro:arg name="place" default="front"/>
<xacro:property name="mounts" value="${xacro.load_yaml('camera.yaml')}"/>
<xacro:macro name="camera" params="name at">
  <xacro:property name="words" value="${at['rpy'] if 'rpy' in at else '0 0 -0.5'}"/>
  <link name="${name}"/>
  <joint name="${name}_joint" type="fixed">
    <parent link="base"/>
    <child link="${name}"/>
    <origin xyz="${at['xyz']}" rpy="${words}"/>
  </joint>
  <link name="${name}_lens">
    <visual><origin xyz="${at['xyz'].split(' ')[2]} 0 0"/><geometry><sphere radius="1"/></geometry></visual>
  </link>
  <joint name="${name}_lens_joint" type="fixed"><parent link="${name}"/><child link="${name}_lens"/></joint>
</xacro:macro>
<link name="base"/>
<xacro:camera name="fixed" at="${mounts['rear']}"/>
<xacro:camera name="chosen" at="${mounts['rear'] if '$(arg place)' == 'rear' else mounts['front']}"/>
"""
    made = migrated(tmp_path, text)
    assert "xyz: $(split(mounts.rear.xyz))" in made.robot
    assert "$(split(at.xyz)[2])" in made.files["camera.robot.yaml"]


def test_an_inertia_that_data_always_have_has_no_alternative_without_it(tmp_path: Path):
    (tmp_path / "inertials.yaml").write_text("arm: {mass: 2.0, inertia: {xx: 1.0, yy: 1.0, zz: 1.5}}\n", "utf-8")
    text = """
<xacro:macro name="part" params="name inertials">
  <link name="${name}">
    <xacro:if value="${name in inertials}">
      <inertial>
        <mass value="${inertials[name].mass}"/>
        <xacro:if value="${'inertia' in inertials[name]}">
          <xacro:property name="I" value="${inertials[name].inertia}"/>
          <inertia ixx="${I.xx}" iyy="${I.yy}" izz="${I.zz}" ixy="0" ixz="0" iyz="0"/>
        </xacro:if>
      </inertial>
    </xacro:if>
  </link>
</xacro:macro>
<xacro:part name="arm" inertials="${xacro.load_yaml('inertials.yaml')}"/>
<xacro:part name="tip" inertials="${xacro.load_yaml('inertials.yaml')}"/>
<joint name="joint" type="fixed"><parent link="arm"/><child link="tip"/></joint>
"""
    module = migrated(tmp_path, text).files["part.robot.yaml"]
    assert "when: $(base_name in inertials)\n" in module
    assert "extra" not in module


JOINTS = """
<link name="base"/>
<xacro:macro name="part" params="name limits">
  <link name="${name}"/>
  <joint name="${name}_joint" type="revolute">
    <parent link="base"/><child link="${name}"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="${radians(limits[name]['upper'])}" effort="1" velocity="${radians(limits[name]['speed'])}"/>
  </joint>
</xacro:macro>
<xacro:part name="left" limits="${limits}"/><xacro:part name="right" limits="${limits}"/>
"""


def test_a_map_is_given_to_a_module_as_one_and_radians_of_a_velocity_are_no_angle(tmp_path: Path):
    both = "dict(left=dict(upper=90, speed=180), right=dict(upper=45, speed=100))"
    made = migrated(tmp_path, f'<xacro:property name="limits" value="${{{both}}}"/>{JOINTS}')
    part = made.files["part.robot.yaml"]
    assert "limits: {type: map}" in part
    assert "upper: $(radians(limits[base_name].upper))" in part
    assert "velocity: $(limits[base_name].speed * pi / 180)" in part


def test_a_parameter_of_which_keys_are_read_is_a_map(tmp_path: Path):
    package = tmp_path / "cart_description"
    package.mkdir()
    (package / "wheels.yaml").write_text("front: {radius: 0.2}\n", "utf-8")
    text = """
<xacro:arg name="wheels" default="None"/>
<xacro:macro name="wheel" params="name wheel">
  <link name="${name}"><visual><geometry><sphere radius="${wheel['radius']}"/></geometry></visual></link>
  <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro>
<xacro:macro name="cart" params="file">
  <xacro:if value="${file == 'None'}">
    <xacro:property name="path" value="$(find cart_description)/wheels.yaml"/>
  </xacro:if>
  <xacro:unless value="${file == 'None'}"><xacro:property name="path" value="${file}"/></xacro:unless>
  <xacro:property name="wheels" value="${load_yaml(path)}"/>
  <link name="base"/>
  <xacro:wheel name="left" wheel="${wheels['front']}"/>
  <xacro:wheel name="right" wheel="${wheels['front']}"/>
</xacro:macro>
<xacro:cart file="$(arg wheels)"/>
"""
    made = migrated(tmp_path, text, packages={"cart_description": package})
    assert "  wheel: {type: map}\n" in made.files["wheel.robot.yaml"]
    assert "sphere: $(wheel.radius)" in made.files["wheel.robot.yaml"]


def test_a_variable_that_is_a_velocity_is_no_angle(tmp_path: Path):
    text = """
<xacro:arg name="speed" default="90"/>
<xacro:property name="velocity" value="${radians($(arg speed))}"/>
<link name="base"/><link name="tip"/>
<joint name="j" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
  <limit lower="${-velocity / 2}" upper="1" effort="1" velocity="${velocity * 2}"/></joint>"""
    assert "velocity: $(speed * pi / 180)\n" in migrated(tmp_path, text).robot


def test_an_argument_that_names_a_file_beside_the_xacro_is_a_file_with_its_place(tmp_path: Path):
    """A relative path begins in the folder of the xacro, and that of a parameter in the folder of the spec."""
    (tmp_path / "arm.yaml").write_text("reach: {upper: 0.5}\n", "utf-8")
    text = """
<xacro:arg name="config" default="arm.yaml"/>
<xacro:property name="known" value="${xacro.load_yaml('$(arg config)')['reach']}"/>
<xacro:macro name="ball" params="name known">
  <link name="${name}"><visual><geometry><sphere radius="${known.upper}"/></geometry></visual></link>
  <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro>
<link name="base"/>
<xacro:ball name="left" known="${known}"/>
<xacro:ball name="right" known="${known}"/>"""
    made = migrated(tmp_path, text)
    assert "config: {type: file, default: ../arm.yaml}" in made.robot
    assert "known: {type: map}" in made.files["ball.robot.yaml"]


def test_a_file_that_a_spec_cannot_read_keeps_the_argument_that_names_it(tmp_path: Path):
    (tmp_path / "arm.yaml").write_text("reach: 1\nreach: 0.5\n", "utf-8")
    text = """
<xacro:arg name="folder" default="."/>
<xacro:arg name="config" default="$(arg folder)/arm.yaml"/>
<xacro:property name="known" value="${xacro.load_yaml('$(arg config)')}"/>
<link name="base"><visual><geometry><sphere radius="${known['reach']}"/></geometry></visual></link>"""
    made = migrated(tmp_path, text)
    assert [one.code.id for one in made.proved.diagnostics] == ["LF8042", "LF8042"]
    assert "reach: 0.5" in made.robot
