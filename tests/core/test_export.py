"""Exporting is a method of the robot: checked first, unless one says not to."""

import pytest

from linkforge_compile.core import Joint, Link, Robot, RobotGeneratorError


def test_a_robot_is_written_as_urdf_and_srdf():
    robot = Robot("arm", links=[Link("base"), Link("tool")], joints=[Joint("weld", "fixed", "base", "tool")])
    robot.disable_collisions("base", "tool")
    assert '<joint name="weld" type="fixed">' in robot.export_urdf()
    assert '<disable_collisions link1="base" link2="tool" reason="Adjacent"/>' in robot.export_srdf()


@pytest.mark.parametrize("export", [Robot.export_urdf, Robot.export_srdf], ids=["urdf", "srdf"])
def test_what_no_check_lets_pass_is_written_only_without_validation(export):
    robot = Robot("arm", links=[Link("base"), Link("tool")])
    with pytest.raises(RobotGeneratorError, match="root"):
        export(robot)
    assert '<robot name="arm"' in export(robot, validate=False)


def test_a_chain_of_ten_thousand_links_can_be_exported():
    robot = Robot("snake", links=[Link(f"l{number}") for number in range(10_000)])
    robot.joints = [Joint(f"j{number}", "fixed", f"l{number}", f"l{number + 1}") for number in range(9_999)]
    assert robot.export_urdf().count("<joint ") == 9_999
