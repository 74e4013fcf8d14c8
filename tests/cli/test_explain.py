"""`linkforge explain`, run as a program."""

from pathlib import Path

import pytest

from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.resources import manual_folder
from tests.cli.in_process import linkforge

ARM = """\
linkforge: 1
name: arm
parameters: {strength: 20 N*m}
links: {base: , upper: }
joints:
  elbow: {type: continuous, parent: base, child: upper, axis: z,
    limits: {effort: $(strength), velocity: 1}}
"""
CELL = """\
linkforge: 1
name: cell
links: {table: }
modules:
  left: {use: arm.robot.yaml, parent: table}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    return tmp_path


def test_a_value_is_shown_with_its_place_expression_and_files_between(cell: Path):
    run = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/effort", cwd=cell)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.splitlines() == [
        "joints/left_elbow/limits/effort: 20 N*m",
        "written at arm.robot.yaml:7:22",
        "     7 |     limits: {effort: $(strength), velocity: 1}}",
        "       |                      ^^^^^^^^^^^",
        "computed: $(strength)",
        "  strength is 20 N*m, the default 20 N*m at arm.robot.yaml:3:24",
        "used at cell.robot.yaml:5:15",
        "     5 |   left: {use: arm.robot.yaml, parent: table}",
        "       |               ^^^^^^^^^^^^^^",
    ]


def test_an_unwritten_value_is_shown_as_such(cell: Path):
    run = linkforge("explain", "cell.robot.yaml", "joints/left_joint/type", cwd=cell)
    assert run.stdout.splitlines()[:3] == [
        "joints/left_joint/type: fixed",
        "no line of the spec wrote this; it has its default",
        "what it belongs to is written at cell.robot.yaml:5:3",
    ]


def test_parameters_are_set_before(cell: Path):
    run = linkforge("explain", "arm.robot.yaml", "joints/elbow/limits/effort", "strength:=7", cwd=cell)
    assert run.stdout.startswith("joints/elbow/limits/effort: 7 N*m\n")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("arm.robot.yaml",), "takes a spec and a path, such as joints/elbow/limits/effort"),
        (("arm.robot.yaml", "joints/elbwo"), "there is no 'elbwo' in 'joints'; did you mean 'elbow'?"),
        (("arm.robot.yaml", "joint/elbow"), "there is no 'joint' in the robot; did you mean 'joints'?"),
        (("arm.robot.yaml", "elbow"), "there is no 'elbow' in the robot; did you mean 'joints/elbow'?"),
        (("cell.robot.yaml", "elbow/limits"), "there is no 'elbow' in the robot; did you mean 'joints/left_elbow'?"),
        (
            ("cell.robot.yaml", "parameters/x"),
            "there is no 'parameters' in the robot, which is finished; `linkforge params`",
        ),
        (("cell.robot.yaml", "variables/x"), "which is finished; the value that uses it shows where it comes from"),
        (
            ("cell.robot.yaml", "frames/left_upper/origin"),
            "where a frame is a link and a fixed joint; look at 'joints/left_elbow/origin'",
        ),
        (("cell.robot.yaml", "frames/nobody"), "where a frame is a link and a fixed joint\n"),
        (("cell.robot.yaml", "joints/elbow"), "there is no 'elbow' in 'joints'; did you mean 'left_elbow'?"),
    ],
)
def test_wrong_usage_is_reported(cell: Path, words: tuple[str, ...], expected: str):
    run = linkforge("explain", *words, cwd=cell)
    assert (run.returncode, run.stdout) == (2, "")
    assert expected in run.stderr


def test_a_spec_with_errors_is_reported(cell: Path):
    (cell / "arm.robot.yaml").write_text(ARM.replace("axis: z", "axis: w"))
    run = linkforge("explain", "arm.robot.yaml", "name", cwd=cell)
    assert (run.returncode, run.stdout) == (1, "")
    assert "axis" in run.stderr


def test_the_values_replaced_by_an_override_and_a_default_are_shown(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(ARM + "defaults: {joint: {limits: {effort: 5, velocity: 9}}}\n")
    patch = "override: {joints: {elbow: {limits: {effort: 30 N*m}}}}"
    (tmp_path / "cell.robot.yaml").write_text(CELL.replace("parent: table", f"parent: table, {patch}"))
    run = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/effort", cwd=tmp_path)
    lines = [line for line in run.stdout.splitlines() if " at " in line]
    assert run.stdout.startswith("joints/left_elbow/limits/effort: 30 N*m\n")
    assert lines[0].startswith("written at cell.robot.yaml:5:")
    assert lines[1:3] == [
        "instead of what is written at arm.robot.yaml:7:22",
        "instead of the default at arm.robot.yaml:8:37",
    ]
    unchanged = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/velocity", cwd=tmp_path)
    assert "instead of the default at arm.robot.yaml:8:50" in unchanged.stdout
    assert "cell.robot.yaml:5:15" not in run.stdout


def test_a_change_by_an_override_inside_of_a_value_is_shown(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    patch = "override: {joints: {elbow: {limits: {effort: 30 N*m}}}}"
    cell = CELL.replace("parent: table", f"parent: table, {patch}")
    (tmp_path / "cell.robot.yaml").write_text(cell)
    place = cell.splitlines()[4].index("30 N*m") + 1
    for path, changed in (("joints/left_elbow/limits", "effort"), ("joints/left_elbow", "limits/effort")):
        run = linkforge("explain", "cell.robot.yaml", path, cwd=tmp_path)
        assert f"\n'{changed}' is overridden at cell.robot.yaml:5:{place}\n" in run.stdout
    (tmp_path / "build").mkdir()
    linkforge("compile", "cell.robot.yaml", "-o", "build/", "--source-map", cwd=tmp_path)
    lines = (tmp_path / "build" / "cell.urdf").read_text().split("\n")
    number = next(number for number, line in enumerate(lines, start=1) if "<limit " in line)
    run = linkforge("where", f"build/cell.urdf:{number}", cwd=tmp_path)
    assert [line.split(" at ") for line in run.stdout.splitlines() if " at " in line] == [
        ["written", "arm.robot.yaml:7:13"],
        ["overridden", f"cell.robot.yaml:5:{place}"],
        ["used", "cell.robot.yaml:5:15"],
    ]


BLOCKS = """\
linkforge: 1
name: blocks
defaults: {link: {inertial: {density: 700}}}
links:
  oak: {visual: {sphere: 1}, collision: [{box: [1, 1, 1]}, {box: [1, 1, 1], origin: [0, 0, 2]}]}
  elm: {visual: {box: [1, 1, 1]}, inertial: {mass: 3}}
  tin: {inertial: {mass: 3, inertia: {ixx: 1, iyy: 1, izz: 1}}}
