from linkforge_compile.checks import check
from linkforge_compile.core import (
    GazeboElement,
    IMUInfo,
    Robot,
    Ros2Control,
    Ros2ControlJoint,
    Ros2ControlSensor,
    Sensor,
    SensorType,
    Transmission,
)
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import fixed, messages_of, robot, turning


def arm(**parts: object) -> Robot:
    return robot("base arm", turning("shoulder", "base", "arm"), **parts)


def system(name: str, *joints: Ros2ControlJoint, sensors: tuple[Ros2ControlSensor, ...] = ()) -> Ros2Control:
    return Ros2Control(name, hardware_plugin="mock", joints=joints, sensors=sensors)


def imu(name: str, link: str) -> Sensor:
    return Sensor(name, SensorType.IMU, link, imu_info=IMUInfo())


def test_a_transmission_of_an_unknown_joint_is_reported():
    subject = arm(transmissions=[Transmission.create_simple("t", "elbow")])
    assert messages_of(subject) == ["LF4103 transmission 't': no joint named 'elbow'"]


def test_a_system_of_an_unknown_joint_is_reported():
    subject = arm(ros2_controls=[system("hw", Ros2ControlJoint("sholder", ("position",)))])
    assert messages_of(subject) == ["LF4103 ros2_control 'hw': no joint named 'sholder'; did you mean 'shoulder'?"]


def test_sensors_of_a_system_are_names_of_the_hardware():
    assert messages_of(arm(ros2_controls=[system("hw", sensors=(Ros2ControlSensor("tcp_fts", ("force.x",)),))])) == []


def test_a_fixed_joint_has_nothing_to_command():
    subject = robot("base arm", fixed("bolt", "base", "arm"))
    subject.ros2_controls = [system("hw", Ros2ControlJoint("bolt", ("position",)))]
    assert messages_of(subject) == [
        "LF6103 ros2_control 'hw': joint 'bolt' is fixed, so ros2_control has nothing to read or command"
    ]


def test_two_systems_may_share_a_joint_but_not_an_interface():
    subject = arm(
        ros2_controls=[
            system("first", Ros2ControlJoint("shoulder", ("position",), ("position",))),
            system("second", Ros2ControlJoint("shoulder", ("velocity", "position"), ("velocity",))),
        ]
    )
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.code.id == "LF6101"
    assert diagnostic.message == (
        "ros2_control 'second': interface 'shoulder/position' is already commanded by ros2_control 'first'"
    )


def test_a_state_that_two_systems_read_is_reported():
    sensor = Ros2ControlSensor("imu", ("orientation.x",))
    subject = arm(ros2_controls=[system("first", sensors=(sensor,)), system("second", sensors=(sensor,))])
    assert messages_of(subject) == [
        "LF6102 ros2_control 'second': interface 'imu/orientation.x' is already read by ros2_control 'first'"
    ]


def test_a_gazebo_block_about_nothing_is_reported():
    blocks = [GazeboElement(), GazeboElement("arm"), GazeboElement("shoulder"), GazeboElement("sholder")]
    assert messages_of(arm(gazebo_elements=blocks)) == [
        "LF4201 Gazebo block: no link or joint named 'sholder'; did you mean 'shoulder'?"
    ]


def test_what_is_known_to_be_missing_is_not_reported_again():
    subject = arm(
        sensors=[imu("tilt", "lost")],
        transmissions=[Transmission.create_simple("t", "lost")],
        ros2_controls=[system("hw", Ros2ControlJoint("lost", ("position",)))],
        gazebo_elements=[GazeboElement("lost")],
    )
    assert messages_of(subject, UnresolvedNames(frozenset({"lost"}))) == []
