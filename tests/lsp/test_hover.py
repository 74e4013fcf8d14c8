"""What an editor shows of a position: parts, values and their origins, names, and the meaning of keys."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.editor import Editor, split_at_cursor

EXAMPLES = Path(__file__).parents[2] / "examples"
TWO_LINKS = EXAMPLES / "01_two_link_arm" / "two_link_arm.robot.yaml"
ARM = EXAMPLES / "02_ur5e" / "ur5e_arm.robot.yaml"
TWO_ARMS = EXAMPLES / "03_two_ur5e" / "two_ur5e.robot.yaml"
LEG = EXAMPLES / "07_quadruped" / "leg.robot.yaml"
QUADRUPED = EXAMPLES / "07_quadruped" / "quadruped.robot.yaml"
MOBILE = EXAMPLES / "09_mobile_manipulator" / "mobile_manipulator.robot.yaml"
VENDOR = EXAMPLES / "10_vendor_robots" / "vendor_robots.robot.yaml"


@pytest.fixture(scope="module")
def shared() -> Iterator[Editor]:
    """A server for all positions in the examples."""
    with Editor(EXAMPLES) as editor:
        yield editor


def hover(editor: Editor, path: Path, marked: str) -> str:
    """Return what is shown at the ¦ of a text."""
    text, position = split_at_cursor(marked)
    params = types.HoverParams(editor.open(path, text), position)
    found = editor.ask(lambda client: client.text_document_hover_async(params))
    if found is None:
        return ""
    assert isinstance(found.contents, types.MarkupContent)
    assert found.contents.kind == types.MarkupKind.Markdown
    return found.contents.value


def at(path: Path, marked: str) -> str:
    """Return the text of an example with the ¦ where `marked` has it."""
    text = path.read_text("utf-8")
    assert text.count(marked.replace("¦", "")), marked
    return text.replace(marked.replace("¦", ""), marked, 1)


@pytest.mark.parametrize(
    ("path", "marked", "shown"),
    [
        # Keys
        (TWO_LINKS, "lin¦ks:", ["**links**", "The rigid bodies."]),
        (TWO_LINKS, "cyl¦inder: {", ["**cylinder**", "radius"]),
        (ARM, "effo¦rt: 150 N*m", ["**effort**", "Maximum torque [N*m] or force [N]. Required."]),
        (ARM, "mass¦: 4", ["`4 kg`", "**mass**: a number [kg] or a quantity such as '3 kg'"]),
        (MOBILE, "u¦se: ../06", ["**use**", "`package://NAME/…`"]),
        (LEG, "damp¦ing: 0.01", ["**damping**", "Viscous damping [N*m*s/rad]"]),
        (LEG, "type: revo¦lute\n    axis: y", ["Turns about its axis between two limits.", "`prismatic`: Slides"]),
        # Values
        (TWO_LINKS, "cylinder: {radius: 8¦0 mm", ["`80 mm` = `0.08 m`"]),
        (TWO_LINKS, "[0, 0, $(ha¦lf / 2)]", ["half is 0.4 m, the variable $(reach / 2) at", "the default 0.8 m at"]),
        (TWO_LINKS, "[0, 0, ¦$(half / 2)]", ["`0.2 m`", "computed: $(half / 2)"]),
        (TWO_ARMS, "rpy: [$(-t¦ilt), 0", ["tilt is 45 deg, the default 45 deg at two_ur5e.robot.yaml:16:14"]),
        (TWO_ARMS, "rpy: [¦$(-tilt), 0", ["`-0.7853981633974483 rad`", "tilt is 45 deg"]),
        (LEG, "limits: {lower: -6¦0 deg", ["`-60 deg` = `-1.0471975511965976 rad`"]),
        (QUADRUPED, "upda¦te_rate", ["**update_rate**", "30 Hz by default"]),
        (VENDOR, "lower: -9¦0 deg", ["`-90 deg` = `-1.5707963267948966 rad`", "instead of what is written at"]),
        # Parts
        (TWO_LINKS, "  upp¦er:\n    visual", ["**link `upper`**", "mass ", "computed from the density", "`shoulder`"]),
        (TWO_LINKS, "  should¦er:", ["**revolute joint `shoulder`**", "axis [0, 1, 0]", "base\n└─ upper  (shoulder"]),
        (TWO_LINKS, "child: upp¦er", ["**link `upper`**", "The link that it moves"]),
        (TWO_LINKS, "material: st¦eel", ["**material `steel`**", "color: [0.6, 0.6, 0.65]"]),
        (ARM, "parent: fore¦arm_link", ["**link `forearm_link`**", "**link `left_forearm_link`**", "right_"]),
        (TWO_ARMS, "left_shoul¦der_link: Never", ["**link `left_shoulder_link`**", "mass 3.761 kg"]),
        (TWO_ARMS, "      ho¦me: {left_ur", ["**state `both_arms/home`**", "left_elbow_joint: "]),
        (TWO_ARMS, "subgroups: [left_ur_ma¦nipulator", ["**group `left_ur_manipulator`**"]),
        (TWO_ARMS, "  le¦ft:", ["**module `left`**", "ur5e_arm.robot.yaml`", "prefix `left_`", "links, "]),
        (MOBILE, "ba¦se:   ", ["**module `base`**", "no prefix", "with `length: 0.9 m`"]),
        (MOBILE, "parent: $(side.name)_tool0¦ ", ["`left_tool0`", "`right_tool0`"]),
        (VENDOR, "  ar¦m:\n", ["**module `arm`**", "ur5e.urdf", "prefix `arm_`"]),
        (VENDOR, "parent: arm_to¦ol0", ["**link `arm_tool0`**", "parent `arm_flange`"]),
        (VENDOR, "        shoulder_pan_jo¦int:", ["**revolute joint `arm_shoulder_pan_joint`**", "(`-90 deg`)"]),
        (QUADRUPED, "link: tru¦nk", ["**link `trunk`**", "`front_left_hip_joint` to `front_left_hip`"]),
        # Names of expressions
        (TWO_LINKS, "  rea¦ch:\n", ["**parameter `reach`**", "- length", "at least 0.2 m", "Shoulder to tool"]),
        (TWO_LINKS, "  ha¦lf:", ["**variable `half`**", "half is 0.4 m"]),
        (MOBILE, "wheel_ef¦fort: 40", ["**parameter `wheel_effort`** of", "wheel_effort is 40 N*m, 'with' 40 N*m at"]),
        (LEG, "$(ac¦os(", ["function `acos("]),
        (LEG, "(2 * seg¦ment)", ["segment is 0.21 m"]),
        # Nothing
        (TWO_LINKS, "# Lesson¦ 1", []),
        (TWO_LINKS, "\n¦\nvariables:", []),
    ],
)
def test_positions_in_the_examples(shared: Editor, path: Path, marked: str, shown: list[str]):
    found = hover(shared, path, at(path, marked))
    shared.open(path)
    for text in shown:
        assert text in found, found
    assert bool(found) == bool(shown), found


ARM_TEXT = """\
linkforge: 1
name: arm
parameters: {strength: {type: torque, default: 50 N*m}}
links:
  base: {}
  tip: {}
