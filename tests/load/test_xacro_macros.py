"""Macros of xacro files as modules: `use: FILE.xacro, macro: NAME`."""

import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile import Compilation, compile_file, import_urdf
from linkforge_compile.compare import compare
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.importers.xacro import MacroCall
from linkforge_compile.load import Loader
from linkforge_compile.load.xacro_library import parameters_in, read_library
from tests.cli.in_process import linkforge

xacro = pytest.importorskip("xacro")

ROOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
INERTIA = f"""{ROOT}>
<xacro:macro name="disc" params="m r h">
  <inertial><mass value="${{m}}"/>
  <inertia ixx="${{m*(3*r*r+h*h)/12}}" iyy="${{m*(3*r*r+h*h)/12}}" izz="${{m*r*r/2}}" ixy="0" ixz="0" iyz="0"/>
  </inertial>
</xacro:macro>
</robot>
"""
PARTS = f"""{ROOT}>
<xacro:include filename="inertia.xacro"/>
<xacro:arg name="color" default="0.1 0.1 0.1 1"/>
<xacro:property name="mass" value="0.19"/>
<link name="not_a_part_of_a_macro"/>
<material name="steel"><color rgba="0.5 0.5 0.5 1"/></material>
<xacro:macro name="lidar" params="prefix:='' parent *origin radius:=0.035">
  <link name="${{prefix}}laser">
    <visual><geometry><cylinder radius="${{radius}}" length="${{radius * 1.2}}"/></geometry>
      <material name="${{prefix}}dark"><color rgba="$(arg color)"/></material></visual>
    <xacro:disc m="${{mass}}" r="${{radius}}" h="0.04"/>
  </link>
  <joint name="${{prefix}}laser_joint" type="fixed">
    <xacro:insert_block name="origin"/><parent link="${{parent}}"/><child link="${{prefix}}laser"/>
  </joint>
  <gazebo reference="${{prefix}}laser">
    <sensor type="ray" name="${{prefix}}scan"><topic>/${{prefix}}scan</topic></sensor>
  </gazebo>
</xacro:macro>
<xacro:macro name="wheel" params="name parent xyz **shape">
  <link name="${{name}}_wheel"><visual><geometry><xacro:insert_block name="shape"/></geometry></visual></link>
  <joint name="${{name}}_axle" type="continuous">
    <origin xyz="${{xyz}}"/><parent link="${{parent}}"/><child link="${{name}}_wheel"/><axis xyz="0 1 0"/>
  </joint>
</xacro:macro>
<xacro:macro name="camera" params="parent_link xyz rpy">
  <link name="camera"/>
  <joint name="camera_joint" type="fixed">
    <origin xyz="${{xyz}}" rpy="${{rpy}}"/><parent link="${{parent_link}}"/><child link="camera"/>
  </joint>
</xacro:macro>
<xacro:macro name="bracket" params="name parent *origin">
  <link name="${{name}}"/>
  <link name="${{name}}_top"><visual><geometry><box size="1 1 1"/></geometry><material name="steel"/></visual></link>
  <joint name="${{name}}_top_joint" type="fixed"><parent link="${{name}}"/><child link="${{name}}_top"/></joint>
  <joint name="${{name}}_joint" type="fixed">
    <xacro:insert_block name="origin"/><parent link="${{parent}}"/><child link="${{name}}"/>
  </joint>
</xacro:macro>
<xacro:macro name="gripper" params="tf_prefix width:=${{2*0.04}}">
  <link name="${{tf_prefix}}_palm"/>
  <link name="${{tf_prefix}}_finger"/>
  <joint name="${{tf_prefix}}_slide" type="prismatic">
    <parent link="${{tf_prefix}}_palm"/><child link="${{tf_prefix}}_finger"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="${{width}}" effort="1" velocity="1"/>
  </joint>
</xacro:macro>
<xacro:macro name="bumpers" params="parent:=base *origin">
  <link name="pad"/>
  <link name="ring"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="pad_joint" type="fixed">
    <xacro:insert_block name="origin"/><parent link="${{parent}}"/><child link="pad"/>
  </joint>
  <joint name="ring_joint" type="revolute">
    <origin xyz="0 0 0.5"/><parent link="${{parent}}"/><child link="ring"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="tip_joint" type="fixed">
    <xacro:insert_block name="origin"/><parent link="ring"/><child link="tip"/>
  </joint>
</xacro:macro>
<xacro:macro name="coupling" params="parent *origin">
  <link name="plate"/>
  <link name="tool"/>
  <joint name="plate_joint" type="fixed"><parent link="${{parent}}"/><child link="plate"/></joint>
  <joint name="tool_joint" type="fixed">
    <xacro:insert_block name="origin"/><parent link="plate"/><child link="tool"/>
  </joint>
</xacro:macro>
<xacro:macro name="sonar" params="name parent">
  <link name="${{name}}_link"/>
  <link name="${{name}}_cone"/>
  <joint name="${{name}}_cone_joint" type="fixed">
    <parent link="${{name}}_link"/><child link="${{name}}_cone"/>
  </joint>
  <joint name="${{name}}_joint" type="fixed">
    <origin xyz="0 0 0.1"/><parent link="${{parent}}_link"/><child link="${{name}}_link"/>
  </joint>
</xacro:macro>
<xacro:macro name="heavy" params="m"><inertial><mass value="${{m}}"/></inertial></xacro:macro>
<xacro:macro name="nothing" params="m"><xacro:property name="n" value="${{m}}"/></xacro:macro>
<xacro:macro name="clamp" params="parent"><xacro:jaw parent="${{parent}}"/></xacro:macro>
<xacro:macro name="mast" params="prefix parent height:=^|0.5 *origin">
  <xacro:lidar prefix="${{prefix}}top_" parent="${{parent}}" radius="0.05">
    <xacro:insert_block name="origin"/>
  </xacro:lidar>
</xacro:macro>
</robot>
"""