joints:
  a: {type: fixed, parent: oak, child: elm}
  b: {type: fixed, parent: oak, child: tin}
"""


def blocks(folder: Path, path: str) -> list[str]:
    """Return the explanation of a value of BLOCKS, without the source lines."""
    (folder / "blocks.robot.yaml").write_text(BLOCKS)
    run = linkforge("explain", "blocks.robot.yaml", path, cwd=folder)
    assert (run.returncode, run.stderr) == (0, "")
    return [line for line in run.stdout.splitlines() if "|" not in line]


def test_a_computed_inertia_is_shown_with_its_sources(tmp_path: Path):
    assert blocks(tmp_path, "links/oak/inertial/mass") == [
        "links/oak/inertial/mass: 1400 kg",
        "computed from the density, spread evenly over the link's shapes",
        "the density is written as a default at blocks.robot.yaml:3:39",
        "collision/0, a box, is written at blocks.robot.yaml:5:42",
        "collision/1, a box, is written at blocks.robot.yaml:5:60",
    ]
    assert blocks(tmp_path, "links/elm/inertial/inertia/izz") == [
        "links/elm/inertial/inertia/izz: 0.5 kg*m^2",
        "computed from the mass, spread evenly over the link's shapes",
        "the mass is written at blocks.robot.yaml:6:52",
        "visual/0, a box, is written at blocks.robot.yaml:6:17",
    ]


def test_what_is_written_of_an_inertial_is_not_called_computed(tmp_path: Path):
    assert "written at blocks.robot.yaml:6:52" in blocks(tmp_path, "links/elm/inertial/mass")
    assert "written at blocks.robot.yaml:7:44" in blocks(tmp_path, "links/tin/inertial/inertia/ixx")
    assert "no line of the spec wrote this; it has its default" in blocks(tmp_path, "links/tin/inertial/origin")


def test_a_value_from_the_defaults_is_called_so(tmp_path: Path):
    assert (
        blocks(tmp_path, "links/oak/inertial")[-4:]
        == [
            "written as a default at blocks.robot.yaml:3:29",
            *blocks(tmp_path, "links/oak/inertial/mass")[1:],
        ][-4:]
    )
    lines = ARM.replace(", velocity: 1", "") + "defaults: {joint: {limits: {velocity: 9}}}\n"
    (tmp_path / "arm.robot.yaml").write_text(lines)
    run = linkforge("explain", "arm.robot.yaml", "joints/elbow/limits/velocity", cwd=tmp_path)
    assert run.stdout.splitlines()[:2] == [
        "joints/elbow/limits/velocity: 9 rad/s",
        "written as a default at arm.robot.yaml:8:39",
    ]


def test_a_number_of_a_short_form_is_reached_without_the_key_that_was_left_out(tmp_path: Path):
    assert blocks(tmp_path, "links/oak/collision/1/origin/2")[0] == "links/oak/collision/1/origin/xyz/2: 2 m"
    assert blocks(tmp_path, "links/elm/visual/box/0")[0] == "links/elm/visual/0/box/size/0: 1 m"


def test_warnings_elsewhere_in_the_spec_are_not_shown(cell: Path):
    spec = ARM.replace("axis: z", "axis: z, origin: [200, 0, 0]")
    (cell / "arm.robot.yaml").write_text(spec)
    assert "LF5010" in linkforge("check", "arm.robot.yaml", cwd=cell).stderr
    run = linkforge("explain", "arm.robot.yaml", "name", cwd=cell)
    assert (run.returncode, run.stderr) == (0, "")


def test_a_code_is_explained_by_its_page_of_the_manual(tmp_path: Path):
    run = linkforge("explain", "lf1002", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout == (manual_folder() / "LF1002.md").read_text("utf-8")


def test_a_page_is_styled_if_colors_are_requested(tmp_path: Path):
    run = linkforge("explain", "LF1002", cwd=tmp_path, FORCE_COLOR="1", NO_COLOR="")
    assert run.stdout.startswith("\033[1mLF1002: YAML is indented with spaces, found …\033[0m\n")
    assert "```" not in run.stdout
    assert "    \033[36mlinks:\033[0m" in run.stdout.splitlines()


def test_all_codes_are_listed(tmp_path: Path):
    lines = linkforge("explain", "--codes", cwd=tmp_path).stdout.splitlines()
    assert [line.partition(" ")[0] for line in lines] == sorted(REGISTER)
    assert "LF4102  error    no link named '…'" in lines


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("LF41099",), "no diagnostic has the code 'LF41099'; did you mean 'LF4109'?"),
        (("--codes", "LF4102"), "--codes lists all codes and takes no words, found 'LF4102'"),
    ],
)
def test_a_code_that_is_none_is_wrong_usage(tmp_path: Path, words: tuple[str, ...], expected: str):
    run = linkforge("explain", *words, cwd=tmp_path)
    assert run.returncode == 2
    assert expected in run.stderr


NESTED = {
    "hand.robot.yaml": """\
