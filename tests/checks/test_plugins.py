import pytest

from linkforge_compile.core import GazeboElement, GazeboPlugin, Robot, Ros2Control, Ros2ControlJoint
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import messages_of, robot, turning

DRIVEN = Ros2ControlJoint("shoulder", ("position",))


def arm(*plugins: GazeboPlugin, **parts: object) -> Robot:
    blocks = [GazeboElement(plugins=plugins)]
    return robot("base arm", turning("shoulder", "base", "arm"), **{"gazebo_elements": blocks, **parts})


def plugin(**parameters: object) -> GazeboPlugin:
    return GazeboPlugin("drive", "libdrive.so", parameters)  # type: ignore[arg-type]


@pytest.mark.parametrize("tag", ["joint_name", "left_joint", "front_right_joint"])
def test_a_joint_that_a_plugin_will_not_find_is_noted(tag: str):
    assert messages_of(arm(plugin(**{tag: ["shoulder", " sholder "]}))) == [
        "LF4203 plugin 'drive': no joint named 'sholder' for plugin 'drive'; did you mean 'shoulder'?"
    ]


@pytest.mark.parametrize(
    "parameters",
    [
        {"joint_name": "shoulder"},
        {"joint_name": "other::elbow"},
        {"publish_joint": "true"},
        {"nth_joint": "3"},
        {"joint": "elbow"},
        {"left_joint": {"_index": "elbow"}},
        {"left_joint": ""},
    ],
)
def test_values_without_a_known_meaning_are_not_checked(parameters: dict[str, object]):
    assert messages_of(arm(plugin(**parameters))) == []


def test_a_joint_that_is_known_to_be_missing_is_not_reported_again():
    assert messages_of(arm(plugin(joint_name="lost")), UnresolvedNames(frozenset({"lost"}))) == []


def simulated(package: str, *plugins: GazeboPlugin, **parts: object) -> list[str]:
    hardware = Ros2Control("hw", hardware_plugin=f"{package}/System", joints=(DRIVEN,))
    return messages_of(arm(*plugins, ros2_controls=[hardware], **parts))


def test_hardware_in_gazebo_wants_its_plugin():
    assert simulated("gz_ros2_control") == [
        "LF6113 ros2_control 'hw': 'gz_ros2_control/System' runs in Gazebo's plugin 'gz_ros2_control-system', "
        "which this robot does not load; add it to 'gazebo'"
    ]


def test_hardware_in_gazebo_is_satisfied_by_a_plugin_or_raw_xml():
    assert simulated("gz_ros2_control", GazeboPlugin("any", "libgz_ros2_control-system.so")) == []
    raw = GazeboElement(extra_elements=["<plugin filename='libgz_ros2_control-system.so'/>"])
    assert simulated("gz_ros2_control", gazebo_elements=[raw]) == []
    assert simulated("mock_components") == []