Cell = Callable[..., Compilation]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "parts.xacro").write_text(PARTS, "utf-8")
    (tmp_path / "inertia.xacro").write_text(INERTIA, "utf-8")
    return tmp_path


@pytest.fixture
def cell(folder: Path) -> Cell:
    """Return a function that compiles a robot with the link `deck` and some modules of parts.xacro."""

    def compiled(*modules: str) -> Compilation:
        lines = "".join("  " + module.replace("{", "{use: parts.xacro, ", 1) + "\n" for module in modules)
        spec = folder / "cell.robot.yaml"
        spec.write_text(f"linkforge: 1\nname: cell\nlinks: {{deck: }}\nmodules:\n{lines}", "utf-8")
        return compile_file(spec)

    return compiled


def codes(compilation: Compilation) -> list[tuple[str, int]]:
    return [
        (one.code.id, one.span.line if one.span else 0) for one in compilation.diagnostics if one.code.id != "LF6021"
    ]


MODULES_AND_CALLS = {
    "a block, a prefix and a parent": (
        "front: {macro: lidar, parent: deck, origin: {xyz: [20 cm, 0, 0], rpy: [0, 0, 0.25]}, with: {radius: 4 cm}}",
        '<xacro:lidar prefix="front_" parent="deck" radius="0.04"><origin xyz="0.2 0 0" rpy="0 0 0.25"/></xacro:lidar>',
    ),
    "no origin": (
        "front: {macro: lidar, parent: deck}",
        '<xacro:lidar prefix="front_" parent="deck"><origin xyz="0 0 0"/></xacro:lidar>',
    ),
    "an origin as raw XML": (
        "front: {macro: lidar, parent: deck, with: {origin: '<origin xyz=\"0 0 0.1\"/>'}}",
        '<xacro:lidar prefix="front_" parent="deck"><origin xyz="0 0 0.1"/></xacro:lidar>',
    ),
    "the parent in `with`": (
        "front: {macro: lidar, with: {parent: deck}, prefix: ''}",
        '<xacro:lidar parent="deck"><origin xyz="0 0 0"/></xacro:lidar>',
    ),
    "the prefix in `with`": (
        "front: {macro: lidar, parent: deck, with: {prefix: x_}}",
        '<xacro:lidar prefix="x_" parent="deck"><origin xyz="0 0 0"/></xacro:lidar>',
    ),
    "a place and a shape": (
        "a: {macro: wheel, parent: deck, prefix: '', with: {name: left, xyz: [0, 20 cm, 0], "
        "shape: '<sphere radius=\"0.1\"/>'}}",
        '<xacro:wheel name="left" parent="deck" xyz="0 0.2 0"><shape><sphere radius="0.1"/></shape></xacro:wheel>',
    ),
    "a place by parameters": (
        "a: {macro: camera, parent: deck, prefix: '', with: {xyz: [1, 0, 0], rpy: 0 0 0.5}}",
        '<xacro:camera parent_link="deck" xyz="1 0 0" rpy="0 0 0.5"/>',
    ),
    "an origin for parameters": (
        "a: {macro: camera, parent: deck, prefix: '', origin: {xyz: [1, 0, 0], rpy: [0, 0, 0.5]}}",
        '<xacro:camera parent_link="deck" xyz="1 0 0" rpy="0 0 0.5"/>',
    ),
    "a link of its own that is a parent": (
        "a: {macro: bracket, parent: deck, prefix: '', origin: [0, 0, 1], with: {name: mid}}",
        '<xacro:bracket name="mid" parent="deck"><origin xyz="0 0 1"/></xacro:bracket>',
    ),
    "several joints to the parent": (
        "a: {macro: bumpers, parent: deck, prefix: '', origin: [0, 20 cm, 0]}",
        '<xacro:bumpers parent="deck"><origin xyz="0 0.2 0"/></xacro:bumpers>',
    ),
    "a place further on": (
        "a: {macro: coupling, parent: deck, prefix: '', origin: [0, 20 cm, 0]}",
        '<xacro:coupling parent="deck"><origin xyz="0 0.2 0"/></xacro:coupling>',
    ),
    "an argument of the file": (
        "front: {macro: lidar, parent: deck, with: {color: [1, 0, 0, 1]}}",
        '<xacro:lidar prefix="front_" parent="deck"><origin xyz="0 0 0"/></xacro:lidar>',
    ),
    "a macro that calls another": (
        "front: {macro: mast, parent: deck, origin: [0, 0, 1]}",
        '<xacro:mast prefix="front_" parent="deck"><origin xyz="0 0 1"/></xacro:mast>',
    ),
}


