import pytest

from linkforge_compile.core import JointLimits, Robot, Ros2Control, Ros2ControlGpio, Ros2ControlJoint, Ros2ControlSensor
from linkforge_compile.core.models.ros2_control import Interface
from tests.checks.robots import fixed, messages_of, robot, turning


def system(*joints: Ros2ControlJoint, **parts: object) -> Ros2Control:
    return Ros2Control("hw", hardware_plugin="mock", joints=joints, **parts)  # type: ignore[arg-type]


def arm(*joints: Ros2ControlJoint, limits: JointLimits | None = None) -> Robot:
    return robot("base arm", turning("shoulder", "base", "arm", limits=limits), ros2_controls=[system(*joints)])


def ranged(**parameters: str) -> Robot:
    return arm(Ros2ControlJoint("shoulder", (Interface("position", parameters),)))


@pytest.mark.parametrize(
    ("name", "meant"),
    [("postion", "position"), ("Velocity", "velocity"), ("efort", "effort"), ("positions", "position")],
)
def test_an_interface_that_is_nearly_one_of_ros2_control(name: str, meant: str):
    assert messages_of(arm(Ros2ControlJoint("shoulder", (), (name,)))) == [
        f"LF6107 ros2_control 'hw': ros2_control defines no interface '{name}'; did you mean '{meant}'?"
    ]


@pytest.mark.parametrize("name", ["position", "torque", "stiffness", "position_2", "velocity.filtered", "enable"])
def test_interfaces_of_hardware_are_its_own(name: str):
    assert messages_of(arm(Ros2ControlJoint("shoulder", (name,)))) == []


@pytest.mark.parametrize("parameters", [{"min": "-0.5", "max": "0.5"}, {"min": "-1e9"}, {"initial_value": "1"}, {}])
def test_ranges_that_agree_with_the_joint(parameters: dict[str, str]):
    assert messages_of(ranged(**parameters)) == []


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"min": "-90 deg"}, "LF6108 {}min must be a number in SI units for ros2_control, found '-90 deg'"),
        ({"min": "0.5", "max": "-0.5"}, "LF6109 {}min must not be above max, found 0.5 and -0.5"),
        (
            {"min": "1.5", "max": "2"},
            "LF6110 {}joint 'shoulder' goes from -1 to 1 rad, which does not overlap with 1.5 to 2",
        ),
        ({"initial_value": "-1.5"}, "LF6111 {}joint 'shoulder' goes from -1 to 1 rad, but starts at -1.5"),
    ],
)
def test_ranges_that_do_not(parameters: dict[str, str], message: str):
    assert messages_of(ranged(**parameters)) == [message.format("ros2_control 'hw': ")]


def test_a_velocity_has_a_range_of_its_own():
    driven = Ros2ControlJoint("shoulder", (Interface("velocity", {"min": "-9", "max": "-5"}),))
    assert messages_of(arm(driven)) == []


def gripper(*joints: Ros2ControlJoint) -> Robot:
    left, right = turning("left", "palm", "a"), turning("right", "palm", "b", mimic="left")
    return robot("palm a b", left, right, ros2_controls=[system(*joints)])


LEFT = Ros2ControlJoint("left", ("position",))
READ = Ros2ControlJoint("right", (), ("position",))
DRIVEN = Ros2ControlJoint("right", ("position",), extra_attributes=[("mimic", "false")])


def test_a_mimic_joint_is_read_in_the_system_of_its_leader():
    assert messages_of(gripper(LEFT, READ)) == []
    assert messages_of(gripper(READ)) == [
        "LF6105 ros2_control 'hw': joint 'right' mimics 'left', which is not in this ros2_control system; "
        "list both joints in one system"
    ]


def test_a_mimic_joint_is_not_commanded_by_default():
    assert messages_of(gripper(LEFT, DRIVEN)) == []
    assert messages_of(gripper(LEFT, Ros2ControlJoint("right", ("position",)))) == [
        "LF6104 ros2_control 'hw': joint 'right' mimics 'left', so ros2_control refuses to command it; "
        "keep only its state interfaces"
    ]


def test_a_mimic_of_the_hardware_wants_one_of_the_joint():
    joint = Ros2ControlJoint("left", (), ("position",), extra_attributes=[("mimic", "true")])
    assert messages_of(gripper(joint)) == [
        "LF6106 ros2_control 'hw': joint 'left' should mimic another joint in ros2_control, but has no 'mimic' itself"
    ]


def test_hardware_without_interfaces_is_noted():
    empty = Ros2Control("empty", hardware_plugin="mock")
    idle = system(
        sensors=(Ros2ControlSensor("imu"),),
        gpios=(Ros2ControlGpio("pins", parameters={"bank": "2"}), Ros2ControlGpio("gpio")),
    )
    subject = robot("base tool", fixed("flange", "base", "tool"), ros2_controls=[empty, idle])
    assert messages_of(subject) == [
        "LF6112 ros2_control 'empty': ros2_control 'empty' has no interface, so no controller can use it",
        "LF6112 ros2_control 'hw': gpio 'pins' has no interface, so no controller can use it",
        "LF6112 ros2_control 'hw': sensor 'imu' has no interface, so no controller can use it",
    ]
