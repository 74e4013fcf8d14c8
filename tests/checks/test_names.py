import pytest

from linkforge_compile.core import (
    EndEffector,
    GroupState,
    IMUInfo,
    PassiveJoint,
    PlanningGroup,
    Ros2Control,
    Ros2ControlSensor,
    SemanticRobotDescription,
    Sensor,
    SensorType,
    Transmission,
    VirtualJoint,
)
from tests.checks.robots import messages_of, robot, turning

GROUP = PlanningGroup("all", links=("base",))
ARM = PlanningGroup("arm", links=("arm",))

HARDWARE = Ros2Control("x", hardware_plugin="mock", sensors=(Ros2ControlSensor("imu", ("orientation.x",)),))


@pytest.mark.parametrize(
    ("collection", "kind", "part"),
    [
        ("sensors", "sensor", Sensor("x", SensorType.IMU, "base", imu_info=IMUInfo())),
        ("transmissions", "transmission", Transmission.create_simple("x", "shoulder")),
        ("ros2_controls", "ros2_control system", HARDWARE),
    ],
)
def test_two_parts_of_one_name_are_reported(collection: str, kind: str, part: object):
    subject = robot("base arm", turning("shoulder", "base", "arm"), **{collection: [part, part]})
    assert messages_of(subject) == [f"LF4101 there are two {kind}s named 'x'"]


@pytest.mark.parametrize(
    ("collection", "message", "part"),
    [
        ("groups", "there are two planning groups named 'x'", PlanningGroup("x", links=("arm",))),
        ("end_effectors", "there are two end effectors named 'x'", EndEffector("x", "arm", "base")),
        ("virtual_joints", "there are two virtual joints named 'x'", VirtualJoint("x", "fixed", "world", "base")),
        ("passive_joints", "there are two passive joints named 'shoulder'", PassiveJoint("shoulder")),
        ("group_states", "planning group 'all': there are two group states named 'x'", GroupState("x", "all")),
    ],
)
def test_two_semantic_parts_of_one_name_are_reported(collection: str, message: str, part: object):
    semantic = SemanticRobotDescription(**{"groups": (GROUP, ARM), collection: (part, part)})
    assert messages_of(robot("base arm", turning("shoulder", "base", "arm"), semantic=semantic)) == [
        f"LF4101 {message}"
    ]


def test_states_of_different_groups_may_share_a_name():
    groups = (GROUP, PlanningGroup("base", links=("base",)))
    semantic = SemanticRobotDescription(groups=groups, group_states=(GroupState("x", "all"), GroupState("x", "base")))
    assert messages_of(robot("base arm", turning("shoulder", "base", "arm"), semantic=semantic)) == []


def test_a_joint_may_not_be_named_as_a_link():
    assert messages_of(robot("base wrist", turning("wrist", "base", "wrist"))) == [
        "LF4108 a link and a joint are both named 'wrist', which Gazebo refuses; rename one of them"
    ]


def test_names_that_gazebo_keeps_for_itself():
    subject = robot("base __model__ ____", turning("world", "base", "__model__"), turning("__", "base", "____"))
    assert messages_of(subject) == [
        "LF4002 Gazebo refuses a link named '__model__', which it reserves; choose another name",
        "LF4002 Gazebo refuses a link named '____', which it reserves; choose another name",
        "LF4002 Gazebo refuses a joint named 'world', which it reserves; choose another name",
    ]


def test_world_is_the_root_and_nothing_else():
    assert messages_of(robot("world base", turning("stand", "world", "base"))) == []
    assert messages_of(robot("base world", turning("stand", "base", "world"))) == [
        "LF4002 Gazebo refuses a link named 'world', which it reserves; choose another name"
    ]


def test_tf2_refuses_frames_with_a_slash_before_them():
    assert messages_of(robot("/base a/b", turning("/j", "/base", "a/b"))) == [
        "LF4003 tf2 refuses frame '/base', which begins with '/'; remove the '/'"
    ]
