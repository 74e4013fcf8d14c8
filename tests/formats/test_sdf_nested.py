"""With `--nested`, each module is a model, and everything is where it is in an SDF of one model."""

import os
from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.cli.main import main
from linkforge_compile.core import Robot
from linkforge_compile.formats import SDF, Rendering
from tests.conftest import ROOT
from tests.importers.robots import OF_CORPUS, OF_EXAMPLES, STEP
from tests.libsdformat import Part, Read, read_with_libsdformat

WITH_MODULES = [
    path for path in sorted((ROOT / "examples").rglob("*.robot.yaml")) if "\nmodules:" in path.read_text("utf-8")
]
REAL = [*OF_EXAMPLES, *OF_CORPUS][:: 4 * STEP]
"""Each takes more than a second."""

UNIT = "inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}"


def test_the_golden_file_of_an_example(update_golden: bool):
    """Two arms, each a model."""
    spec = ROOT / "examples" / "03_two_ur5e" / "two_ur5e.robot.yaml"
    golden = spec.with_suffix("").with_suffix(".sdf")
    text = SDF.render(compile_file(spec).result(), Rendering({"nested": "yes"}))[0].text
    if update_golden:
        golden.write_text(text, "utf-8")
    assert golden.read_text("utf-8") == text


@pytest.mark.parametrize("path", WITH_MODULES, ids=lambda path: path.stem)
def test_examples_are_the_same_nested(path: Path, tmp_path: Path):
    robot = compile_file(path).result()
    assert len(require_same_nested(robot, tmp_path).models) > 1


@pytest.mark.parametrize("path", REAL, ids=lambda path: path.stem)
def test_two_real_robots_as_modules_are_the_same_nested(path: Path, tmp_path: Path):
    (tmp_path / "both.robot.yaml").write_text(
        f"""linkforge: 1
name: both
links: {{torso: {{{UNIT}}}}}
modules:
  left: {{use: {os.path.relpath(path, tmp_path)}, parent: torso, origin: {{xyz: [0, 1, 0], rpy: [1, -90 deg, 0.2]}}}}
  right: {{use: {os.path.relpath(path, tmp_path)}, parent: torso, origin: [0, -1, 0]}}
"""
    )
    robot = compile_file(tmp_path / "both.robot.yaml", allow_outside=True).result()
    assert {"left", "right"} <= require_same_nested(robot, tmp_path).models.keys()


HAND = """
frames: {tip: {parent: finger, origin: [0, 0, 0.1]}}
links:
  flange: {collision: {box: [1, 1, 1], origin: [0, 0, 0.5]}}
  plate:
  finger: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  thumb: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}
joints:
  seat: {type: fixed, parent: flange, child: plate, origin: {xyz: [0.1, 0.2, 0.3], rpy: [0.5, -90 deg, 1]}}
  bend: {type: continuous, parent: plate, child: finger, axis: y, origin: {xyz: [0, 1, 0], rpy: [1, 0, 0]}}
  grip: {type: continuous, parent: flange, child: thumb, axis: x, origin: [0, 0, 1], mimic: {joint: bend}}
sensors: {eye: {type: imu, link: plate, origin: [0, 0, 0.2]}}
"""
"""Its two fingers turn on a link without mass, which is a frame on what holds the hand."""

ARM = """
links: {mast: , arm: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
joints: {lift: {type: fixed, parent: mast, child: arm, origin: {xyz: [0, 0, 1], rpy: [0.1, 0.2, 0.3]}}}
modules: {hand: {use: hand.robot.yaml, parent: arm, origin: {xyz: [1, 0, 0], rpy: [0, 0, 1]}}}
"""


TWO = f"""
links: {{torso: {{{UNIT}}}}}
joints: {{left_shoulder: {{type: continuous, parent: torso, child: left_mast, axis: z, origin: [0, 1, 0]}}}}
frames: {{tcp: {{parent: left_hand_thumb, origin: [0, 0, 0.2]}}}}
modules:
  left: {{use: arm.robot.yaml}}
  $(side): {{for: {{side: [right, rear]}}, use: arm.robot.yaml, parent: tcp, origin: [0, 0, 1]}}
  own: {{use: hand.robot.yaml, parent: rear_arm, prefix: ""}}
"""


def compiled_with_parts(text: str, folder: Path) -> Robot:
    for name, content in {"hand": HAND, "arm": ARM, "two": text}.items():
        (folder / f"{name}.robot.yaml").write_text(f"linkforge: 1\nname: {name}\n{content}")
    return compile_file(folder / "two.robot.yaml").result()


@pytest.fixture
def two_arms(tmp_path: Path) -> Robot:
    return compiled_with_parts(TWO, tmp_path)


def test_modules_are_models_inside_each_other(two_arms: Robot, tmp_path: Path):
    read = require_same_nested(two_arms, tmp_path)
    assert list(read.models) == ["two", "left", "left::hand", "right", "right::hand", "rear", "rear::hand", "own"]


def test_a_joint_is_in_the_innermost_model_with_its_links(two_arms: Robot, tmp_path: Path):
    joints = require_same_nested(two_arms, tmp_path).joints
    assert (joints["left_shoulder"]["parent"], joints["left_shoulder"]["child"]) == ("torso", "left::left_arm")
    # The plate is a frame in the model of the arm.
    assert joints["left::left_hand_bend"]["child"] == "left::hand::left_hand_finger"