joints:
  elbow: {type: revolute, parent: base, child: tip, axis: z, limits: {effort: $(strength), velocity: 60 deg/s}}
"""
CELL_TEXT = """\
linkforge: 1
name: cell
links:
  world: {}
modules:
  left: {use: arm.robot.yaml, parent: world}
  right: {use: arm.robot.yaml, parent: world, with: {strength: 60 N*m}}
  old: {use: old.urdf, parent: world}
"""
URDF_TEXT = """\
<robot name="old"><link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/>
</joint></robot>
"""


@pytest.fixture
def cell(editor: Editor, tmp_path: Path) -> Path:
    """A cell of two arms and a URDF, open in the editor with the arm."""
    for name, text in (("arm.robot.yaml", ARM_TEXT), ("cell.robot.yaml", CELL_TEXT), ("old.urdf", URDF_TEXT)):
        (tmp_path / name).write_text(text)
    editor.open(tmp_path / "cell.robot.yaml")
    editor.open(tmp_path / "arm.robot.yaml")
    return tmp_path


def test_a_value_is_shown_for_each_use_of_its_file(editor: Editor, cell: Path):
    found = hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("effort", "eff¦ort"))
    assert "`joints/elbow/limits/effort`, `joints/left_elbow/limits/effort`: `50 N*m`" in found
    assert "`joints/right_elbow/limits/effort`: `60 N*m`" in found
    assert "strength is 60 N*m, 'with' 60 N*m at cell.robot.yaml:7:64\n    instead of the default 50 N*m" in found


def test_the_parts_of_a_urdf_are_shown(editor: Editor, cell: Path):
    found = hover(editor, cell / "cell.robot.yaml", CELL_TEXT.replace("  old:", "  o¦ld:"))
    assert "uses `old.urdf`\n- prefix `old_`\n- 2 links, 1 joint" in found


def test_the_parameter_of_a_macro_is_shown(editor: Editor, tmp_path: Path):
    macro = '<xacro:macro name="leg" params="prefix side:=left"><link name="${prefix}foot"/></xacro:macro>'
    (tmp_path / "leg.xacro").write_text(f'<robot name="m" xmlns:xacro="http://www.ros.org/wiki/xacro">{macro}</robot>')
    entry = "{use: leg.xacro, macro: leg, parent: base, with: {si¦de: right}}"
    text = f"linkforge: 1\nname: cart\nlinks: {{base: }}\nmodules:\n  leg: {entry}\n"
    assert hover(editor, tmp_path / "cart.robot.yaml", text).endswith("- string\n- default `left`")


def test_a_joint_is_shown_in_its_tree(editor: Editor, cell: Path):
    found = hover(editor, cell / "cell.robot.yaml", CELL_TEXT.replace("parent: world}", "parent: wor¦ld}", 1))
    assert "joint `left_joint` to `left_base`\n- joint `right_joint` to `right_base`" in found
    found = hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("elbow", "el¦bow"))
    assert "world\n└─ left_base  (left_joint, fixed)\n   └─ left_tip  (left_elbow, revolute)  ◄" in found
    assert "velocity 1.0472 rad/s (`60 deg/s`)" in found


@pytest.mark.parametrize(
    ("slip", "marked", "facts"),
    [
        (("base: {}", "base: {inertial: {mass: 2 kgg}}"), "ba¦se:", ("the root", "kg")),
        (("60 deg/s", "60 dge/s"), "el¦bow:", ("from `base` to `tip`", "rad/s")),
        (("axis: z", "axis: q"), "el¦bow:", ("from `base` to `tip`", "axis [")),
    ],
)
def test_values_that_cannot_be_read_have_none_in_their_place(
    editor: Editor, cell: Path, slip: tuple[str, str], marked: str, facts: tuple[str, str]
):
    text = ARM_TEXT.replace(*slip).replace(marked.replace("¦", ""), marked)
    found, (shown, hidden) = hover(editor, cell / "arm.robot.yaml", text).partition("\n\n---")[0], facts
    assert shown in found
    assert "values are shown once the errors in it are mended" in found
    assert hidden not in found


def test_values_that_a_wrong_argument_would_make_have_none_in_their_place(editor: Editor, cell: Path):
    text = CELL_TEXT.replace("strength: 60 N*m", "strength: 60 kg").replace("world: {}", "wor¦ld: {}")
    assert "joint `right_joint`" in hover(editor, cell / "cell.robot.yaml", text)
    found = hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("elbow", "el¦bow"))
    left, right = (part for part in found.split("\n\n---\n\n") if "right_elbow" in part or "left_elbow" in part)
    assert "effort 50 N*m" in left
    assert "values are shown once the errors in it are mended" in right
    assert "effort" not in right


@pytest.mark.parametrize(
    ("declared", "shown"),
    [
        ("{type: length, default: 4¦0 cm}", "`40 cm` = `0.4 m`"),
        ("{type: number, default: $(5 ¦* 10)}", "`$(5 * 10)` = `50`"),
        ("{type: length, default: 1 m, minimum: 40¦0 mm}", "`400 mm` = `0.4 m`"),
        ("{type: length, default: 1 m, enum: [1 m, 25¦0 cm]}", "`250 cm` = `2.5 m`"),
    ],
)
def test_values_in_the_declaration_of_a_parameter_are_shown_in_si(
    editor: Editor, cell: Path, declared: str, shown: str
):
    strength = "strength: {type: torque, default: 50 N*m}"
    marked = ARM_TEXT.replace(strength, f"{strength}, mast: {declared}")
    found = hover(editor, cell / "arm.robot.yaml", marked)
    assert found.startswith(shown), found
    assert shown not in hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("default: 50", "def¦ault: 50"))


def test_the_code_in_a_comment_leads_to_its_page(editor: Editor, cell: Path):
    marked = ARM_TEXT.replace("  tip: {}", "  tip: {}  # linkforge: ignore LF60¦04")
    found = hover(editor, cell / "arm.robot.yaml", marked)
    assert "docs/diagnostics/LF6004.md), note: " in found


@pytest.mark.parametrize("broken", ["limits: {effort¦: ", "limits: {eff¦ort", "limits:\n      eff¦ort: [\n"])
def test_keys_are_described_in_a_text_that_does_not_parse(editor: Editor, cell: Path, broken: str):
    before = ARM_TEXT.partition("limits: {")[0]
    if "\n" in broken:
        before = ARM_TEXT.partition("  elbow")[0] + "  elbow:\n    "
    found = hover(editor, cell / "arm.robot.yaml", before + broken)
    assert "Maximum torque [N*m] or force [N]." in found


@pytest.mark.parametrize(
    ("marked", "shown"),
    [
        ("parent: ba¦se", "**link `base`**"),
        ("  elb¦ow:", "**revolute joint `elbow`**"),
        ("$(stren¦gth)", "strength is 50 N*m"),
    ],
)
def test_names_in_a_text_that_does_not_parse_are_those_of_the_last_one_that_did(
    editor: Editor, cell: Path, marked: str, shown: str
):
    hover(editor, cell / "arm.robot.yaml", f"¦{ARM_TEXT}")
    found = hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace(marked.replace("¦", ""), marked) + "sensors: [\n")
    assert shown in found


@pytest.mark.parametrize("text", ["¦", "a: [¦", "\t¦: {", "links: {¦}", "$(¦", "# LF99¦99", "links: {a: &a {b: *a¦}}"])
def test_garbage_does_no_harm(editor: Editor, cell: Path, text: str):
    hover(editor, cell / "arm.robot.yaml", text)
    assert "elbow" in hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("elbow", "elb¦ow"))


def test_a_file_that_is_not_open_shows_nothing(editor: Editor, cell: Path):
    document = types.TextDocumentIdentifier((cell / "closed.robot.yaml").as_uri())
    params = types.HoverParams(document, types.Position(3, 4))
    assert editor.ask(lambda client: client.text_document_hover_async(params)) is None


@pytest.mark.parametrize("marked", ["def¦ault: 50", "default: 5¦0"])
def test_a_key_that_takes_any_value_is_shown(editor: Editor, cell: Path, marked: str):
    found = hover(editor, cell / "arm.robot.yaml", ARM_TEXT.replace("default: 50", marked))
    assert found.startswith("**default**\n\nIts value unless it is set")