@pytest.mark.parametrize(("module", "call"), MODULES_AND_CALLS.values(), ids=MODULES_AND_CALLS)
def test_a_module_is_what_xacro_makes_of_the_call(module: str, call: str, cell: Cell, folder: Path):
    parts = PARTS.replace('<link name="not_a_part_of_a_macro"/>', "")
    if "bracket" not in module:  # which alone has the material
        parts = parts.replace('<material name="steel"><color rgba="0.5 0.5 0.5 1"/></material>', "")
    parts = parts.replace(ROOT, f'{ROOT} name="cell"')
    parts = parts.replace("0.1 0.1 0.1 1", "1.0 0.0 0.0 1.0") if "color" in module else parts
    (folder / "expected.xacro").write_text(parts.replace("</robot>", f'<link name="deck"/>{call}</robot>'), "utf-8")
    command = [sys.executable, "-c", "import xacro; xacro.main()", "expected.xacro", "-o", "expected.urdf"]
    subprocess.run(command, cwd=folder, check=True)
    spec = import_urdf(folder / "expected.urdf").text
    assert spec
    (folder / "expected.robot.yaml").write_text(spec, "utf-8")
    made = cell(module)
    assert codes(made) == []
    assert not list(compare(compile_file(folder / "expected.robot.yaml").result(), made.result(), tolerance=0))


def test_a_macro_without_a_parent_is_attached_by_the_joint_of_its_entry(cell: Cell):
    robot = cell("hand: {macro: gripper, parent: deck, origin: [0, 0, 1], joint: wrist}").result()
    assert [link.name for link in robot.links] == ["deck", "hand_palm", "hand_finger"]  # no `hand__palm`
    wrist = next(joint for joint in robot.joints if joint.name == "wrist")
    assert (wrist.parent, wrist.child, wrist.origin.xyz.to_tuple()) == ("deck", "hand_palm", (0, 0, 1))
    slide = next(joint for joint in robot.joints if joint.name == "hand_slide")
    assert slide.limits
    assert slide.limits.upper == 0.08


def test_a_prefix_reaches_the_texts_of_plugins(cell: Cell):
    robot = cell("front: {macro: lidar, parent: deck}", "rear: {macro: lidar, parent: deck}").result()
    assert [link.name for link in robot.links] == ["deck", "front_laser", "rear_laser"]
    urdf = robot.export_urdf()
    assert "<topic>/front_scan</topic>" in urdf
    assert "<topic>/rear_scan</topic>" in urdf


def test_several_joints_to_the_parent_get_the_prefix(cell: Cell):
    robot = cell(
        "left: {macro: bumpers, parent: deck, override: {joints: {ring_joint: {limits: {upper: 2}}}}}",
        "right: {macro: bumpers, parent: left_ring}",
    ).result()
    ends = {joint.name: (joint.parent, joint.child) for joint in robot.joints}
    assert ends == {
        "left_pad_joint": ("deck", "left_pad"),
        "left_ring_joint": ("deck", "left_ring"),
        "left_tip_joint": ("left_ring", "left_tip"),
        "right_pad_joint": ("left_ring", "right_pad"),
        "right_ring_joint": ("left_ring", "right_ring"),
        "right_tip_joint": ("right_ring", "right_tip"),
    }
    assert [link.name for link in robot.links].count("deck") == 1
    upper = {joint.name: joint.limits.upper for joint in robot.joints if joint.limits}
    assert upper == {"left_ring_joint": 2, "right_ring_joint": 1}


