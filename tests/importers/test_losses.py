"""No loss is silent: an import compares what its spec compiles to with the file."""

import random
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from types import SimpleNamespace

import pytest
from lxml import etree

import linkforge_compile.importing
from linkforge_compile import compile_text, import_urdf, render_urdf
from linkforge_compile.cli.main import main
from linkforge_compile.diagnostics import Diagnostics, sink
from linkforge_compile.formats import URDF
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.losses import losses
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlDocument

ROBOT = """\
<robot name="r">
  <material name="red"><color rgba="1 0 0 1"/></material>
  <link name="a">
    <visual><origin xyz="0 0 0.5"/><geometry><box size="1 1 1"/></geometry><material name="red"/></visual>
    <collision><geometry><sphere radius="0.10"/></geometry></collision>
  </link>
  <link name="b" type="tool"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/></joint>
  <gazebo reference="b"><serial>007</serial></gazebo>
</robot>
"""


def document(text: str) -> XmlDocument:
    read = read_xml(SourceFile("r.urdf", text), Diagnostics())
    assert read
    return read


def losses_of(before: str, after: str) -> list[str]:
    assert before in ROBOT
    return [str(one) for one in losses(document(ROBOT), document(ROBOT.replace(before, after)))]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('<origin xyz="0 0 0.5"/>', '<origin rpy="0 -0 0.0" xyz="0.0 0 5e-1"/>'),
        ('<collision><geometry><sphere radius="0.10"/>', '<collision><origin/><geometry><sphere radius=".1"/>'),
        ('<axis xyz="1 0 0"/>', ""),
        ('<material name="red"/>', '<material name="red"><color rgba="1 0 0 1.0"/></material>'),
        ('<parent link="a"/><child link="b"/>', '<child link="b"/>\n<parent link="a"/>'),
    ],
)
def test_another_spelling_is_no_loss(before: str, after: str):
    assert losses_of(before, after) == []


@pytest.mark.parametrize(
    ("before", "after", "loss"),
    [
        ('<gazebo reference="b"><serial>007</serial></gazebo>', "",
         "9:3: warning: the spec does not reproduce <gazebo> 'b' [LF8190]"),
        (' type="tool"', "", "7:24: warning: the spec does not reproduce 'type' of <link> [LF8190]"),
        ("007", "7", "9:25: warning: the text of <serial> is '007' here, but the spec compiles to '7' [LF8191]"),
        ("0 0 0.5", "0 0 0.50000000001",
         "4:26: warning: 'xyz' of <origin> is '0 0 0.5' here, but the spec compiles to '0 0 0.50000000001'"
         " [LF8191]"),
        ('link="b"/><axis', 'link="b1"/><axis',
         "8:68: warning: 'link' of <child> is 'b' here, but the spec compiles to 'b1' [LF8191]"),
        ('<material name="red"/>', "", "4:76: warning: the spec does not reproduce <material> 'red' [LF8190]"),
        ('<color rgba="1 0 0 1"/>', '<color rgba="1 0 0 0.5"/>',
         "2:37: warning: 'rgba' of <color> is '1 0 0 1' here, but the spec compiles to '1 0 0 0.5' [LF8191]"),
        ('<link name="b" type="tool"/>', '<link name="b" type="tool"><inertial/></link>',
         "7:3: warning: the spec adds <inertial>, which is not in this file [LF8192]"),
    ],
)  # fmt: skip
def test_a_difference_is_reported_at_its_place(before: str, after: str, loss: str):
    assert f"r.urdf:{loss}" in losses_of(before, after)


LINK = '<link name="a">{}</link>'
BALL = '<geometry><sphere radius="1"/></geometry>'
PAINT = '<material name="red"><color rgba="{} 0 0 1"/></material>'
OWN, OTHER = PAINT.format(1), PAINT.format(0.5)


LOOKED, TOUCHED = f"<visual>{BALL}</visual>", f"<collision>{BALL}</collision>"
PAINTED, NAMED = f"<visual>{BALL}{OTHER}</visual>", f'<visual>{BALL}<material name="red"/></visual>'


@pytest.mark.parametrize(
    ("was", "now", "expected"),
    [
        (LINK.format(PAINTED + TOUCHED), LINK.format(TOUCHED + PAINTED), ["1:147 LF8140"]),
        # The tags stand as they stood.
        (LINK.format(LOOKED + TOUCHED + PAINTED + TOUCHED), LINK.format(PAINTED + TOUCHED + LOOKED + TOUCHED),
         ["1:32 LF8140"]),
        (LINK.format(LOOKED + TOUCHED), LINK.format(TOUCHED + LOOKED), []),
        (LINK.format(TOUCHED + PAINTED + LOOKED), LINK.format(TOUCHED + PAINTED + LOOKED), []),
        (LINK.format(PAINTED + NAMED + NAMED) + OWN, OWN + LINK.format(PAINTED + NAMED + NAMED), ["1:196 LF8141"]),
        (LINK.format(PAINTED) + OWN, OWN + LINK.format(PAINTED), []),
    ],
)  # fmt: skip
def test_an_order_is_a_loss_where_mujoco_shows_another_color(was: str, now: str, expected: list[str]):
    one, other = (document(f'<robot name="r">{text}</robot>') for text in (was, now))
    found = [(loss.span.start, loss.code.id) for loss in losses(one, other)]
    assert [f"{start.line}:{start.column} {code}" for start, code in found] == expected