linkforge: 1
name: hand
parameters: {width: {type: length, default: 0.1 m}}
data: {kin: kin.yaml}
variables: {half: $(width / 2)}
links:
  palm: {visual: {box: [$(width), $(half), 0.1]}, collision: visual, inertial: {mass: "$(kin.masses[1])"}}
  f_$(i): {for: {i: 2}, visual: {sphere: 0.01, origin: ["$(i * half)", 0, 0]}}
joints:
  j_$(i): {for: {i: 2}, type: fixed, parent: palm, child: f_$(i)}
""",
    "kin.yaml": "masses: [3, 1.5]\n",
    "arm.robot.yaml": """\
linkforge: 1
name: arm
include: [more.yaml]
parameters:
  reach: {type: length, default: 0.8 m}
links: {base: }
modules:
  hand: {use: hand.robot.yaml, parent: base, with: {width: $(reach)}}
""",
    "more.yaml": """\
linkforge: 1
variables: {twice: $(reach * 2)}
links: {tip: {visual: {sphere: "$(twice / 4)"}}}
joints: {tip_joint: {type: fixed, parent: base, child: tip}}
""",
    "cell.robot.yaml": """\
linkforge: 1
name: cell
parameters: {arm_reach: 0.7 m}
variants: {long: {arm_reach: 1.2 m}}
links: {table: }
modules:
  left: {use: arm.robot.yaml, parent: table, with: {reach: $(arm_reach)}}
