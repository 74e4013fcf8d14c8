"""A URDF comes in as a person would write it: short forms, defaults left out, numbers to the last digit."""

import math
import re
from pathlib import Path
from textwrap import dedent

import pytest

from linkforge_compile import Import, check_file, compile_text, import_urdf, render_urdf
from linkforge_compile.core.physics import rotation_matrix
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import read as read_yaml
from tests.consumers import check_urdf


@pytest.fixture
def read(tmp_path: Path):
    """Import a URDF that is written in a test, whose robot is named `r`, without diagnostics."""

    def read_urdf(text: str) -> str:
        imported = imported_from(text, tmp_path)
        assert not [str(one) for one in imported.diagnostics]
        assert imported.text is not None
        return imported.text.removeprefix("linkforge: 1\nname: r\n").strip("\n")

    return read_urdf


def imported_from(text: str, folder: Path) -> Import:
    file = folder / "r.urdf"
    file.write_text(f'<robot name="r">{text}</robot>', "utf-8")
    return import_urdf(file)


def spec(text: str) -> str:
    return dedent(text).strip("\n")


def compiled(text: str) -> str:
    return render_urdf(compile_text(text).result())


BOTH = '<link name="a"/><link name="b"><visual><geometry><box size="1 1 1"/></geometry></visual></link>'
ENDS = '<parent link="a"/><child link="b"/>'


def joint(read, text: str, kind: str = "revolute") -> str:
    """Return the contents of a joint between two links, without its type and its ends."""
    lines = read(f'{BOTH}<joint name="j" type="{kind}">{ENDS}{text}</joint>').partition("joints:\n")[2]
    body = dedent(lines.partition("\n")[2]) if lines.startswith("  j:\n") else lines.strip().removeprefix("j: ")
    return body.replace(f"type: {kind}, parent: a, child: b", "").replace(f"type: {kind}\nparent: a\nchild: b\n", "")


LIMIT = '<limit lower="-1" upper="1" effort="2" velocity="3"/>'


@pytest.mark.parametrize(
    ("axis", "spec"),
    [
        ("0 0 1", "z"),
        ("0.0 -1.0 0", "-y"),
        ("-0 0 1.000", "z"),
        ("0 0 2", "[0, 0, 2]"),
        ("0.7071 0 0.7071", "[0.7071, 0, 0.7071]"),
    ],
)
def test_an_axis_is_a_letter_where_it_is_one(read, axis: str, spec: str):
    assert f"axis: {spec}" in joint(read, f'<axis xyz="{axis}"/>{LIMIT}')


def test_a_joint_without_axis_turns_about_x(read):
    assert "axis: x" in joint(read, LIMIT)


@pytest.mark.parametrize(
    ("radians", "spec"),
    [
        ("1.5707963267948966", "90 deg"),
        ("-3.141592653589793", "-180 deg"),
        ("0.7853981633974483", "45 deg"),
        ("0.02181661564992912", "1.25 deg"),
        ("1.5708", "1.5708"),
        ("1.57079632679", "1.57079632679"),
        ("0.1", "0.1"),
        ("0.10000000001", "0.10000000001"),
        ("3.14159265358979", "3.14159265358979"),
        ("12.6", "12.6 rad"),
    ],
)
def test_an_angle_is_in_degrees_only_where_it_is_the_same_double(read, radians: str, spec: str):
    limit = f'<limit lower="-20" upper="{radians}" effort="2" velocity="3"/>'
    assert f"upper: {spec}," in joint(read, f'<axis xyz="0 0 1"/>{limit}')


def test_a_length_is_never_an_angle(read):
    limit = '<limit lower="0" upper="1.5707963267948966" effort="2" velocity="3.141592653589793"/>'
    assert "limits: {lower: 0, upper: 1.5707963267948966, effort: 2, velocity: 3.141592653589793}" in joint(
        read, f'<axis xyz="0 0 1"/>{limit}', "prismatic"
    )


