import pytest

from linkforge_compile.core import (
    EndEffector,
    GroupState,
    IMUInfo,
    PassiveJoint,
    PlanningGroup,
    Ros2Control,
    SemanticRobotDescription,
    Sensor,
    SensorType,
    Transmission,
    VirtualJoint,
)
from tests.checks.robots import robot, told, turning

GROUP = PlanningGroup("all", links=("base",))


@pytest.mark.parametrize(
    ("collection", "kind", "part"),
    [
        ("sensors", "sensor", Sensor("x", SensorType.IMU, "base", imu_info=IMUInfo())),
        ("transmissions", "transmission", Transmission.create_simple("x", "shoulder")),
        ("ros2_controls", "ros2_control system", Ros2Control("x", hardware_plugin="mock")),
    ],
)
def test_two_parts_of_one_name_are_told(collection: str, kind: str, part: object):
    subject = robot("base arm", turning("shoulder", "base", "arm"), **{collection: [part, part]})
    assert told(subject) == [f"LF4101 there are two {kind}s named 'x'"]


@pytest.mark.parametrize(
    ("collection", "message", "part"),
    [
        ("groups", "there are two planning groups named 'x'", PlanningGroup("x", links=("arm",))),
        ("end_effectors", "there are two end effectors named 'x'", EndEffector("x", "all", "arm")),
        ("virtual_joints", "there are two virtual joints named 'x'", VirtualJoint("x", "fixed", "world", "base")),
        ("passive_joints", "there are two passive joints named 'shoulder'", PassiveJoint("shoulder")),
        ("group_states", "planning group 'all': there are two group states named 'x'", GroupState("x", "all")),
    ],
)
def test_two_semantic_parts_of_one_name_are_told(collection: str, message: str, part: object):
    semantic = SemanticRobotDescription(**{"groups": (GROUP,), collection: (part, part)})
    assert told(robot("base arm", turning("shoulder", "base", "arm"), semantic=semantic)) == [f"LF4101 {message}"]


def test_states_of_different_groups_may_share_a_name():
    groups = (GROUP, PlanningGroup("arm", links=("arm",)))
    semantic = SemanticRobotDescription(groups=groups, group_states=(GroupState("x", "all"), GroupState("x", "arm")))
    assert told(robot("base arm", turning("shoulder", "base", "arm"), semantic=semantic)) == []
