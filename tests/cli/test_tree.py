"""`linkforge tree`, and what Pinocchio makes of the same robots."""

import json
import re
from itertools import pairwise
from pathlib import Path

import pytest

from linkforge_compile import compile_file, render_urdf
from linkforge_compile.core import Joint, JointLimits, JointMimic, JointType, Link, Robot, Vector3
from linkforge_compile.diagnostics.terminal import width_of
from linkforge_compile.overview.tree import tree_rows
from linkforge_compile.overview.tree_text import render_links, render_tree
from tests.cli.in_process import linkforge
from tests.conftest import ROOT
from tests.consumers import pinocchio_model

GRIPPER = """\
linkforge: 1
name: gripper
links:
  palm: {visual: {box: [1, 1, 1]}, inertial: {mass: 0.5 kg}}
  knuckle: {visual: {box: [1, 1, 1]}, inertial: {mass: 25 g}}
  finger: {visual: {box: [1, 1, 1]}, inertial: {mass: 1.5 kg}}
  wheel: {visual: {box: [1, 1, 1]}, inertial: {mass: 1 kg}}
  tip: {}
joints:
  bend: {type: revolute, parent: palm, child: knuckle, axis: -y, limits: {upper: 80 deg, effort: 1, velocity: 1}}
  close: {type: prismatic, parent: knuckle, child: finger, axis: [0, 3, 4],
          limits: {lower: -5 mm, upper: 40 mm, effort: 1, velocity: 1},
          mimic: {joint: bend, multiplier: -0.5, offset: 1 mm}}
  end: {type: fixed, parent: finger, child: tip}
  roll: {type: continuous, parent: palm, child: wheel, axis: z}
"""

TREE = """\
link               joint  type                    position                            mass
palm                                                                                0.5 kg
├─ knuckle         bend   revolute -y             up to 80 deg                    0.025 kg
│  └─ finger       close  prismatic [0, 0.6, 0.8]  follows bend * -0.5 + 0.001 m    1.5 kg
│     └─ tip       end    fixed
└─ wheel           roll   continuous z            no limits                           1 kg
"""


@pytest.fixture
def gripper(tmp_path: Path) -> Path:
    (tmp_path / "gripper.robot.yaml").write_text(GRIPPER)
    return tmp_path


def columns(text: str) -> list[list[str]]:
    return [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()]


def test_a_link_has_its_joint_range_and_mass(gripper: Path):
    run = linkforge("tree", "gripper.robot.yaml", cwd=gripper)
    assert (run.returncode, columns(run.stdout)) == (0, columns(TREE))
    assert len({line.index("kg") for line in run.stdout.splitlines() if "kg" in line}) == 1


def test_links_alone_down_to_a_depth(gripper: Path):
    run = linkforge("tree", "gripper.robot.yaml", "--links", "--depth", "1", cwd=gripper)
    assert run.stdout == "palm\n├─ knuckle … 2 below\n└─ wheel\n"


@pytest.mark.parametrize("depth", ["-1", "two", "1.5"])
def test_a_wrong_depth_is_wrong_usage(gripper: Path, depth: str):
    run = linkforge("tree", "gripper.robot.yaml", f"--depth={depth}", cwd=gripper)
    assert (run.returncode, run.stdout) == (2, "")
    assert f"takes a whole number from 0, found '{depth}'" in run.stderr


def test_json_has_si_units_and_parents(gripper: Path):
    document = json.loads(linkforge("tree", "gripper.robot.yaml", "--json", cwd=gripper).stdout)
    links = {link["name"]: link for link in document["links"]}
    assert list(links) == ["palm", "knuckle", "finger", "tip", "wheel"]
    assert (links["finger"]["parent"], links["finger"]["depth"], links["finger"]["mass"]) == ("knuckle", 2, 1.5)
    assert links["finger"]["joint"]["mimic"] == {"joint": "bend", "multiplier": -0.5, "offset": 0.001}
    assert links["finger"]["joint"]["limits"] == {"lower": -0.005, "upper": 0.04, "effort": 1, "velocity": 1}
    assert (links["palm"]["joint"], links["tip"]["mass"]) == (None, None)


def test_a_spec_with_errors_prints_nothing(gripper: Path):
    (gripper / "gripper.robot.yaml").write_text(GRIPPER.replace("child: tip", "child: tap"))
    run = linkforge("tree", "gripper.robot.yaml", cwd=gripper)
    assert (run.returncode, run.stdout) == (1, "")
    assert "gripper.robot.yaml:14:45: error: no link named 'tap'" in run.stderr


def test_colors_are_for_terminals_and_on_request(gripper: Path):
    plain = linkforge("tree", "gripper.robot.yaml", cwd=gripper).stdout
    colored = linkforge("tree", "gripper.robot.yaml", "--color", "always", cwd=gripper).stdout
    assert "\033" not in plain
    assert "\033[36mrevolute -y" in colored
    assert [line.rstrip() for line in re.sub(r"\033\[\d+m", "", colored).splitlines()] == plain.splitlines()
    assert "\033" not in linkforge("tree", "gripper.robot.yaml", cwd=gripper, FORCE_COLOR="1", NO_COLOR="1").stdout


