"""Numbers that a xacro computes of literals alone keep their formulas."""

from pathlib import Path

import pytest

from tests.migration.migrated import migrated

ROBOT = """
<xacro:property name="M_PI" value="3.1415926535897931"/>
<xacro:property name="plate" value="0.2"/>
<xacro:property name="speed" value="{}"/>
<link name="base"/>
<link name="arm"/>
<joint name="elbow" type="revolute">
  <origin xyz="{} 0 0" rpy="{} 0 0"/>
  <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  <limit lower="0" upper="{}" effort="{}" velocity="${{speed}}"/>
</joint>
"""


def test_a_formula_of_literals_is_kept(tmp_path: Path):
    formulas = ("${radians(33.3)}", "${plate/2 + 15*0.0254}", "${-pi/7}", "${M_PI/7}", "${280.0*1e-6*9.81}")
    robot = migrated(tmp_path, ROBOT.format(*formulas)).robot
    assert "speed: $(33.3 * (pi / 180))" in robot
    assert "xyz: [$(plate / 2 + 15 * 0.0254), 0, 0]" in robot
    assert "rpy: [$(-pi / 7), 0, 0]" in robot
    assert "upper: $(pi / 7)" in robot
    assert "effort: $(280.0 * 1e-06 * 9.81)" in robot


def test_a_sign_before_a_formula_is_in_it(tmp_path: Path):
    robot = migrated(tmp_path, ROBOT.format("1", "-${2*0.3}", "${-radians(0.1234567)}", "2", "${sqrt(2)}")).robot
    assert "xyz: [$(-(2 * 0.3)), 0, 0]" in robot
    assert "rpy: [$(-(0.1234567 * (pi / 180))), 0, 0]" in robot
    assert "effort: $(sqrt(2))" in robot


@pytest.mark.parametrize(("formula", "angle"), [("${radians(30)}", "30 deg"), ("${pi/2}", "90 deg")])
def test_an_angle_that_is_round_in_degrees_is_written_in_them(formula: str, angle: str, tmp_path: Path):
    assert f"rpy: [{angle}, 0, 0]" in migrated(tmp_path, ROBOT.format("1", "1", formula, "2", "1")).robot


@pytest.mark.parametrize("formula", ["${-0.3}", "${0.1 * 0}", "${0.1 * 10}"])
def test_a_number_without_operators_and_0_and_1_are_numbers(formula: str, tmp_path: Path):
    assert "$(" not in migrated(tmp_path, ROBOT.format("1", "1", "1", "2", formula)).robot.partition("effort")[2][:8]


def test_the_default_of_an_argument_is_a_number(tmp_path: Path):
    text = '<xacro:arg name="r" default="${2*0.3}"/><link name="base"><visual><geometry><sphere radius="$(arg r)"/>'
    assert "r: {type: length, default: 0.6}" in migrated(tmp_path, f"{text}</geometry></visual></link>").robot
