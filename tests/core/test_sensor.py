"""Sensors and the properties of their types."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    GPSInfo,
    IMUInfo,
    LidarInfo,
    Sensor,
    SensorNoise,
    SensorType,
)

INFOS = {
    "camera_info": CameraInfo(),
    "lidar_info": LidarInfo(),
    "imu_info": IMUInfo(),
    "gps_info": GPSInfo(),
    "contact_info": ContactInfo("bumper"),
    "force_torque_info": ForceTorqueInfo(),
}
NEEDS = {
    "camera": "camera_info",
    "depth_camera": "camera_info",
    "rgbd_camera": "camera_info",
    "lidar": "lidar_info",
    "imu": "imu_info",
    "gps": "gps_info",
    "contact": "contact_info",
    "force_torque": "force_torque_info",
}


@pytest.mark.parametrize("kind", SensorType)
def test_a_sensor_needs_the_info_of_its_type_except_for_ray_and_gpu_lidar(kind):
    assert Sensor("front", kind, "head", **INFOS).type is kind
    if kind in {"ray", "gpu_lidar"}:
        assert Sensor("front", kind, "head").lidar_info is None
        return
    with pytest.raises(RobotValidationError) as caught:
        Sensor("front", kind, "head")
    assert caught.value.code is ValidationErrorCode.INVALID_VALUE
    assert caught.value.field == (NEEDS[kind].removesuffix("_info"),)


@pytest.mark.parametrize(
    ("make", "code", "field"),
    [
        (lambda: Sensor("", "ray", "head"), ValidationErrorCode.NAME_EMPTY, "name"),
        (lambda: Sensor("front", "ray", ""), ValidationErrorCode.NAME_EMPTY, "link"),
        (lambda: Sensor("front", "ray", "head", 0), ValidationErrorCode.OUT_OF_RANGE, "update_rate"),
        (lambda: CameraInfo(0), ValidationErrorCode.OUT_OF_RANGE, "horizontal_fov"),
        (lambda: CameraInfo(3.15), ValidationErrorCode.OUT_OF_RANGE, "horizontal_fov"),
        (lambda: CameraInfo(width=0), ValidationErrorCode.OUT_OF_RANGE, "width"),
        (lambda: CameraInfo(height=-1), ValidationErrorCode.OUT_OF_RANGE, "height"),
        (lambda: CameraInfo(near_clip=0), ValidationErrorCode.OUT_OF_RANGE, "near_clip"),
        (lambda: CameraInfo(near_clip=1, far_clip=1), ValidationErrorCode.OUT_OF_RANGE, "far_clip"),
        (lambda: LidarInfo(0), ValidationErrorCode.OUT_OF_RANGE, "horizontal_samples"),
        (lambda: LidarInfo(range_min=0), ValidationErrorCode.OUT_OF_RANGE, "range_min"),
        (lambda: LidarInfo(range_max=0.1), ValidationErrorCode.OUT_OF_RANGE, "range_max"),
        (lambda: LidarInfo(range_resolution=0), ValidationErrorCode.OUT_OF_RANGE, "range_resolution"),
        (lambda: LidarInfo(horizontal_min_angle=2), ValidationErrorCode.OUT_OF_RANGE, "horizontal_min_angle"),
        (lambda: LidarInfo(vertical_samples=2), ValidationErrorCode.OUT_OF_RANGE, "vertical_min_angle"),
        (lambda: ForceTorqueInfo("world"), ValidationErrorCode.INVALID_VALUE, "frame"),
        (lambda: ForceTorqueInfo("sensor", "up"), ValidationErrorCode.INVALID_VALUE, "measure_direction"),
    ],
)
def test_what_no_sensor_can_be_is_refused(make, code, field):
    with pytest.raises(RobotValidationError) as caught:
        make()
    assert caught.value.code is code
    assert caught.value.field == (field,)


def test_what_the_model_leaves_to_the_checks():
    assert CameraInfo(math.pi).horizontal_fov == math.pi
    assert LidarInfo(horizontal_resolution=-1, vertical_samples=0).vertical_samples == 0
    assert Sensor("front camera", "ray", "any link").name == "front camera"


@pytest.mark.parametrize(
    "make",
    [
        lambda bad: SensorNoise(stddev=bad),
        lambda bad: CameraInfo(far_clip=bad),
        lambda bad: LidarInfo(range_max=bad),
        lambda bad: LidarInfo(vertical_resolution=bad),
        lambda bad: Sensor("front", "ray", "head", bad),
    ],
)
def test_infinity_is_refused(make):
    with pytest.raises(RobotMathError):
        make(math.inf)


def test_a_prefix_reaches_everything_that_names():
    sensor = Sensor(
        "touch",
        SensorType.CONTACT,
        "hand",
        contact_info=ContactInfo("palm"),
        topic="touch",
        plugin=GazeboPlugin("driver", "lib.so", {"frame": "hand"}),
        frame="optical",
    ).with_prefix("left_")
    assert (sensor.name, sensor.link_name, sensor.contact_info.collision) == ("left_touch", "left_hand", "left_palm")
    assert (sensor.topic, sensor.frame) == ("left_touch", "left_optical")
    assert sensor.plugin == GazeboPlugin("left_driver", "lib.so", {"frame": "hand"})


def test_an_absolute_topic_is_kept():
    assert Sensor("front", "ray", "head", topic="/scan").with_prefix("left_").topic == "/scan"