""",
}


@pytest.fixture
def nested(tmp_path: Path) -> Path:
    for name, text in NESTED.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def computed(folder: Path, path: str, *options: str) -> list[str]:
    """Return the lines that tell how a value was computed."""
    lines = linkforge("explain", "cell.robot.yaml", path, *options, cwd=folder).stdout.splitlines()
    start = next(number for number, line in enumerate(lines) if line.startswith("computed: "))
    end = next(number for number, line in enumerate(lines) if line.startswith(("used at", "included at")))
    return lines[start:end]


def test_each_name_is_shown_with_its_source_and_what_it_replaced(nested: Path):
    path = "links/left_hand_palm/visual/0/box/size/1"
    assert computed(nested, path, "-p", "arm_reach=0.9", "--variant", "long") == [
        "computed: $(half)",
        "  half is 0.45 m, the variable $(width / 2) at hand.robot.yaml:5:19",
        "    width is 0.9 m, 'with' $(reach) at arm.robot.yaml:8:60",
        "      instead of the default 0.1 m at hand.robot.yaml:3:45",
        "      reach is 0.9 m, 'with' $(arm_reach) at cell.robot.yaml:7:60",
        "        instead of the default 0.8 m at arm.robot.yaml:5:34",
        "        arm_reach is 0.9 m, from the command line: arm_reach=0.9",
        "          instead of variant 'long' 1.2 m at cell.robot.yaml:4:30",
        "          instead of the default 0.7 m at cell.robot.yaml:3:25",
    ]


def test_a_variant_and_a_default_in_an_included_file_are_reported(nested: Path):
    assert computed(nested, "links/left_tip/visual/sphere", "--variant", "long") == [
        'computed: "$(twice / 4)"',
        "  twice is 2.4 m, the variable $(reach * 2) at more.yaml:2:20",
        "    reach is 1.2 m, 'with' $(arm_reach) at cell.robot.yaml:7:60",
        "      instead of the default 0.8 m at arm.robot.yaml:5:34",
        "      arm_reach is 1.2 m, variant 'long' 1.2 m at cell.robot.yaml:4:30",
        "        instead of the default 0.7 m at cell.robot.yaml:3:25",
    ]
    assert computed(nested, "links/left_tip/visual/sphere")[-1] == (
        "      arm_reach is 0.7 m, the default 0.7 m at cell.robot.yaml:3:25"
    )


def test_a_value_from_data_is_reported_in_its_file(nested: Path):
    assert computed(nested, "links/left_hand_palm/inertial/mass") == [
        'computed: "$(kin.masses[1])"',
        "  kin is a map, the content of kin.yaml, named at hand.robot.yaml:4:13",
        "the value itself is written at kin.yaml:1:13",
        "     1 | masses: [3, 1.5]",
        "       |             ^^^",
    ]


def test_a_list_tells_the_names_of_its_parts_once_each(nested: Path):
    lines = computed(nested, "links/left_hand_palm/visual/0/box")
    assert [line.split(",")[0].strip() for line in lines if " is " in line] == [
        "width is 0.7 m",
        "reach is 0.7 m",
        "arm_reach is 0.7 m",
        "half is 0.35 m",
    ]


def test_a_name_of_for_is_reported(nested: Path):
    lines = computed(nested, "links/left_hand_f_1/visual/0/origin/xyz/0")
    assert "  i is 1, one of 'for' 2 at hand.robot.yaml:8:21" in lines


def test_a_parameter_overridden_in_with_is_shown_with_what_it_replaced(nested: Path):
    patch = "override: {modules: {hand: {with: {width: 0.3 m}}}}"
    text = NESTED["cell.robot.yaml"].replace("parent: table", f"parent: table, {patch}")
    (nested / "cell.robot.yaml").write_text(text)
    assert computed(nested, "links/left_hand_palm/visual/0/box/size/0") == [
        "computed: $(width)",
        "  width is 0.3 m, 'with' 0.3 m at cell.robot.yaml:7:88",
        "    instead of 'with' $(reach) at arm.robot.yaml:8:60",
        "    instead of the default 0.1 m at hand.robot.yaml:3:45",
    ]


CONTROLLED = """\
linkforge: 1
name: arm
links: {base: , upper: }
joints:
  elbow: {type: continuous, parent: base, child: upper, axis: z, limits: {effort: 1, velocity: 1}}