def test_a_urdf_and_parameters_of_a_spec_work_as_for_compile(gripper: Path):
    urdf = render_urdf(compile_file(gripper / "gripper.robot.yaml").result())
    (gripper / "gripper.urdf").write_text(urdf)
    of_urdf, of_spec = (
        linkforge("tree", name, "--links", cwd=gripper) for name in ("gripper.urdf", "gripper.robot.yaml")
    )
    assert of_urdf.stdout == of_spec.stdout
    assert linkforge("tree", "gripper.robot.yaml", "nothing:=1", cwd=gripper).returncode == 1


def robot_of(*joints: tuple[str, str, str], links: str) -> Robot:
    robot = Robot(name="r", links=[Link(name) for name in links])
    robot.add_parts(joints=[Joint(name, JointType.FIXED, parent, child) for name, parent, child in joints])
    return robot


def test_loops_second_parents_and_several_roots_have_their_rows():
    robot = robot_of(("ab", "a", "b"), ("cb", "c", "b"), ("de", "d", "e"), ("ed", "e", "d"), links="abcdef")
    assert list(render_links(tree_rows(robot))) == [
        "a", "└─ b", "c", "└─ b (again)", "f", "d", "└─ e", "   └─ d (again)",
    ]  # fmt: skip


def test_a_long_chain_is_not_indented_without_end():
    names = [f"l{number}" for number in range(2000)]
    robot = Robot(name="chain", links=map(Link, names))
    robot.add_parts(joints=[Joint(f"j{a}", JointType.FIXED, a, b) for a, b in pairwise(names)])
    *_, last = render_tree(tree_rows(robot))
    assert last.split()[-4:] == ["(1999)", "l1999", "jl1998", "fixed"]
    assert width_of(last) < 100


def test_a_robot_with_long_names_has_a_line_for_each_joint():
    limits = JointLimits(lower=0, upper=0.1)
    long = "_".join(["a_very_long_name"] * 3)
    robot = Robot(name="r", links=[Link(f"{long}_{name}") for name in "abc"])
    robot.add_parts(
        joints=[
            Joint(f"{long}_j", JointType.PRISMATIC, f"{long}_a", f"{long}_b", axis=Vector3(1, 0, 0), limits=limits),
            Joint("k", JointType.PRISMATIC, f"{long}_a", f"{long}_c", axis=Vector3(1, 0, 0), limits=limits,
                  mimic=JointMimic(f"{long}_j")),
        ]
    )  # fmt: skip
    lines = list(render_tree(tree_rows(robot)))
    assert max(map(width_of, lines)) <= 100
    assert [re.split(r"(?<=\S)  ", line)[0].strip() for line in lines[2:]] == [
        f"├ {long}_j", f"│ {long}_b", "└ k", f"follows {long}_j", f"{long}_c",
    ]  # fmt: skip


EXAMPLES = ["02_ur5e/ur5e", "05_gripper/ur5e_gripper", "08_hand/hand", "09_mobile_manipulator/mobile_manipulator"]


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_fit_a_terminal_of_100_columns(example: str):
    rows = tree_rows(compile_file(ROOT / f"examples/{example}.robot.yaml").result())
    assert max(map(width_of, render_tree(rows))) <= 100
    assert max(map(width_of, render_tree(rows, width=80))) <= 80
    # The other two have joints with names of thirty characters, which are not broken.
    assert max(map(width_of, render_tree(rows, width=50))) <= (50 if example in {EXAMPLES[0], EXAMPLES[2]} else 66)


def test_a_narrow_terminal_has_a_tree_without_columns():
    rows = tree_rows(compile_file(ROOT / "examples/08_hand/hand.robot.yaml").result())
    assert list(render_tree(rows, width=50))[:7] == [
        "joint, and its link below",
        "palm  0.4 kg",
        "├ finger_1_knuckle  revolute y",
        "│   0 to 80 deg",
        "│ finger_1_proximal  0.01536 kg",
        "│ └ finger_1_middle  revolute y",
        "│     follows finger_1_knuckle * 0.8",
    ]


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_tree_is_that_of_pinocchio(example: str):
    run = linkforge("tree", str(ROOT / f"examples/{example}.robot.yaml"), "--json", cwd=ROOT)
    links = {link["name"]: link for link in json.loads(run.stdout)["links"]}

    def moving_above(name: str | None) -> str:
        link = links[name]
        while link["joint"] and link["joint"]["type"] == "fixed":
            link = links[link["parent"]]
        return link["joint"]["name"] if link["joint"] else "universe"

    model = pinocchio_model(render_urdf(compile_file(ROOT / f"examples/{example}.robot.yaml").result()))
    theirs = {name: model.names[model.parents[number]] for number, name in enumerate(model.names) if number}
    joints = {link["joint"]["name"]: link for link in links.values() if link["joint"]}
    ours = {name: moving_above(link["parent"]) for name, link in joints.items() if link["joint"]["type"] != "fixed"}
    assert ours == theirs
    for name, link in joints.items():
        if link["joint"]["type"] in {"revolute", "prismatic"}:
            index = model.joints[model.getJointId(name)].idx_q
            assert link["joint"]["limits"]["lower"] == model.lowerPositionLimit[index]
            assert link["joint"]["limits"]["upper"] == model.upperPositionLimit[index]
