"""Where the values of a finished robot come from."""

from pathlib import Path

import pytest

from linkforge_compile import compile_file, compile_text
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec import Explanation, UnknownPathError, explain
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Kind

ARM = """\
linkforge: 1
name: arm
parameters: {strength: 20 N*m}
links:
  base: {}
  upper: {visual: {box: [1, 1, 1], origin: [0, 0, 2]}, inertial: {mass: 2 kg}}
joints:
  elbow:
    type: revolute
    parent: base
    child: upper
    axis: z
    limits: {lower: 0, upper: 90 deg, effort: $(strength), velocity: 1}
frames:
  tool/0: {parent: upper}
semantic:
  groups: {arm: {joints: [elbow]}}
  group_states: {arm: {home: {elbow: 0.5}}}
  disabled_collisions: {base: {upper: Adjacent}}
"""
CELL = """\
linkforge: 1
name: cell
links: {table: {}}
modules:
  left:
    use: arm.robot.yaml
    parent: table
    with: {strength: 30}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Robot:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    return compile_file(tmp_path / "cell.robot.yaml").result()


@pytest.fixture
def arm() -> Robot:
    return compile_text(ARM).result()


def line(explanation: Explanation) -> int:
    assert explanation.provenance is not None
    return explanation.provenance.span.line


def uses(explanation: Explanation) -> tuple[Span, ...]:
    assert explanation.provenance is not None
    return explanation.provenance.spans(Kind.USE)


def expression(explanation: Explanation) -> str:
    [link] = [link for link in explanation.provenance or () if link.kind is Kind.EXPRESSION]
    return link.name


def test_a_value_is_shown_with_its_unit_and_place(arm: Robot):
    mass = explain(arm, "links/upper/inertial/mass")
    assert (mass.text, mass.is_written) == ("links/upper/inertial/mass: 2 kg", True)
    assert mass.provenance is not None
    assert (mass.provenance.span.line, mass.provenance.span.text) == (6, "2 kg")


def test_a_computed_value_is_shown_with_its_expression_and_uses(cell: Robot):
    effort = explain(cell, "joints/left_elbow/limits/effort")
    assert (effort.text, expression(effort)) == ("joints/left_elbow/limits/effort: 30 N*m", "$(strength)")
    assert line(effort) == 13
    assert [Path(use.file.name).name for use in uses(effort)] == ["cell.robot.yaml"]


@pytest.mark.parametrize(
    ("path", "text", "at"),
    [
        ("links/upper/visual/0/origin/rpy/2", "0 rad", 6),
        ("links/upper/inertial/inertia/ixx", "0.3333333333333333 kg*m^2", 6),
        ("joints/tool/0_joint/type", "fixed", 15),
    ],
)
def test_an_unwritten_value_is_shown_as_such_with_its_owner(arm: Robot, path: str, text: str, at: int):
    found = explain(arm, path)
    assert (found.text, found.is_written, line(found)) == (f"{path}: {text}", False, at)


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("links/upper/visual/origin/xyz/2", "links/upper/visual/0/origin/xyz/2: 2 m"),
        ("links/upper/visual/0/box/size", "links/upper/visual/0/box/size: [1, 1, 1] m"),
        ("joints/tool/0_joint/parent", "joints/tool/0_joint/parent: upper"),
        ("semantic/disabled_collisions/base/upper", "semantic/disabled_collisions/base/upper: Adjacent"),
        ("semantic/groups/arm/joints/0", "semantic/groups/arm/joints/0: elbow"),
        ("name", "name: arm"),
    ],
)
def test_a_path_may_take_the_short_way_and_names_may_hold_slashes(arm: Robot, path: str, text: str):
    found = explain(arm, path)
    assert found.text == text
    assert found.is_written


def test_a_state_of_a_module_is_found_under_the_name_that_its_file_gives_to_the_joint(cell: Robot):
    position = explain(cell, "semantic/group_states/left_arm/left_home/left_elbow")
    assert position.is_written
    assert line(position) == 18


def test_a_position_copied_from_another_state_is_reported_where_it_is_written(tmp_path: Path):
    semantic = (
        "semantic:\n  groups: {all: {subgroups: [left_arm]}}\n  group_states: {all: {rest: {left_arm: left_home}}}\n"
    )
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL + semantic)
    position = explain(compile_file(tmp_path / "cell.robot.yaml").result(), "semantic/group_states/all/rest/left_elbow")
    assert position.is_written
    assert position.provenance is not None
    assert (Path(position.provenance.span.file.name).name, position.provenance.span.text) == ("arm.robot.yaml", "0.5")
    assert [(Path(use.file.name).name, use.line) for use in uses(position)] == [("cell.robot.yaml", 6)]


def test_positions_of_joints_whose_names_differ_by_the_prefix_are_distinguished(tmp_path: Path):
    joints = "  left_elbow: {type: continuous, parent: upper, child: hand, axis: z}\n"
    arm = ARM.replace("joints:\n", f"joints:\n{joints}", 1).replace("  upper: {", "  hand:\n  upper: {")
    arm = arm.replace("arm: {joints: [elbow]}", "arm: {joints: [elbow, left_elbow]}")
    (tmp_path / "arm.robot.yaml").write_text(arm.replace("{elbow: 0.5}", "{left_elbow: 2, elbow: 1}"))
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    robot = compile_file(tmp_path / "cell.robot.yaml").result()
    for joint, written in (("left_elbow", "1"), ("left_left_elbow", "2")):
        position = explain(robot, f"semantic/group_states/left_arm/left_home/{joint}")
        assert position.text.endswith(f"/{joint}: {written} rad")
        assert position.provenance is not None
        assert position.provenance.span.text == written


def test_an_object_is_shown_with_its_fields(arm: Robot):
    assert explain(arm, "joints/elbow/limits").text == (
        "joints/elbow/limits:\n  lower: 0\n  upper: 1.5707963267948966\n  effort: 20\n  velocity: 1"
    )


def test_what_was_built_in_python_was_written_nowhere():
    assert explain(Robot("r", links=[Link("a")]), "links/a/physics/mu") == Explanation("links/a/physics/mu: 1")


@pytest.mark.parametrize(
    ("path", "expected", "near"),
    [
        ("joint/elbow", "there is no 'joint' in the robot", "joints"),
        ("joints/elbw/limits", "there is no 'elbw' in 'joints'", "elbow"),
        ("joints/elbow/limits/efort", "there is no 'efort' in 'joints/elbow/limits'", "effort"),
        ("links/upper/visual/1/box", "there is no '1' in 'links/upper/visual/0'", "box"),
        ("name/first", "there is no 'first' in 'name'", None),
    ],
)
def test_a_path_that_does_not_exist_is_reported_where_it_ends(arm: Robot, path: str, expected: str, near: str | None):
    with pytest.raises(UnknownPathError, match=expected) as caught:
        explain(arm, path)
    assert near in caught.value.names if near else not caught.value.names


def test_an_overridden_value_is_reported_at_the_overriding_file(tmp_path: Path):
    override = "    override: {joints: {elbow: {limits: {velocity: 2}}}, links: {upper: {visual: {sphere: 0.2}}}}\n"
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL + override)
    robot = compile_file(tmp_path / "cell.robot.yaml").result()
    for path in ("joints/left_elbow/limits/velocity", "links/left_upper/visual/sphere/radius"):
        found = explain(robot, path)
        assert (found.is_written, line(found), uses(found)) == (True, 9, ())


def test_a_long_chain_of_states_is_explained_in_bounded_steps():
    groups = "".join(f"    g{number}: {{joints: [elbow]}}\n" for number in range(300))
    states = "".join(f"    g{number}: {{home: {{g{number - 1}: home}}}}\n" for number in range(1, 300))
    semantic = f"semantic:\n  groups:\n{groups}  group_states:\n    g0: {{home: {{elbow: 0.5}}}}\n{states}"
    robot = compile_text(ARM[: ARM.index("semantic:")] + semantic).result()
    assert [explain(robot, f"semantic/group_states/g{number}/home/elbow").is_written for number in (99, 299)] == [
        True,
        False,
    ]