@pytest.mark.parametrize(
    "entry",
    ["parent: rail_link, with: {name: front}", "with: {name: front, parent: rail}"],
    ids=["the whole name in `parent`", "as the macro takes it in `with`"],
)
def test_a_macro_may_compose_the_name_of_the_link_above(entry: str, folder: Path):
    spec = folder / "cell.robot.yaml"
    lines = f"modules: {{b: {{use: parts.xacro, macro: sonar, {entry}}}}}\n"
    spec.write_text(f"linkforge: 1\nname: cell\nlinks: {{rail_link: }}\n{lines}", "utf-8")
    joint = next(one for one in compile_file(spec).result().joints if one.name == "front_joint")
    assert (joint.parent, joint.child, joint.origin.xyz.z) == ("rail_link", "front_link", 0.1)


@pytest.mark.parametrize(
    ("entry", "links"),
    [
        ("", ["front_link", "front_cone", "front_post"]),
        ("with: {name: rear}", ["rear_link", "rear_cone", "rear_post"]),
        ("prefix: a_", ["a_link", "a_cone", "a_post"]),
        ("prefix: a_, with: {name: rear}", ["a_rear_link", "a_rear_cone", "a_rear_post"]),
        ("prefix: '', with: {name: rear}", ["rear_link", "rear_cone", "rear_post"]),
    ],
)
def test_a_name_with_which_all_names_begin_is_that_of_the_module(entry: str, links: list[str], folder: Path):
    parts = (folder / "parts.xacro").read_text("utf-8")
    post = """<xacro:macro name="station" params="name:=x parent">
      <xacro:sonar name="${name}" parent="${parent}"/>
      <link name="${name}_post"/>
      <joint name="${name}_post_joint" type="fixed"><parent link="${name}_link"/><child link="${name}_post"/></joint>
    </xacro:macro></robot>"""
    (folder / "parts.xacro").write_text(parts.replace("</robot>", post), "utf-8")
    spec = folder / "cell.robot.yaml"
    module = f"front: {{{', '.join(filter(None, ('use: parts.xacro, macro: station, parent: rail_link', entry)))}}}"
    spec.write_text(f"linkforge: 1\nname: cell\nlinks: {{rail_link: }}\nmodules: {{{module}}}\n", "utf-8")
    assert sorted(link.name for link in compile_file(spec).result().links) == sorted(["rail_link", *links])


def test_an_override_has_the_names_of_the_robot(cell: Cell):
    module = "front: {macro: lidar, parent: deck, override: {links: {front_laser: {inertial: {mass: 1}}}}}"
    laser = next(link for link in cell(module).result().links if link.name == "front_laser")
    assert laser.mass == 1