def test_a_color_changed_by_raw_xml_is_reported():
    """The tags of these shapes come out in the order in which they stood."""
    two_shapes = BALL.replace("/></", '/><box size="1 1 1"/></')
    raw = f"<visual>{two_shapes}</visual>"
    green = PAINTED.replace("0.5 0 0", "0 1 0")
    text = f'<robot name="r">{LINK.format(raw + raw.replace("visual", "collision") + green + TOUCHED)}</robot>'
    assert "LF8140" in {loss.code.id for loss in import_urdf("r.urdf", text=text).losses}


def test_a_zero_rpy_with_a_quaternion_is_a_loss():
    """urdfdom refuses an origin that has both."""
    origin = '<origin xyz="0 0 0.5"/>'
    turned = ROBOT.replace(origin, '<origin xyz="0 0 0.5" quat_xyzw="0 0 0 1"/>')
    doubled = ROBOT.replace(origin, '<origin xyz="0 0 0.5" rpy="0 0 0" quat_xyzw="0 0 0 1"/>')
    (loss,) = losses(document(turned), document(doubled))
    assert "'rpy' of <origin>" in str(loss)


def test_many_that_differ_are_compared_in_steps_that_grow_with_them():
    def steps(count: int) -> int:
        links = "".join(f'<link name="l{i}">{{}}</link>' for i in range(count))
        before, after = (document(f'<robot name="r">{links.replace("{}", text)}</robot>') for text in ("", "stray"))
        taken = 0

        def step(*_: object) -> None:
            nonlocal taken
            taken += 1

        sys.setprofile(step)
        try:
            assert sum(1 for _ in losses(before, after)) == count
        finally:
            sys.setprofile(None)
        return taken

    assert steps(400) < 9 * steps(50), "eight times as many take up to 64 times as many where each looks for its own"


def test_one_of_two_alike_is_missed():
    twice = document('<robot name="r"><gazebo><a/></gazebo><gazebo><a/></gazebo></robot>')
    once = document('<robot name="r"><gazebo><a/></gazebo></robot>')
    assert [str(one) for one in losses(twice, once)] == [
        "r.urdf:1:38: warning: the spec does not reproduce <gazebo> [LF8190]"
    ]


def test_what_a_reader_forgets_is_a_loss_and_strict_fails(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
):
    def forgetful(reader: ElementReader) -> dict[str, object]:
        return {}

    monkeypatch.setattr(ElementReader, "extras", forgetful)
    urdf = tmp_path / "r.urdf"
    urdf.write_text(ROBOT, "utf-8")
    assert [one.code.id for one in import_urdf(urdf).losses] == ["LF8190"]
    assert main(["import", str(urdf), "--strict"]) == 1
    assert "the spec does not reproduce 'type' of <link>" in capfd.readouterr().err


def test_a_loss_that_is_only_counted_is_counted_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setattr(sink, "MAX_KEPT", 2)
    urdf = tmp_path / "r.urdf"
    shapes = '<visual>stray<geometry><sphere radius="1"/></geometry></visual>\n' * 5
    urdf.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>', "utf-8")
    *losses, more = import_urdf(urdf).diagnostics
    assert [one.code.id for one in losses] == ["LF8101"] * 2
    assert more.message.startswith("3 more")