def test_the_parts_of_a_joint_leave_their_defaults_out(read):
    parts = """
        <origin xyz="0 0 1" rpy="0 0 0"/><axis xyz="0 0 1"/>
        <dynamics damping="0.5" friction="0.0"/>
        <mimic joint="k" multiplier="1.0" offset="0.2"/>
        <safety_controller k_velocity="10" soft_upper_limit="0.5"/>
        <calibration rising="0.1" reference_position="0.2"/>"""
    spec = read(
        f"""{BOTH}<joint name="j" type="continuous">{ENDS}{parts}</joint><link name="c"/>
        <joint name="k" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/></joint>"""
    )
    assert "origin: [0, 0, 1]" in spec
    assert "dynamics: {damping: 0.5}" in spec
    assert "mimic: {joint: k, offset: 0.2}" in spec
    assert "safety_controller: {soft_upper_limit: 0.5, k_velocity: 10}" in spec
    assert "calibration: {rising: 0.1, extra_attributes: {reference_position: 0.2}}" in spec


def test_what_a_fixed_joint_has_left_over_stays(read):
    spec = joint(read, '<axis xyz="0 0 1"/><limit effort="1" velocity="2"/>', "fixed")
    assert spec == 'extra: [<axis xyz="0 0 1"/>, <limit effort="1" velocity="2"/>]'


def test_unknown_attributes_and_elements_stay_where_they_were(read):
    text = read("""
      <link name="a" type="hand">
        <inertial frame="body"><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0.0"/></inertial>
        <collision>
          <geometry><mesh filename="a.stl" convex="true"/></geometry>
          <surface>
            <friction><ode mu="$(mu)"/></friction>
          </surface>
        </collision>
        <drake:proximity_properties/>
      </link>""")
    assert text == spec("""
        links:
          a:
            collision:
              mesh: {file: a.stl, extra_attributes: {convex: true}}
              extra: |-
                <surface>
                  <friction><ode mu="$$(mu)"/></friction>
                </surface>
            inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}, extra_attributes: {frame: body}}
            extra: <drake:proximity_properties/>
            extra_attributes: {type: hand}""")


def test_equal_shapes_are_written_once(read):
    shape = '<origin xyz="0 0 {z}"/><geometry><cylinder radius="0.1" length="1"/></geometry>'
    text = read(f"""
      <link name="a"><visual>{shape.format(z="0.5")}</visual><collision>{shape.format(z="0.50")}</collision></link>
      <link name="b"><visual>{shape.format(z="0.5")}</visual><collision>{shape.format(z="0.6")}</collision></link>
      <joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>""")
    assert text.count("collision: visual") == 1
    assert "collision: {cylinder: {radius: 0.1, length: 1}, origin: [0, 0, 0.6]}" in text


def test_collisions_before_visuals_stay_there(read):
    shape = "<geometry><sphere radius='1'/></geometry>"
    text = read(f"<link name='a'><collision>{shape}</collision><visual>{shape}</visual></link>")
    assert text == "links:\n  a: {collision: visual, visual: {sphere: 1}}"
    urdf = compiled(f"linkforge: 1\nname: r\n{text}\n")
    assert urdf.index("<collision") < urdf.index("<visual")


@pytest.mark.parametrize(
    ("tags", "spec"),
    [
        ("visual collision visual collision", "shape_order: pairs"),
        ("collision visual collision", "shape_order: pairs"),
        ("visual visual collision visual", "shape_order: [visual, visual, collision, visual]"),
    ],
)
def test_shapes_that_are_mixed_stay_so(read, tags: str, spec: str):
    shape = "<{0}><geometry><sphere radius='1'/></geometry></{0}>"
    text = read(f"<link name='a'>{''.join(map(shape.format, tags.split()))}</link>")
    assert spec in text
    assert re.findall(r"<(visual|collision)>", compiled(f"linkforge: 1\nname: r\n{text}\n")) == tags.split()


@pytest.mark.parametrize(
    ("painted", "spec"),
    [
        ("1 0 0 1", "red: {color: [0, 0, 1], after_links: true}"),
        ("0 0 1.0 1", "red: {color: [0, 0, 1]}"),
    ],
)
def test_a_material_after_another_color_of_its_name_keeps_its_place(read, painted: str, spec: str):
    """MuJoCo takes the first color of a name, and urdfdom the robot's own, so neither may become the other."""
    seen = shown(f'<material name="red"><color rgba="{painted}"/></material>') + shown('<material name="red"/>')
    text = read(f'<link name="a">{seen}</link><material name="red"><color rgba="0 0 1 1"/></material>')
    assert spec in text
    urdf = compiled(f"linkforge: 1\nname: r\n{text}\n")
    first = re.search(r'<material name="red">\s*<color rgba="([^"]*)"', urdf)
    assert first
    assert list(map(float, first[1].split())) == list(map(float, painted.split()))