FAULTS = {
    "no such macro": ("a: {macro: lidr, parent: deck}", "LF8063", 5, "named 'lidr' here; did you mean 'lidar'?"),
    "no such parameter": ("a: {macro: lidar, parent: deck, with: {radus: 1}}", "LF3020", 5, "did you mean 'radius'?"),
    "a parameter is missing": (
        "a: {macro: sonar, parent: deck_link, prefix: ''}",
        "LF3021",
        5,
        "parameter 'name' of macro 'sonar' has no default and must be set; write 'with: {name: VALUE}'",
    ),
    "a block is missing": (
        "a: {macro: wheel, parent: deck, with: {xyz: 0 0 0, name: a}}",
        "LF3021",
        5,
        "block 'shape' of macro 'wheel' has no default and must be set; write 'with: {shape: '<…/>'}'",
    ),
    "a block is no XML": (
        "a: {macro: wheel, parent: deck, with: {xyz: 0 0 0, name: a, shape: <box}}",
        "LF8036",
        5,
        "block 'shape' of a macro takes raw XML, elements such as '<box …/>', found '<box'",
    ),
    "two parents": (
        "a: {macro: lidar, parent: deck, with: {parent: deck}}",
        "LF8037",
        5,
        "parameter 'parent' of the macro is 'parent' of module 'a', which is set; remove one of them",
    ),
    "two origins": (
        "a: {macro: lidar, parent: deck, origin: [0, 0, 1], with: {origin: {xyz: [0, 0, 2]}}}",
        "LF8037",
        5,
        "parameter 'origin' of the macro is 'origin' of module 'a', which is set; remove one of them",
    ),
    "two prefixes": (
        "a: {macro: lidar, parent: deck, with: {prefix: x}, prefix: y}",
        "LF8037",
        5,
        "parameter 'prefix' of the macro is 'prefix' of module 'a'",
    ),
    "a parent with another end": (
        "a: {macro: sonar, parent: deck, with: {name: a}}",
        "LF8046",
        5,
        "macro 'sonar' adds '_link' to its 'parent', so 'parent' is a link whose name ends in that, found 'deck'",
    ),
    "a macro for the inside of a link": (
        "a: {macro: heavy, parent: deck, with: {m: 1}}",
        "LF8047",
        5,
        "'heavy' creates no",
    ),
    "a macro that makes nothing": (
        "a: {macro: nothing, parent: deck, with: {m: 1}}",
        "LF8047",
        5,
        "'nothing' creates no",
    ),
    "several joints without a parent": ("a: {macro: bumpers}", "LF3021", 5, "'parent' of module 'a' has no default"),
    "a place of its own without a parent": (
        "a: {macro: wheel, with: {name: a, xyz: 1 0 0, shape: <sphere radius='1'/>}}",
        "LF3021",
        5,
        "'parent' of module 'a' has no default and must be set; write 'parent: LINK'",
    ),
    "several joints to no link": (
        "a: {macro: bumpers, parent: dek}",
        "LF4102",
        5,
        "no link named 'dek'; did you mean 'deck'?",
    ),
    "joints beside the entry's": (
        "a: {macro: bumpers, parent: deck, joint: weld}",
        "LF5324",
        5,
        "module 'a' has its own mount 'pad_joint'; remove 'joint', or write 'override: {joints: {pad_joint: …}}'",
    ),
    "an origin without effect": (
        "a: {macro: wheel, parent: deck, origin: [0, 0, 1], with: {name: a, xyz: 0 0 0, shape: <box size='1 1 1'/>}}",
        "LF8038",
        5,
        "macro 'wheel' sets its own position, so 'origin' has no effect",
    ),
}


@pytest.mark.parametrize(("module", "code", "line", "message"), FAULTS.values(), ids=FAULTS)
def test_a_fault_of_the_entry_is_reported_at_it(module: str, code: str, line: int, message: str, cell: Cell):
    compilation = cell(module)
    assert codes(compilation) == [(code, line)]
    assert message in compilation.diagnostics[0].message


def test_a_fault_in_a_macro_is_at_its_line_and_names_the_call(cell: Cell):
    (fault,) = cell("a: {macro: lidar, parent: deck, with: {radius: wide}}").diagnostics
    assert fault.span
    assert (fault.code.id, fault.span.file.path and fault.span.file.path.name) == ("LF8032", "parts.xacro")
    assert 'length="${radius * 1.2}"' in fault.span.file.text.splitlines()[fault.span.line - 1]
    assert [(note.message, note.span and note.span.line) for note in fault.notes] == [("used here", 5)]


def test_a_macro_that_needs_another_file_tells_the_way_out(cell: Cell):
    (fault,) = cell("a: {macro: clamp, parent: deck}").diagnostics
    assert fault.message.startswith("xacro has no macro named 'jaw' here")
    assert "write a xacro that includes both files" in fault.notes[0].message


def test_a_missing_file_is_told_at_its_name(folder: Path):
    spec = folder / "cell.robot.yaml"
    spec.write_text("linkforge: 1\nname: cell\nmodules:\n  a:\n    macro: lidar\n    use: part.xacro\n", "utf-8")
    assert codes(compile_file(spec)) == [("LF3001", 6)]


def test_what_the_user_writes_is_no_expression():
    call = MacroCall("wheel", {"name": "${1+1}$(arg x)$${y}", "xyz": "$5"}, ('<box size="${z}"/>',))
    assert call.request == {
        "macro": "wheel",
        "values": {"name": "$${1+1}$$(arg x)$$${y}", "xyz": "$5"},
        "blocks": ['<box size="\ufdd0{z}"/>'],
    }


@pytest.mark.parametrize("nothing", ["''", "[]", "'<!-- none -->'"])
def test_a_block_of_elements_may_be_empty(nothing: str, folder: Path):
    (folder / "blocks.xacro").write_text(
        f"""{ROOT}><xacro:macro name="one" params="*part"><link name="a"><xacro:insert_block name="part"/></link>
        </xacro:macro><xacro:macro name="any" params="**part"><link name="a"/><xacro:insert_block name="part"/>
        </xacro:macro></robot>""",
        "utf-8",
    )
    spec = folder / "cell.robot.yaml"
    text = f"linkforge: 1\nname: cell\nmodules: {{m: {{use: blocks.xacro, macro: any, with: {{part: {nothing}}}}}}}\n"
    spec.write_text(text, "utf-8")
    assert [link.name for link in compile_file(spec).result().links] == ["m_a"]
    spec.write_text(text.replace("any", "one"), "utf-8")
    assert codes(compile_file(spec)) == [("LF8036", 3)]