ros2_control:
  arm:
    hardware_plugin: mock_components/GenericSystem
    joints: {elbow: {command_interfaces: [velocity, position], state_interfaces: [position]}}
semantic:
  groups:
    arm: {joints: [elbow]}
"""


TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
MOVE = f"controllers: {{move: {{type: {TRAJECTORY}, group: arm}}}}\n"
GRIPPER = "effort_controllers/GripperActionController"
GRIP = f"controllers: {{grip: {{type: {GRIPPER}, parameters: {{joint: elbow}}}}}}\n"
OF_GROUP = "the joints of planning group 'arm' that have a command interface in `ros2_control`"
FIRST = "the first of 'position', 'velocity' and 'effort' that all of its joints have in `ros2_control`"


@pytest.mark.parametrize(
    ("controllers", "value", "why", "place"),
    [
        ("", "arm_controller/joints: [elbow]", OF_GROUP, "12:5"),
        ("", "arm_controller/joints/0: elbow", OF_GROUP, "12:5"),
        ("", f"arm_controller/type: {TRAJECTORY}", "a default, because the spec has no `controllers`", "12:5"),
        (MOVE, "move/joints: [elbow]", OF_GROUP, "12:5"),
        (MOVE, "move/command_interfaces: [position]", FIRST, "9:42"),
    ],
)
def test_what_a_controller_derives_is_shown_with_what_it_follows_from(
    tmp_path: Path, controllers: str, value: str, why: str, place: str
):
    (tmp_path / "arm.robot.yaml").write_text(CONTROLLED + controllers)
    path = f"controllers/{value.partition(':')[0]}"
    first, second, third, *_ = linkforge("explain", "arm.robot.yaml", path, cwd=tmp_path).stdout.splitlines()
    assert first == f"controllers/{value}"
    assert second == f"not written itself: {why}"
    assert third.endswith(f" is written at arm.robot.yaml:{place}")


def test_a_parameter_that_is_a_field_of_a_controller_is_written(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(CONTROLLED + GRIP)
    lines = linkforge("explain", "arm.robot.yaml", "controllers/grip/joints", cwd=tmp_path).stdout.splitlines()
    assert lines[:2] == ["controllers/grip/joints: [elbow]", "written at arm.robot.yaml:13:92"]


def test_a_controller_that_is_none_has_a_hint_to_a_default_one(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(CONTROLLED)
    run = linkforge("explain", "arm.robot.yaml", "controllers/arm_controler", cwd=tmp_path)
    assert "did you mean 'arm_controller'?" in run.stderr


def test_a_written_field_of_a_controller_is_shown_at_its_place(tmp_path: Path):
    own = "controllers: {move: {type: a/B, joints: [elbow], parameters: {gain: 2}}}\n"
    (tmp_path / "arm.robot.yaml").write_text(CONTROLLED + own)
    for path in ("joints/0", "parameters/gain", "type"):
        run = linkforge("explain", "arm.robot.yaml", f"controllers/move/{path}", cwd=tmp_path)
        assert run.stdout.splitlines()[1].startswith("written at arm.robot.yaml:13:")


def test_a_map_is_summarized_without_unwritten_defaults(cell: Path):
    run = linkforge("explain", "cell.robot.yaml", "joints/left_elbow", cwd=cell)
    assert "limits: {effort: 20, velocity: 1}" in run.stdout
    assert "dynamics" not in run.stdout
    assert "rpy" not in run.stdout