def test_a_named_collision_is_not_the_visual(read):
    shape = "<geometry><sphere radius='1'/></geometry>"
    text = read(f"<link name='a'><visual>{shape}</visual><collision name='c'>{shape}</collision></link>")
    assert "collision: {name: c, sphere: 1}" in text


def shown(material: str) -> str:
    return f'<visual><geometry><sphere radius="1"/></geometry>{material}</visual>'


def test_materials_are_written_once_wherever_they_are_declared(read):
    green = '<material name="green"><color rgba="0 1 0 1"/></material>'
    text = read(f"""
      <material name="red"><color rgba="1 0 0 0.5"/></material>
      <link name="a">
        {shown('<material name="green"/>')}
        {shown(green)}
        {shown('<material name="red"/>')}
        {shown(green.replace("0 1 0 1", "0.0 1 0 1"))}
        {shown(green.replace("0 1 0", "0 0.5 0"))}
        {shown('<material name=""><color rgba="0 0 1 1"/><texture filename="a.png"/></material>')}
      </link>""")
    assert text == spec("""
        materials:
          red: {color: [1, 0, 0, 0.5]}
          green: {color: [0, 1, 0]}

        links:
          a:
            visual:
              - {sphere: 1, material: green}
              - {sphere: 1, material: green}
              - {sphere: 1, material: red}
              - {sphere: 1, material: green}
              - {sphere: 1, material: {name: green, color: [0, 0.5, 0]}}
              - {sphere: 1, material: {color: [0, 0, 1], texture: a.png}}""")


def test_a_material_of_a_collision_stays(read):
    text = read("""<link name="a"><collision><geometry><box size="1 1 1"/></geometry>
        <material name="red"/></collision></link>""")
    assert 'collision: {box: [1, 1, 1], extra: <material name="red"/>}' in text


def test_empty_links_at_the_end_are_frames(read):
    text = read(f"""{BOTH}
      <link name="tool"/>
      <link name="camera"/>
      <joint name="j" type="fixed">{ENDS}</joint>
      <joint name="tool_joint" type="fixed"><parent link="b"/><child link="tool"/><origin xyz="0 0 1"/></joint>
      <joint name="eye" type="fixed"><parent link="b"/><child link="camera"/></joint>""")
    assert text.endswith(
        spec("""
        frames:
          tool: {parent: b, origin: [0, 0, 1]}
          camera: {parent: b, joint: eye}""")
    )