def of_pose(folder: Path, pose: str) -> Compilation:
    (folder / "pose.xacro").write_text(
        f"""{ROOT}><xacro:macro name="post" params="prefix *joint_pose"><link name="${{prefix}}a"/>
        <link name="${{prefix}}b"/><joint name="${{prefix}}j" type="fixed"><xacro:insert_block name="joint_pose"/>
        <parent link="${{prefix}}a"/><child link="${{prefix}}b"/></joint></xacro:macro></robot>""",
        "utf-8",
    )
    spec = folder / "cell.robot.yaml"
    entry = f"use: pose.xacro, macro: post, with: {{joint_pose: {pose}}}"
    spec.write_text(f"linkforge: 1\nname: cell\nvariables: {{h: 2 m}}\nmodules: {{a: {{{entry}}}}}\n", "utf-8")
    return compile_file(spec)


@pytest.mark.parametrize(
    ("pose", "origin"),
    [
        ("{xyz: [1, 20 cm, $(h)], rpy: [0, 0, 90 deg]}", '<origin xyz="1 0.2 2" rpy="0 0 1.5707963267948966"/>'),
        ("{xyz: [0, 0, 1]}", '<origin xyz="0 0 1" rpy="0 0 0"/>'),
        ("{rpy: [0, 0, 1]}", '<origin xyz="0 0 0" rpy="0 0 1"/>'),
    ],
)
def test_a_block_for_a_place_may_be_a_map(pose: str, origin: str, folder: Path):
    assert origin in of_pose(folder, pose).result().export_urdf()


@pytest.mark.parametrize(
    "pose", ["{xyz: [0, 0, 1 deg]}", "{xyz: [0, 0]}", "{xyz: [0, 0, true]}", "{xzy: [0, 0, 1]}", "{xyz: '0 0 1'}"]
)
def test_a_block_that_is_a_wrong_map_tells_what_a_place_is(pose: str, folder: Path):
    (fault,) = of_pose(folder, pose).diagnostics
    assert fault.code.id == "LF8036"
    assert "{xyz: [0, 0, 1 m], rpy: [0, 0, 90 deg]}" in fault.notes[0].message


def test_a_block_that_a_macro_passes_on_is_no_expression_either(folder: Path):
    (folder / "passed.xacro").write_text(
        f"""{ROOT}><xacro:macro name="inner" params="**more"><xacro:insert_block name="more"/></xacro:macro>
        <xacro:macro name="outer" params="**more"><link name="a"/>
        <xacro:inner><rest><xacro:insert_block name="more"/></rest></xacro:inner></xacro:macro></robot>""",
        "utf-8",
    )
    (folder / "texts.yaml").write_text("more: '<gazebo><cost>$$5 ${1 + 1} $(arg a)</cost></gazebo>'", "utf-8")
    spec = folder / "cell.robot.yaml"
    entry = "use: passed.xacro, macro: outer, with: {more: $(d.more)}"
    spec.write_text(f"linkforge: 1\nname: cell\ndata: {{d: texts.yaml}}\nmodules: {{a: {{{entry}}}}}\n", "utf-8")
    assert "<cost>$$5 ${1 + 1} $(arg a)</cost>" in compile_file(spec).result().export_urdf()


MAPPED = f"""{ROOT}>
<xacro:macro name="arm" params="sizes **more">
  <link name="${{sizes.name}}">
    <visual><geometry><sphere radius="${{sizes['ball']['radius'] + sizes.rows[1].add}}"/></geometry></visual>
    <xacro:insert_block name="more"/>
  </link>
  <gazebo><note>${{sizes.get('note', '')}}</note></gazebo>
</xacro:macro>
<xacro:arg name="color" default="red"/>
</robot>
"""


def of_map(folder: Path, given: str, note: str = "") -> Compilation:
    (folder / "mapped.xacro").write_text(MAPPED, "utf-8")
    sizes = {"name": "base", "ball": {"radius": "10 cm"}, "rows": [{"add": 1}, {"add": 0.5}], "note": note}
    (folder / "sizes.yaml").write_text(json.dumps(sizes), "utf-8")
    spec = folder / "cell.robot.yaml"
    entry = f"use: mapped.xacro, macro: arm, prefix: '', with: {{more: <a/>, {given}}}"
    spec.write_text(f"linkforge: 1\nname: cell\ndata: {{d: sizes.yaml}}\nmodules: {{a: {{{entry}}}}}\n", "utf-8")
    return compile_file(spec)


