"""Exporting is a method of the robot: checked first, unless disabled."""

import re

import numpy as np
import pytest

from linkforge_compile.core import (
    CameraInfo,
    GazeboElement,
    GazeboPlugin,
    GroupState,
    Inertial,
    Joint,
    JointLimits,
    Link,
    Robot,
    RobotGeneratorError,
    SemanticRobotDescription,
    Sensor,
    Transform,
    Vector3,
)


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


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.int32, np.int64])
def test_numbers_of_numpy_are_written_as_numbers(kind):
    robot = Robot("arm", links=[Link("base", Inertial(kind(2)))])
    robot.add_link(Link("tool"))
    robot.add_joint(Joint("weld", "fixed", "base", "tool", Transform(Vector3(*np.array([1, 2, 3], kind)))))
    robot.semantic = SemanticRobotDescription(group_states=[GroupState("home", "g", {"weld": kind(2)})])
    urdf = robot.export_urdf(validate=False)
    assert '<mass value="2"/>' in urdf
    assert 'xyz="1 2 3"' in urdf
    assert '<joint name="weld" value="2"/>' in robot.export_srdf(validate=False)


def test_arrays_of_numpy_without_dimensions_are_written_as_what_they_hold():
    axis, limits = Vector3(0, 0, 1), JointLimits(effort=np.asarray(0.25), velocity=np.asarray(2))
    robot = Robot("arm", links=[Link("base", Inertial(np.asarray(0.5))), Link("tool")])
    robot.add_joint(Joint("spin", "continuous", "base", "tool", axis=axis, limits=limits))
    urdf = robot.export_urdf(validate=False)
    assert '<mass value="0.5"/>' in urdf
    assert '<limit effort="0.25" velocity="2"/>' in urdf


@pytest.mark.parametrize("true", [np.True_, np.asarray(True)])
def test_a_boolean_of_numpy_is_written_as_a_boolean(true):
    sensor = Sensor("eye", "camera", "base", always_on=true, camera_info=CameraInfo())
    urdf = Robot("arm", links=[Link("base")], sensors=[sensor]).export_urdf(validate=False)
    assert "<always_on>true</always_on>" in urdf


def test_values_of_numpy_in_a_free_part_are_written_as_those_of_python():
    plugin = GazeboPlugin("light", "light.so", {"on": np.True_, "gain": [np.asarray(0.5), np.int8(3)]})
    urdf = Robot("arm", links=[Link("base")], gazebo_elements=[GazeboElement(plugins=[plugin])]).export_urdf()
    assert re.findall("<(on|gain)>(.*)</", urdf) == [("on", "true"), ("gain", "0.5"), ("gain", "3")]


def test_a_version_that_was_set_later_is_written():
    robot = Robot("arm", links=[Link("base")])
    assert "version=" not in robot.export_urdf().split("<link")[0].split("<robot")[1]
    robot.version = "2.0"
    assert '<robot name="arm" version="2.0">' in robot.export_urdf(validate=False)