def test_comments_stand_where_they_stood(tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text(
        dedent("""\
        <?xml version="1.0"?>
        <!-- by hand -->
        <robot name="r">
          <!--
            The base:
              heavy
          -->
          <link name="a">
            <!-- how it looks -->
            <visual>
              <geometry>
                <!-- rounded -->
                <sphere radius="1"/>
              </geometry>
            </visual>
            <inertial>
              <mass value="2"/> <!-- weighed -->
              <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
            </inertial>
            <!-- <collision/> one day -->
          </link>
          <mujoco><!-- theirs --></mujoco>
          <!-- the end -->
        </robot>
        <!-- really -->
        """)
    )
    assert import_urdf(file).text == dedent("""\
        # by hand
        linkforge: 1
        name: r

        links:
          # The base:
          #   heavy
          a:
            # how it looks
            visual:
              # rounded
              sphere: 1
            inertial:
              # weighed
              mass: 2
              inertia: {ixx: 1, iyy: 1, izz: 1}
            # <collision/> one day

        extra: <mujoco><!-- theirs --></mujoco>

        # the end
        # really
        """)


def test_a_comment_at_the_end_of_a_line_applies_to_that_line(read):
    text = read("""
      <link name="a"> <!-- the base -->
        <visual>
          <origin xyz="0 0 1"/> <!-- raised -->
          <geometry>
            <sphere radius="1"/>
          </geometry> <!-- round -->
        </visual>
      </link>
      <link name="b"/> <!-- the tip -->
      <!-- turns -->
      <joint name="j" type="floating"><parent link="a"/><child link="b"/>
        <origin xyz="0 0 0"/> <!-- on the base -->
      </joint>""")
    assert text.partition("links:")[2] == dedent("""
          # the base
          a:
            visual:
              # round
              sphere: 1
              # raised
              origin: [0, 0, 1]
          # the tip
          b: {}

        joints:
          # turns
          # on the base
          j: {type: floating, parent: a, child: b}""")


@pytest.mark.parametrize(
    ("above", "below"),
    [
        ("<!-- Arm of our lab -->\n\n<!-- made of steel -->\n\n", ""),
        ("<!--\nArm of our lab\nmade of steel\n-->\n<!-- the base -->", "  # the base\n"),
        ("<!-- Arm of our lab -->\n<!--made of steel-->\n\n<!-- the base -->\n", "  # the base\n"),
    ],
)
def test_comments_apart_from_the_first_element_stand_above_its_section(read, above: str, below: str):
    joint = '<joint name="j" type="floating"><parent link="a"/><child link="b"/></joint>'
    text = read(f'{above}<link name="a"/>\n\n<!-- within it -->\n\n<link name="b"/>{joint}')
    head, _, links = text.partition("\n\njoints:")[0].partition("links:\n")
    assert head == "# Arm of our lab\n# made of steel\n"
    assert links == f"{below}  a: {{}}\n  # within it\n  b: {{}}"


def test_the_order_in_each_section_is_the_authors(read):
    text = read("""
      <joint name="z" type="fixed"><parent link="c"/><child link="a"/><origin xyz="1 0 0"/></joint>
      <link name="c"/>
      <joint name="b" type="fixed"><parent link="c"/><child link="b"/></joint>
      <link name="b"/>
      <link name="a"/>""")
    assert [line.strip().partition(":")[0] for line in text.splitlines() if line.startswith("  ")] == [
        *("c", "b", "a", "z", "b"),
    ]


@pytest.mark.parametrize("name", ["true", "1", "null", "a.b/c", "0x10", "no", "größe"])
def test_names_stay_names(read, name: str):
    text = read(f'<link name="{name}"/>')
    urdf = compiled(f"linkforge: 1\nname: r\n{text}\n")
    assert f'<link name="{name}"/>' in urdf


@pytest.mark.parametrize(
    ("written", "out"),
    [
        ("0.1", "0.1"),
        ("0.10000000001", "0.10000000001"),
        ("1e-3", "0.001"),
        ("+.5", "0.5"),
        ("5.", "5"),
        ("010", "10"),
        ("-0.0", "0"),
        ("4.9e-324", "5e-324"),
        ("123456789012345678", "123456789012345680"),
        ("0.30000000000000004", "0.30000000000000004"),
    ],
)
def test_a_number_comes_back_to_the_same_double(read, written: str, out: str):
    text = read(f'{BOTH}<joint name="j" type="fixed">{ENDS}<origin xyz="{written} 1 0"/></joint>')
    urdf = compiled(f"linkforge: 1\nname: r\n{text}\n")
    [xyz] = [line for line in urdf.splitlines() if "<origin" in line]
    assert float(xyz.split('"')[1].split()[0]) == float(written) == float(out)


def test_gazebo_blocks_follow_their_links_and_joints(read):
    text = read("""<link name="a"/>
      <gazebo><static>true</static></gazebo>
      <gazebo reference="a"><mu1>0.20</mu1><mu2>2e-1</mu2><material>Gazebo/Red</material>
        <sensor name="eye" type="camera"/>
        <plugin name="p" filename="p.so"><ros><namespace>/x</namespace></ros><j>a</j><j>b</j></plugin></gazebo>
      <gazebo reference="a"><plugin name="p" filename="p.so"><x/><x>1</x><y/></plugin></gazebo>
      <gazebo reference="a"/>""")
    assert text == spec("""
        links:
          a:
            gazebo:
              - mu1: 0.20
                material: Gazebo/Red
                properties: {mu2: 2e-1, sensor: {_name: $(prefix)eye, _type: camera}}
                plugins:
                  p: {filename: p.so, parameters: {ros: {namespace: /x}, j: [a, b]}}
              - plugins:
                  p: {filename: p.so, parameters: {x: ["", 1], y: ""}}
              - {}

        gazebo:
          static: true""")


def test_hardware_comes_in_by_its_names(read):
    text = read("""<link name="a"/>
      <ros2_control name="h" type="system" rw_rate="50">
        <hardware><plugin>m/S</plugin><param name="id">007</param></hardware>
        <gpio name="g"><state_interface name="in"><param name="initial_value">1.0</param></state_interface></gpio>
        <gpio name="o"><command_interface name="out"/></gpio>
        <gpio name="idle"><param name="pin">4</param></gpio>
        <transmission name="inner"/>
      </ros2_control>""")
    assert text == spec("""
        links:
          a: {}

        ros2_control:
          h:
            hardware_plugin: m/S
            parameters: {id: 007}
            gpios:
              g: {state_interfaces: {in: {initial_value: 1.0}}}
              o: {command_interfaces: [out]}
              idle: {parameters: {pin: 4}}
            extra: <transmission name="$(prefix)inner"/>
            extra_attributes: {rw_rate: 50}""")


ARM_OF_TWO_CONTROLS = """
  <link name="base"/><link name="upper"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  {controls}"""
CONTROL = """
  <ros2_control name="{name}" type="system"><hardware><plugin>p/P</plugin></hardware>
    <joint name="turn"><command_interface name="position"/><state_interface name="{name}"/></joint></ros2_control>"""


def test_a_robot_whose_interface_is_commanded_twice_comes_in_whole(tmp_path: Path):
    controls = "".join(CONTROL.format(name=name) for name in ("left", "right"))
    imported = imported_from(ARM_OF_TWO_CONTROLS.format(controls=controls), tmp_path)
    assert [one.code.id for one in imported.diagnostics] == ["LF8021"]
    compilation = compile_text(imported.text or "", name="r.robot.yaml")
    assert not compilation.has_errors
    urdf = render_urdf(compilation.result())
    assert urdf.count('<command_interface name="position"/>') == 2
    assert [one.code.id for one in check_file(tmp_path / "r.urdf").diagnostics] == ["LF6101"]


def test_of_two_controls_that_one_macro_made_the_second_is_kept_raw(tmp_path: Path):
    pytest.importorskip("xacro")
    file = tmp_path / "r.urdf.xacro"
    macro = f'<xacro:macro name="control" params="name">{CONTROL.replace("{", "${")}</xacro:macro>'
    calls = '<xacro:control name="left"/><xacro:control name="right"/>'
    body = ARM_OF_TWO_CONTROLS.format(controls=macro + calls)
    file.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>', "utf-8")
    left, right = (import_urdf(file).text or "").split("  left:")[1].split("  right:")
    assert "command_interfaces: [position]" in left
    assert 'extra: <command_interface name="position"/>' in right


def test_a_transmission_keeps_the_spelling_that_its_fields_cannot(read):
    text = read(f"""{BOTH}<joint name="j" type="fixed">{ENDS}</joint>
      <transmission name="t"><type>transmission_interface/SimpleTransmission</type>
        <joint name="j"><hardwareInterface>position</hardwareInterface></joint>
        <actuator name="m"><hardwareInterface>effort</hardwareInterface>
          <mechanicalReduction>50</mechanicalReduction><offset>1.0</offset></actuator></transmission>""")
    assert text.partition("transmissions:\n")[2] == spec("""
      t:
        type: transmission_interface/SimpleTransmission
        joints: {j: {}}
        actuators:
          m: {hardware_interfaces: [effort], mechanical_reduction: 50, extra: <offset>1.0</offset>}""").replace(
        "\n", "\n  "
    ).replace("t:", "  t:", 1)


def test_a_transmission_without_interfaces_has_none(read):
    transmission = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
        <joint name="j"/><actuator name="m"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>"""
    text = read(f'{BOTH}<joint name="j" type="fixed">{ENDS}</joint>{transmission}')
    assert "joints: {j: {hardware_interfaces: []}}" in text
    assert "actuators: {m: {hardware_interfaces: [], mechanical_reduction: 50}}" in text
    assert "hardwareInterface" not in compiled(f"linkforge: 1\nname: r\n{text}")


def test_raw_elements_keep_comments_and_report_instructions(tmp_path: Path):
    comment = "<!-- one\n       two <?x y?> -->"
    diagnostics = imported_from(
        f"<link name='a'/>\n    <mine>\n        {comment}\n        <?sort by name?><a/>\n    </mine>", tmp_path
    )
    assert [one.code.id for one in diagnostics.diagnostics] == ["LF8102"]
    assert diagnostics.text is not None
    [raw] = compile_text(diagnostics.text).result().extra_elements
    assert raw == f"<mine>\n    {comment}\n    <a/>\n</mine>"


def test_elements_kept_raw_for_one_reason_are_reported_once_with_a_count(tmp_path: Path):
    diagnostics = imported_from("<link name='a'/>" + "\n<transmission/>" * 9, tmp_path)
    [one] = diagnostics.diagnostics
    assert one.message == "<transmission> is kept as raw XML: it has no 'name'"
    assert [(note.message, note.span.line) for note in one.notes] == [("and 8 more like this, the next one here", 3)]


def test_extra_content_of_an_inner_element_joins_that_of_its_keys(read):
    shape = '<geometry by="me"><box size="1 1 1" unit="m"/></geometry>'
    text = read(f"""
      <material name="red"><color rgba="1 0 0 1" space="srgb"/></material>
      <link name="a">
        <visual>{shape}<material name="red"/></visual>
        <inertial><mass value="1" by="scale"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
      </link>
      <link name="b"/>
      <joint name="j" type="continuous">
        <parent link="a" frame="f"/><child link="b"><note/></child><axis xyz="0 0 1" expressed_in="a"/>
      </joint>""")
    assert text == spec("""
        materials:
          red:
            color: [1, 0, 0]
            extra_inside: {color: {extra_attributes: {space: srgb}}}

        links:
          a:
            visual:
              box: {size: [1, 1, 1], extra_attributes: {unit: m}}
              material: red
              extra_inside: {geometry: {extra_attributes: {by: me}}}
            inertial:
              mass: 1
              inertia: {ixx: 1, iyy: 1, izz: 1}
              extra_inside: {mass: {extra_attributes: {by: scale}}}
          b: {}

        joints:
          j:
            type: continuous
            parent: a
            child: b
            axis: z
            extra_inside:
              parent: {extra_attributes: {frame: f}}
              child: {extra: <note/>}
              axis: {extra_attributes: {expressed_in: a}}""")
    urdf = compiled(f"linkforge: 1\nname: r\n{text}\n")
    for kept in ('by="me"', 'unit="m"', 'by="scale"', 'frame="f"', "<note/>", 'expressed_in="a"', 'space="srgb"'):
        assert kept in urdf


def test_banners_of_generators_are_left_out_and_all_else_at_the_top_stays(tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text(
        dedent("""\
        <?xml version="1.0"?>
        <!-- Compiled by linkforge from r.robot.yaml; edit that file, not this one. -->
        <!-- ======== -->
        <!-- =================================================================================== -->
        <!-- |    This document was autogenerated by xacro from r.urdf.xacro                   | -->
        <!-- |    EDITING THIS FILE BY HAND IS NOT RECOMMENDED                                 | -->
        <!-- =================================================================================== -->
        <!-- (c) the author; editing this file by hand is fine -->
        <robot name="r"><link name="a"/></robot>
        """)
    )
    assert import_urdf(file).text == dedent("""\
        # ========
        # (c) the author; editing this file by hand is fine
        linkforge: 1
        name: r

        links:
          a: {}
        """)


@pytest.mark.parametrize(
    ("quaternion", "rpy"),
    [
        ("0 0 0.7071067811865476 0.7071067811865476", "[0, 0, 90 deg]"),
        ("0 0.7071067811865476 0 0.7071067811865476", "[0, 90 deg, 0]"),
        ("-0.5 0.5 -0.5 -0.5", "[0, -90 deg, 90 deg]"),
        ("1 0 0 0", "[180 deg, 0, 0]"),
        ("0 0 0 2", None),
    ],
)
def test_a_quaternion_is_read_and_comes_out_alone(tmp_path: Path, quaternion: str, rpy: str | None):
    origin = f'<origin xyz="0 0 1" quat_xyzw="{quaternion}"/>'
    joint = f'<joint name="j" type="fixed"><parent link="a"/><child link="b"/>{origin}</joint>'
    urdf = tmp_path / "r.urdf"
    urdf.write_text(f'<robot name="r" version="1.1"><link name="a"/><link name="b"/>{joint}</robot>', "utf-8")
    whole = import_urdf(urdf)
    assert whole.text is not None
    assert not whole.diagnostics
    assert (f"rpy: {rpy}" in whole.text) if rpy else ("rpy" not in whole.text)
    robot = compile_text(whole.text).result()
    assert origin in render_urdf(robot)
    x, y, z, w = (float(part) / math.hypot(*map(float, quaternion.split())) for part in quaternion.split())
    forward = rotation_matrix(robot.joint("j").origin.rpy)
    assert [row[0] for row in forward] == pytest.approx(
        [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)], abs=1e-12
    )
    assert [row[2] for row in forward] == pytest.approx(
        [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)], abs=1e-12
    )


def test_a_quaternion_is_no_turn_to_readers_of_urdf_1_0(tmp_path: Path):
    urdf = tmp_path / "r.urdf"
    shape = '<visual><origin xyz="0 0 1" quat_xyzw="1 0 0 0"/><geometry><sphere radius="1"/></geometry></visual>'
    urdf.write_text(f'<robot name="r"><link name="a">{shape}</link></robot>', "utf-8")
    whole = import_urdf(urdf)
    assert whole.text is not None
    assert not whole.losses
    assert "rpy" not in whole.text


def test_a_quaternion_turns_where_a_capsule_makes_it_urdf_1_1(tmp_path: Path):
    origin = '<origin xyz="0 0 1" quat_xyzw="1 0 0 0"/>'
    shape = f'<visual>{origin}<geometry><capsule radius="1" length="2"/></geometry></visual>'
    whole = imported_from(f'<link name="a">{shape}</link>', tmp_path)
    assert whole.text is not None
    assert "rpy: [180 deg, 0, 0]" in whole.text
    document = compiled(whole.text)
    assert '<robot name="r" version="1.1">' in document
    assert origin in document


def test_signs_of_zero_and_extra_spaces_are_dropped(read):
    text = read("""<link name="a"/> <link name="b"/>
      <joint name="j" type="fixed"><parent link="a"/><child link="b"/><axis xyz="0 0 -0" />
        <origin xyz="1 -0.0 0" rpy="0 0 0"/><note say="a /> b" /><note say='"' b="c />" d='"'/></joint>""")
    assert "origin: [1, 0.0, 0]" in text
    assert '<axis xyz="0 0 -0"/>' in text
    assert '<note say="a /> b"/>' in text
    assert """<note say='"' b="c />" d='"'/>""" in text


def test_a_file_that_holds_just_what_it_may_is_compared_with_more_than_that(monkeypatch: pytest.MonkeyPatch):
    """What it compiles to has its tags on lines of their own, and so space between them."""
    monkeypatch.setattr("linkforge_compile.importers.xml.MOST_INSIDE", 10)
    raw = "".join(f"<a:b{i}/>" for i in range(10))
    imported = import_urdf("r.urdf", text=f"<robot name='r'><link name='l'/><x>{raw}</x></robot>")
    assert imported.diagnostics == ()
    assert imported.text
    assert imported.text.count("<a:b") == 10


@pytest.mark.parametrize("limit", [Limit.VALUES, Limit.ENTRIES])
def test_a_robot_that_no_spec_can_hold_is_reported_at_its_place(limit: Limit, monkeypatch: pytest.MonkeyPatch):
    class Spent(Budget):
        def __init__(self) -> None:
            super().__init__()
            self.spend(limit, limit.most - 10, None)

    monkeypatch.setattr("linkforge_compile.importing.Budget", Spent)
    monkeypatch.setattr("linkforge_compile.importing.check_alone", None)
    links = "".join(f"<link name='l{i}'/>" for i in range(20))
    imported = import_urdf("r.urdf", text=f"<!-- r -->\n<robot name='r'>{links}</robot>")
    [diagnostic] = imported.diagnostics
    assert (imported.text, diagnostic.code.id, str(diagnostic.span)) == (None, "LF3301", "r.urdf:2:1")
    assert diagnostic.message.startswith(
        f"a spec of this robot takes more than {limit.most:,} {limit.counted}; for one of"
    )


def _leaving(left: int, limit: Limit) -> type[Budget]:
    """Return the class of budgets that leave so much of one limit."""

    class Spent(Budget):
        def __init__(self, times: int = 1) -> None:
            super().__init__(times)
            self.spend(limit, times * (limit.most - left), None)

    return Spent


@pytest.mark.parametrize(("limit", "module", "line"), [(Limit.VALUES, "spec_draft", 12), (Limit.ENTRIES, "urdf", 12)])
def test_a_certain_excess_is_reported_where_the_limit_is_reached(
    limit: Limit, module: str, line: int, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(f"linkforge_compile.importers.{module}.Budget", _leaving(10, limit))
    monkeypatch.setattr("linkforge_compile.importing.charge_entries", None)
    links = "".join(f"<link name='l{i}'/>\n" for i in range(20))
    imported = import_urdf("r.urdf", text=f"<robot name='r'>\n{links}</robot>")
    [diagnostic] = imported.diagnostics
    assert (imported.text, diagnostic.code.id, str(diagnostic.span)) == (None, "LF3301", f"r.urdf:{line}:1")


_SHAPE = "<{0}><geometry><mesh filename='a.stl' scale='1 1 1'/></geometry></{0}>"
_PAIRS = (_SHAPE.format("visual") + _SHAPE.format("collision")) * 10
_BLOCKS = "<gazebo reference='l{0}'><mu1>1</mu1><a b='c'><d>1</d></a></gazebo>" * 10
_FIXED = "<joint name='j{0}' type='fixed'><parent link='l0'/><child link='l{0}'/><origin xyz='1 0 0'/></joint>"


@pytest.mark.parametrize(
    ("inside", "beside"), [("", ""), (_PAIRS, ""), ("", _BLOCKS)], ids=["frames", "same", "blocks"]
)
def test_what_the_short_forms_leave_out_of_a_robot_does_not_make_it_too_large(
    inside: str, beside: str, monkeypatch: pytest.MonkeyPatch
):
    links = "".join(f"<link name='l{i}'>{inside}</link>{beside.format(i)}" for i in range(20))
    robot = f"<robot name='r'>{links}{''.join(map(_FIXED.format, range(1, 20)))}</robot>"
    text = import_urdf("r.urdf", text=robot).text
    assert text
    read_yaml(SourceFile("spec", text), Diagnostics(), budget := Budget())
    values = Limit.VALUES.most - budget.left(Limit.VALUES)
    for room in ("importing", "importers.spec_draft"):
        monkeypatch.setattr(f"linkforge_compile.{room}.Budget", _leaving(values, Limit.VALUES))
    assert import_urdf("r.urdf", text=robot).text == text
    monkeypatch.setattr("linkforge_compile.importing.Budget", _leaving(values - 1, Limit.VALUES))
    assert import_urdf("r.urdf", text=robot).text is None


def test_the_entries_of_its_srdf_count_for_a_spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    class Spent(Budget):
        def __init__(self) -> None:
            super().__init__()
            self.spend(Limit.PAIRS, Limit.PAIRS.most, None)

    monkeypatch.setattr("linkforge_compile.importing.Budget", Spent)
    pair = "<disable_collisions link1='a' link2='b' reason='Never'/>"
    (tmp_path / "r.srdf").write_text(f"<robot name='r'>{pair}</robot>")
    arm = "<link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
    imported = import_urdf("r.urdf", text=f"<robot name='r'>{arm}</robot>", srdf=tmp_path / "r.srdf")
    assert imported.text is None
    assert [one.code.id for one in imported.diagnostics] == ["LF3301"]


def test_names_with_spaces_are_replaced_wherever_they_are_used(tmp_path: Path):
    urdf, srdf = tmp_path / "r.urdf", tmp_path / "r.srdf"
    urdf.write_text(
        """<robot name="my arm"><link name="base link"/><link name="base_link"/>
        <joint name="j 1" type="fixed"><parent link="base link"/><child link="base_link"/></joint>
        <gazebo reference="base link"><plugin name="p" filename="p.so"><body>base link</body></plugin></gazebo>
        <camera on="base link"/></robot>""",
        "utf-8",
    )
    srdf.write_text('<robot name="my arm"><passive_joint name="j 1"/></robot>', "utf-8")
    read = import_urdf(urdf, srdf=srdf)
    assert [one.code.id for one in read.diagnostics] == ["LF8105"]
    robot = compile_text(read.text or "").result()
    assert (robot.name, [link.name for link in robot.links]) == ("my_arm", ["base-link", "base_link"])
    assert (robot.joints[0].name, robot.joints[0].parent) == ("j_1", "base-link")
    assert robot.gazebo_elements[0].plugins[0].parameters["body"] == "base-link"
    assert robot.extra_elements == ('<camera on="base-link"/>',)
    assert robot.semantic.passive_joints[0].name == "j_1"
    check_urdf(render_urdf(robot))