@pytest.mark.parametrize(
    "given", ["sizes: $(d)", "sizes: {name: base, ball: {radius: 10 cm}, rows: [{add: 1}, {add: 0.5}]}"]
)
def test_a_parameter_may_be_a_map_as_from_load_yaml(given: str, folder: Path):
    (link,) = of_map(folder, given).result().links
    assert link.name == "base"
    assert '<sphere radius="0.6"' in of_map(folder, given).result().export_urdf()


@pytest.mark.parametrize("text", ["${1 + 1} $(arg color)", "}", "a'b\\", "é\\n$$"])
def test_texts_in_a_map_are_no_expressions(text: str, folder: Path):
    robot = of_map(folder, "sizes: $(d)", note=text).result()
    assert f"<note>{text}</note>" in robot.export_urdf()


def test_a_material_of_a_file_that_is_included_twice_comes_once(folder: Path):
    (folder / "colors.xacro").write_text(f'{ROOT}><material name="steel"><color rgba="1 0 0 1"/></material></robot>')
    twice = '<xacro:include filename="colors.xacro"/>' * 2
    (folder / "all.xacro").write_text(
        f"""{ROOT}>{twice}<xacro:macro name="ball" params="name"><link name="${{name}}">
        <visual><geometry><sphere radius="1"/></geometry><material name="steel"/></visual></link>
        </xacro:macro></robot>"""
    )
    spec = folder / "cell.robot.yaml"
    spec.write_text("linkforge: 1\nname: cell\nmodules: {a: {use: all.xacro, macro: ball}}\n", "utf-8")
    made = compile_file(spec)
    assert codes(made) == []
    assert [*made.result().materials] == ["steel"]


def test_an_argument_of_the_file_is_no_map(folder: Path):
    assert codes(of_map(folder, "sizes: $(d), color: {a: 1}")) == [("LF8033", 4)]