def test_what_the_text_of_the_spec_does_not_say_is_a_loss(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    from linkforge_compile.syntax import writer

    write: Callable[..., str] = writer.write
    monkeypatch.setattr(writer, "write", lambda *words: write(*words).replace("type: tool", "type: tol"))
    urdf = tmp_path / "r.urdf"
    urdf.write_text(ROBOT, "utf-8")
    assert [str(one) for one in import_urdf(urdf).losses] == [
        f"{urdf}:7:24: warning: 'type' is 'tool' here, but the spec compiles to 'tol' [LF8191]"
    ]


def test_an_srdf_is_compared_as_well(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    empty_group = SimpleNamespace(text=lambda robot: '<robot name="r"><group name="g"/></robot>')
    monkeypatch.setattr(linkforge_compile.importing, "_IMPORTED", (URDF, empty_group))
    urdf, srdf = tmp_path / "r.urdf", tmp_path / "r.srdf"
    urdf.write_text(ROBOT, "utf-8")
    srdf.write_text('<robot name="r"><group name="g"><link name="a"/></group></robot>', "utf-8")
    assert [str(one) for one in import_urdf(urdf, srdf=srdf).losses] == [
        f"{srdf}:1:33: warning: the spec does not reproduce <link> 'a' [LF8190]"
    ]


@pytest.mark.parametrize(
    "part",
    [
        '<link name="a"><visual><geometry><sphere radius="1">text</sphere></geometry></visual></link>',
        '<link name="a"/><gazebo reference="a"><material>Gazebo/Red<material name="blue"/></material></gazebo>',
        '<link name="a"/><gazebo reference="a"><big>1e400</big></gazebo>',
    ],
)
def test_former_losses_are_kept_or_reported(tmp_path: Path, part: str):
    urdf = tmp_path / "r.urdf"
    urdf.write_text(f'<robot name="r">{part}</robot>', "utf-8")
    read = import_urdf(urdf)
    assert read.text is not None
    again = document(render_urdf(compile_text(read.text).result()))
    assert bool(read.losses) == bool(list(losses(document(urdf.read_text("utf-8")), again)))
    assert all(one.code.id == "LF8101" for one in read.losses)


VALUES = [
    "",
    "0",
    "-1",
    "1e400",
    "nan",
    "0 0",
    "0 0 0",
    "0 0 2",
    "007",
    "1.10",
    "tool",
    "elbow",
    "$(x)",
    "  3 ",
    "90 deg",
]
TAGS = ["origin", "surface", "mesh", "axis", "limit", "param"]

EVERYTHING = dedent("""\
    <robot name="r" version="1.2">
      <material name="red"><color rgba="1 0 0 1"/></material>
      <link name="base">
        <inertial><origin xyz="0 0 0.1"/><mass value="2"/>
          <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
        <visual name="v"><origin xyz="0 0 0.2"/><geometry><box size="1 1 1"/></geometry><material name="red"/></visual>
        <visual><geometry><mesh filename="package://p/a.stl"/></geometry><material name="blue">
          <color rgba="0 0 1 1"/><texture filename="a.png"/></material></visual>
        <collision><geometry><sphere radius="1"/></geometry></collision>
        <collision><geometry><capsule radius="1" length="2"/></geometry></collision>
      </link>
      <link name="arm"><visual><geometry><box size="1 1 1"/></geometry><material name="blue"/></visual></link>
      <link name="cart"/>
      <link name="tool"/>
      <joint name="elbow" type="revolute"><origin xyz="0 0 1" rpy="0 1.5707963267948966 0"/>
        <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="10" velocity="2"/><dynamics damping="0.1" friction="0.2"/>
        <safety_controller soft_lower_limit="-0.5" k_position="10" k_velocity="20"/><calibration rising="0.1"/></joint>
      <joint name="slide" type="prismatic"><parent link="arm"/><child link="cart"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="1" effort="10" velocity="2"/><mimic joint="elbow" multiplier="2" offset="0.1"/></joint>
      <joint name="tool_joint" type="fixed"><parent link="cart"/><child link="tool"/></joint>
      <transmission name="t"><type>transmission_interface/SimpleTransmission</type>
        <joint name="elbow"><hardwareInterface>position</hardwareInterface></joint>
        <actuator name="m"><hardwareInterface>effort</hardwareInterface>
          <mechanicalReduction>50</mechanicalReduction></actuator></transmission>
      <ros2_control name="h" type="system"><hardware><plugin>a/B</plugin><param name="x">1</param></hardware>
        <joint name="elbow"><command_interface name="position"><param name="min">-1</param></command_interface></joint>
        <sensor name="s"><state_interface name="force"/><param name="frame">tool</param></sensor></ros2_control>
      <gazebo reference="arm"><mu1>0.2</mu1><material>Gazebo/Red</material><selfCollide>true</selfCollide></gazebo>
      <gazebo><plugin name="p" filename="p.so"><a>1</a><b x="2">3</b></plugin></gazebo>
    </robot>""")


def damage(robot: etree._Element, chance: random.Random) -> None:
    """Do to a URDF what an editor, a converter or a tired person does to it."""
    one = chance.choice(list(robot.iter()))
    names = list(one.attrib)
    match chance.randrange(6):
        case 0 if names:
            del one.attrib[chance.choice(names)]
        case 1 if names:
            one.set(chance.choice(names), chance.choice(VALUES))
        case 2:
            one.set("extra", chance.choice(VALUES))
        case 3 if one is not robot:
            one.addnext(etree.fromstring(etree.tostring(one, with_tail=False)))
        case 4:
            one.append(etree.Element(chance.choice(TAGS)))
        case _:
            one.text = (one.text or "") + chance.choice(VALUES)


@pytest.mark.parametrize("seed", range(3))
def test_a_mutated_urdf_comes_out_the_same_or_is_reported(seed: int, shared: Path, tmp_path: Path):
    """An independent judge finds no loss where the import tells none."""
    judge = runpy.run_path(str(shared / "tools" / "urdf_equiv.py"))["semantic"]
    chance, urdf = random.Random(seed), tmp_path / "r.urdf"
    silent, compared = [], 0
    for _ in range(30):
        robot = etree.fromstring(EVERYTHING)
        damage(robot, chance)
        urdf.write_bytes(etree.tostring(robot))
        read = import_urdf(urdf)
        if read.text is None or read.has_errors or read.losses:
            continue
        compilation = compile_text(read.text)
        compared += 1
        ours = etree.fromstring(render_urdf(compilation.result()).encode())
        # What stands in the material of a visual comes out in that of the robot, which the judge does not look into.
        silent += [one for one in judge(robot, ours).fatal if "/material[" not in one["path"]]
    assert not silent
    assert compared > 15