def test_a_frame_is_in_the_model_of_the_link_that_holds_it(two_arms: Robot, tmp_path: Path):
    frames = require_same_nested(two_arms, tmp_path).frames
    assert {"left::left_hand_plate", "left::hand::left_hand_tip", "left::hand::tcp"} <= frames.keys()


def require_same_nested(robot: Robot, folder: Path) -> Read:
    """Compare all that libsdformat reads with what it reads in one model; the parser may complain about neither."""
    flat, nested = (
        read_with_libsdformat(
            SDF.render(robot, Rendering({"sdf": "1.9", "nested": one}))[0].text, folder, is_strict=True
        )
        for one in ("no", "yes")
    )
    assert sorted(map(without_place, nested.complaints)) == sorted(map(without_place, flat.complaints))
    for ours, theirs in ((nested.links, flat.links), (nested.joints, flat.joints), (nested.frames, flat.frames)):
        assert sorted(map(own_name, ours)) == sorted(theirs)
        for name, part in ours.items():
            require_same_part(part, theirs[own_name(name)])
    return nested


def require_same_part(part: Part, expected: Part) -> None:
    require_same_pose(part, expected)
    for key in {"mass", "inertia", "center", "type"} & part.keys():
        assert part[key] == expected[key], (part["name"], key)
    for end in {"parent", "child"} & part.keys():
        assert own_name(part[end]) == expected[end]
    for axis, other in zip(part.get("axes", ()), expected.get("axes", ()), strict=True):
        assert axis["xyz"] == pytest.approx(other["xyz"], abs=1e-12)
        assert axis["xml"] == other["xml"]
    for kind in ("visuals", "collisions", "sensors"):
        for one, other in zip(part.get(kind, ()), expected.get(kind, ()), strict=True):
            require_same_pose(one, other)
            assert own_name(one["name"]) == other["name"]


def require_same_pose(part: Part, expected: Part) -> None:
    assert part["pose"][:3] == pytest.approx(expected["pose"][:3], abs=1e-12), part["name"]
    product = sum(a * b for a, b in zip(part["pose"][3:], expected["pose"][3:], strict=True))
    assert abs(product) == pytest.approx(1, abs=1e-12), part["name"]


def without_place(complaint: str) -> str:
    return complaint.rpartition(" Msg: ")[2]


def own_name(name: str) -> str:
    return name.rpartition("::")[2]


def test_the_command_has_a_flag_that_may_precede_the_spec(tmp_path: Path):
    spec = ROOT / "examples" / "03_two_ur5e" / "two_ur5e.robot.yaml"
    assert main(["compile", "--nested", str(spec), "-o", str(tmp_path / "two.sdf")]) == 0
    assert '<model name="left">' in (tmp_path / "two.sdf").read_text("utf-8")


CONTROLLED = f"""
links: {{torso: {{{UNIT}}}}}
modules: {{left: {{use: arm.robot.yaml, parent: torso}}}}
ros2_control: {{left: {{hardware_plugin: PLUGIN, joints: {{left_hand_bend: {{command_interfaces: [position]}}}}}}}}
"""


def test_joints_that_gz_ros2_control_moves_are_in_the_outermost_model(tmp_path: Path):
    """With all that mimics them; the plugin finds the joints that are children of its own model alone."""
    robot = compiled_with_parts(CONTROLLED.replace("PLUGIN", "gz_ros2_control/GazeboSimSystem"), tmp_path)
    joints = require_same_nested(robot, tmp_path).joints
    assert [name for name, joint in joints.items() if joint["type"] == "revolute"] == [
        "left_hand_bend",
        "left_hand_grip",
    ]
    assert joints["left_hand_bend"]["child"] == "left::hand::left_hand_finger"


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            CONTROLLED.replace("PLUGIN", "gz_ros2_control/GazeboSimSystem"),
            [
                "LF7512 gz_ros2_control finds no joints in nested models, so 'left_hand_bend' is in the model of "
                "the robot, not in that of its module"
            ],
        ),
        (CONTROLLED.replace("PLUGIN", "mock_components/GenericSystem"), []),
        (
            f"links: {{torso: {{{UNIT}}}}}\nmodules: {{__left__: {{use: arm.robot.yaml, parent: torso, prefix: l_}}}}",
            ["LF7505 '__left__' is reserved in SDF; rename this one"],
        ),
    ],
)
def test_what_nested_models_cannot_do_is_reported(text: str, messages: list[str], tmp_path: Path):
    robot = compiled_with_parts(text, tmp_path)
    assert [messages, []] == [
        [f"{one.code.id} {one.message}" for one in SDF.limits(robot, options) if one.code.id in ("LF7505", "LF7512")]
        for options in ({"nested": "yes"}, {"nested": "no"})
    ]


def test_a_model_with_the_name_of_a_link_is_called_otherwise(tmp_path: Path):
    text = f"links: {{arm: {{{UNIT}}}}}\nmodules: {{arm: {{use: arm.robot.yaml, parent: arm}}}}"
    robot = compiled_with_parts(text, tmp_path)
    assert list(require_same_nested(robot, tmp_path).models) == ["two", "arm_model", "arm_model::hand"]