def test_macros_are_not_expanded_where_that_is_forbidden(cell: Cell, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LINKFORGE_NO_XACRO", "1")
    assert codes(cell("a: {macro: lidar, parent: deck}")) == [("LF8035", 5)]


def test_params_lists_macros(folder: Path):
    done = linkforge("params", "parts.xacro", cwd=folder)
    assert done.returncode == 0, done.stderr
    blocks = done.stdout.split("\n\n")
    lidar = next(block for block in blocks if block.startswith("macro lidar")).splitlines()
    assert [line.split() for line in lidar[1:]] == [
        ["prefix", "string", "(the", "module's", "prefix)"],
        ["parent", "string", "(the", "module's", "parent)"],
        ["origin", "XML", "(the", "module's", "origin)"],
        ["radius", "string", "0.035"],
    ]
    wheel = next(block for block in blocks if block.startswith("macro wheel")).splitlines()
    assert [line.split()[2:] for line in wheel[1:]] == [
        ["(the", "module's", "prefix)"],
        ["(the", "module's", "parent)"],
        ["(required)"],
        ["(required)"],
    ]
    camera = next(block for block in blocks if block.startswith("macro camera")).splitlines()
    assert [line.split()[-1] for line in camera[1:]] == ["parent)", "origin)", "origin)"]
    assert any(block.startswith("macro disc") for block in blocks)
    listed = json.loads(linkforge("params", "parts.xacro", "--json", cwd=folder).stdout)["macros"]
    (lidar_parameters,) = (one["parameters"] for one in listed if one["name"] == "lidar")
    fields = {"prefix": "prefix", "parent": "parent", "origin": "origin", "radius": None}
    assert {one["name"]: one["field"] for one in lidar_parameters} == fields


@pytest.mark.parametrize("calls", [1, 2])
def test_macros_that_call_one_another_deep_and_often_are_listed_at_once(calls: int, folder: Path):
    macros = "".join(
        f'<xacro:macro name="m{i}" params="name parent">'
        + "".join(f'<xacro:m{i + 1} name="${{name}}_{j}" parent="${{parent}}_{j}"/>' for j in range(calls))
        + "</xacro:macro>"
        for i in range(2000 // calls)
    )
    (folder / "deep.xacro").write_text(f"{ROOT}>{macros}</robot>", "utf-8")
    done = linkforge("params", "deep.xacro", cwd=folder)
    assert (done.returncode, done.stdout.count("macro m")) == (0, 2000 // calls)


def test_deps_lists_the_files_of_a_macro(folder: Path, cell: Cell):
    cell("a: {macro: lidar, parent: deck}")
    done = linkforge("deps", "cell.robot.yaml", "--format", "json", cwd=folder)
    assert '"parts.xacro"' in done.stdout
    assert "inertia.xacro" in done.stdout


NAMES = st.from_regex(r"[a-z_]{1,4}", fullmatch=True)
DEFAULTS = st.sampled_from(["", "0", "'a b'", '"x"', "${2 * r}", "$(arg a b)", "a-b", "'${a b}'"])
PARAMETERS = st.one_of(
    NAMES,
    st.builds("{}{}".format, st.sampled_from(["*", "**"]), NAMES),
    st.builds("{}{}{}".format, NAMES, st.sampled_from([":=", "="]), DEFAULTS.filter(bool)),
    st.builds("{}:=^".format, NAMES),
    st.builds("{}:=^|{}".format, NAMES, DEFAULTS.filter(bool)),
)


@given(st.lists(PARAMETERS, max_size=5), st.sampled_from([" ", "  "]))
def test_parameters_are_read_as_xacro_reads_them(written: list[str], blank: str):
    rest, expected = blank.join(written), []
    while rest.strip():
        name, value, rest = xacro.parse_macro_arg(rest)
        forward, default = value or (None, None)
        expected.append((name, forward is not None, default))
    found = [
        ((one.block or "") + one.name, one.is_forwarded, one.default) for one in parameters_in(blank.join(written))
    ]
    unquoted = [
        (name, forward, default[1:-1] if default and default[0] == default[-1] and default[0] in "'\"" else default)
        for name, forward, default in expected
    ]
    assert found == unquoted


def test_macros_of_a_namespace_have_its_name(folder: Path):
    (folder / "all.xacro").write_text(f'{ROOT}><xacro:include filename="parts.xacro" ns="lib"/></robot>', "utf-8")
    library = read_library(folder / "all.xacro", Loader(), Diagnostics())
    assert library
    assert "lib.lidar" in library.macros


def test_a_file_is_included_once_in_each_namespace(folder: Path):
    uses = '<xacro:include filename="parts.xacro"/><xacro:include filename="parts.xacro" ns="lib"/>'
    (folder / "all.xacro").write_text(f"{ROOT}>{uses}</robot>", "utf-8")
    spec = folder / "cell.robot.yaml"
    entry = "use: all.xacro, macro: lib.lidar, parent: deck, with: {radius: 2}"
    spec.write_text(f"linkforge: 1\nname: cell\nlinks: {{deck: }}\nmodules: {{a: {{{entry}}}}}\n", "utf-8")
    assert [link.name for link in compile_file(spec).result().links] == ["deck", "a_laser"]


def test_a_macro_of_a_namespace_calls_those_beside_it(folder: Path):
    (folder / "prefixed.xacro").write_text(
        f"""{ROOT}><xacro:macro name="inner" params="prefix"><link name="${{prefix}}_a"/></xacro:macro>
        <xacro:macro name="outer" params="prefix"><xacro:inner prefix="${{prefix}}"/></xacro:macro></robot>""",
        "utf-8",
    )
    other = '<xacro:macro name="inner" params="prefix"><link name="b"/></xacro:macro>'
    include = '<xacro:include filename="prefixed.xacro" ns="lib"/>'
    (folder / "all.xacro").write_text(f"{ROOT}>{include}{other}</robot>", "utf-8")
    done = linkforge("params", "all.xacro", cwd=folder)
    outer = next(block for block in done.stdout.split("\n\n") if block.startswith("macro lib.outer"))
    assert "(the module's prefix)" in outer


@pytest.mark.parametrize("names", [("x", "x"), ("x", "y")])
def test_files_that_include_one_another_in_namespaces_come_to_an_end(names: tuple[str, str], folder: Path):
    count = 30
    for number in range(count):
        uses = "".join(f'<xacro:include filename="{(number + 1) % count}.xacro" ns="{name}"/>' for name in names)
        (folder / f"{number}.xacro").write_text(
            f'{ROOT}>{uses}<xacro:macro name="m" params=""><link name="a"/></xacro:macro></robot>', "utf-8"
        )
    library = read_library(folder / "0.xacro", Loader(), Diagnostics())
    assert library
    assert {".".join("x" * depth + "m") for depth in range(count)} <= {*library.macros}
    assert any("more than 500 files" in one.message for one in library.notes) == (names == ("x", "y"))


@pytest.mark.parametrize("params", ["a:=" + "${}" * 5_000 + "'", "a:=" + "${" * 50_000, "a:=" + "'b'" * 50_000 + '"'])
def test_hostile_parameters_are_read_in_linear_time(params: str):
    start = time.perf_counter()
    assert parameters_in(params)[0].name == "a"
    assert time.perf_counter() - start < 5
