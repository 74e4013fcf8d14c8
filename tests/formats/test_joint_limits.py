"""joint_limits.yaml, with the parameters that MoveIt's robot model loader and Pilz's planner declare."""

from pathlib import Path

import pytest
import yaml

from linkforge_compile import compile_file, compile_text
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.formats import JOINT_LIMITS, Rendering
from tests.conftest import ROOT
from tests.ros_parameters import parameters_in, require_declared

CASE = ROOT / "tests" / "cases" / "good" / "planning" / "planning.robot.yaml"
GOLDEN = CASE.with_name("planning_joint_limits.yaml")
KINDS = "(velocity|acceleration|deceleration|jerk)"
DECLARED = {
    "default_(velocity|acceleration)_scaling_factor": "double",
    rf"joint_limits\..+\.has_{KINDS}_limits": "bool",
    rf"joint_limits\..+\.max_{KINDS}": "double",
}


def robot_of(text: str):
    compilation = compile_text(f"linkforge: 1\nname: robot\n{text}")
    assert compilation.robot is not None, compilation.diagnostics
    return compilation.robot


def written(text: str) -> dict[str, dict[str, object]]:
    limits: dict[str, dict[str, object]] = yaml.safe_load(JOINT_LIMITS.render(robot_of(text), Rendering())[0].text)
    return limits["joint_limits"]


def reported(text: str) -> list[str]:
    return [f"{one.code.id} {one.message}" for one in group_alike(JOINT_LIMITS.limits(robot_of(text), {}))]


def joint(name: str, limits: str, kind: str = "revolute") -> str:
    return (
        "links: {base: , arm: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}\n"
        f"joints:\n  {name}: {{type: {kind}, parent: base, child: arm, axis: x, limits: {{effort: 1, {limits}}}}}\n"
    )


def test_the_case_compiles_to_the_file_next_to_it(update_golden: bool):
    robot = compile_file(CASE).result()
    banner = "Compiled by linkforge from planning.robot.yaml; edit that file, not this one."
    text = JOINT_LIMITS.render(robot, Rendering(banner=banner))[0].text
    if update_golden:
        GOLDEN.write_text(text, "utf-8")
    assert text == GOLDEN.read_text("utf-8")


def test_moveit_declares_what_is_written():
    require_declared(parameters_in(GOLDEN.read_text("utf-8")), DECLARED)


def test_whole_numbers_are_doubles_and_units_are_those_of_the_motion():
    limits = "lower: 0, upper: 1, velocity: 2, acceleration: 300 mm/s^2, jerk: 4 m/s^3"
    assert written(joint("slide", limits, "prismatic")) == {
        "slide": {
            "has_velocity_limits": True,
            "max_velocity": 2.0,
            "has_acceleration_limits": True,
            "max_acceleration": 0.3,
            "has_jerk_limits": True,
            "max_jerk": 4.0,
        }
    }


def test_a_deceleration_is_negative_for_pilz():
    limits = written(joint("turn", "velocity: 2, acceleration: 3, deceleration: 5"))["turn"]
    assert (limits["has_deceleration_limits"], limits["max_deceleration"]) == (True, -5.0)


def test_a_velocity_of_zero_is_no_limit_as_for_moveit():
    assert written(joint("turn", "velocity: 0"))["turn"] == {
        "has_velocity_limits": False,
        "has_acceleration_limits": False,
    }


@pytest.mark.parametrize("name", ["yes", "n", "1e3", "007", "a.b", "0x1F", "null"])
def test_a_name_that_yaml_reads_as_another_value_is_quoted(name: str):
    assert list(written(joint(f"'{name}'", "velocity: 1, acceleration: 1"))) == [name]


@pytest.mark.parametrize("kind", ["velocity", "acceleration"])
def test_what_moveit_cannot_plan_without_is_reported_for_all_joints_at_once(kind: str):
    given = "acceleration: 1, velocity: 0" if kind == "velocity" else "velocity: 1"
    text = joint("turn", given).replace("arm:", "hand: , arm:") + (
        f"  twist: {{type: continuous, parent: arm, child: hand, axis: x, limits: {{effort: 1, {given}}}}}\n"
    )
    assert reported(text) == [
        f"LF7601 MoveIt cannot plan motions of 'turn' without a maximum {kind}; write `{kind}` in its `limits`; the "
        f"same "
        "for 'twist'"
    ]


def test_joints_outside_of_all_groups_are_not_planned():
    text = joint("turn", "velocity: 1, acceleration: 1").replace("base: ", "base: , wheel: ") + (
        "  roll: {type: continuous, parent: base, child: wheel, axis: x, limits: {effort: 1, velocity: 1}}\n"
        "semantic: {groups: {arm: {joints: [turn]}}}\n"
    )
    assert reported(text) == []
    assert list(written(text)) == ["turn", "roll"]


def test_a_robot_that_cannot_move_has_no_limits():
    diagnostic = JOINT_LIMITS.missing(robot_of("links: {base: }"))
    assert diagnostic is not None
    assert diagnostic.code.id == "LF7602"


def test_each_line_leads_to_its_place_in_the_spec():
    document = JOINT_LIMITS.render(compile_file(CASE).result(), Rendering(banner="head", has_map=True))[0]
    assert document.text.splitlines()[1:] == GOLDEN.read_text("utf-8").splitlines()[1:]
    assert document.map is not None
    spec = CASE.read_text("utf-8").splitlines()
    shown = {}
    for number, line in enumerate(document.text.splitlines(), start=1):
        if place := document.map.at(number):
            shown[line] = spec[place.span.line - 1][place.span.column - 1 : place.span.end_column - 1]
    assert shown["  shoulder:"] == "shoulder"
    assert shown["    max_jerk: 34.90658503988659"] == "2000 deg/s^3"
    assert shown["    max_deceleration: -8.0"] == "8"
    assert "joint_limits:" not in shown


def test_a_template_of_the_users_replaces_that_of_linkforge(tmp_path: Path):
    (tmp_path / "joint_limits").mkdir()
    template = "{% for joint in joint_limits.joints %}\n- {{ joint.name | to_yaml }}\n{% endfor %}\n"
    (tmp_path / "joint_limits" / "joint_limits.yaml.j2").write_text(template)
    robot = compile_file(CASE).result()
    (document,) = JOINT_LIMITS.render(robot, Rendering(templates=tmp_path))
    assert yaml.safe_load(document.text) == ["shoulder", "elbow", "wrist", "left_finger_joint"]
