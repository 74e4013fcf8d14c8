import pytest

from linkforge_compile.core import IMUInfo, Robot, Sensor, SensorType
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import messages_of, robot, turning


def imu(name: str, link: str = "arm", **fields: object) -> Sensor:
    return Sensor(name, SensorType.IMU, link, imu_info=IMUInfo(), **fields)  # type: ignore[arg-type]


def arm(*sensors: Sensor) -> Robot:
    return robot("base arm", turning("shoulder", "base", "arm"), sensors=sensors)


def test_a_sensor_on_an_unknown_link_is_reported():
    assert messages_of(arm(imu("tilt", "arms"))) == ["LF4102 sensor 'tilt': no link named 'arms'; did you mean 'arm'?"]


def test_a_frame_that_no_link_has_is_reported():
    assert messages_of(arm(imu("tilt", frame="arm"))) == []
    assert messages_of(arm(imu("tilt", frame="arms"))) == [
        "LF4202 sensor 'tilt': no link named 'arms', so tf2 cannot tell where this frame is; did you mean 'arm'?"
    ]
    assert messages_of(arm(imu("tilt", frame="arms")), UnresolvedNames(frozenset({"arms"}))) == []


@pytest.mark.parametrize("topic", ["imu", "/imu", "~", "~/imu", "a/b_2/C", "/{node}/imu", "x{robot}_imu", "a__b", "_2"])
def test_topics_that_ros_accepts(topic: str):
    assert messages_of(arm(imu("tilt", topic=topic))) == []


@pytest.mark.parametrize(
    ("topic", "reason"),
    [
        ("front-imu", "'-' is not allowed"),
        ("front imu", "' ' is not allowed"),
        ("größe", "'ö' is not allowed"),
        ("٣", "'٣' is not allowed"),
        ("2d_scan", "'2d_scan' begins with a digit"),
        ("left/2d/scan", "'2d' begins with a digit"),
        ("/imu/", "it ends with '/'"),
        ("/", "it ends with '/'"),
        ("a//b", "there is no name between '//'"),
        ("a~b", "'~' is allowed only at the start, before '/'"),
        ("~imu", "'~' is allowed only at the start, before '/'"),
        ("~~", "'~' is allowed only at the start, before '/'"),
        ("{node", "its braces contain no name"),
        ("{}/imu", "its braces contain no name"),
        ("{2d}/imu", "its braces contain no name"),
        ("{a/b}", "its braces contain no name"),
    ],
)
def test_topics_that_ros_refuses(topic: str, reason: str):
    assert messages_of(arm(imu("tilt", topic=topic))) == [
        f"LF4004 sensor 'tilt': ROS 2 refuses topic '{topic}': {reason}"
    ]


def test_two_sensors_on_one_topic_are_reported_once_each():
    assert messages_of(arm(imu("a", topic="imu"), imu("b", topic="/imu"), imu("c"), imu("d"))) == [
        "LF4109 sensor 'b': sensors 'a' and 'b' both publish on topic '/imu'"
    ]
