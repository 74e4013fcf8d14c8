"""Sensors: the fields of the IR under the keys of the language, in SI units."""

import math

import pytest

from linkforge_compile.core import CameraInfo, IMUInfo, LidarInfo, Sensor, SensorType, Vector3
from tests.lower.specs import Spec, robot_of

SPEC = """
    name: cart
    links: {{base: }}
    sensors:
      one: {{{}}}
"""


def sensor(fields: str) -> Sensor:
    [found] = robot_of(SPEC.format(fields)).sensors
    return found


def test_the_keys_are_the_fields_of_the_model():
    eye = sensor(
        "type: camera, link: base, origin: [50 mm, 0, 0], update_rate: 2 kHz, always_on: false, visualize: true, "
        "topic: 1.0, frame: optical"
    )
    assert (eye.name, eye.type, eye.link_name) == ("one", SensorType.CAMERA, "base")
    assert eye.origin.xyz == Vector3(0.05, 0, 0)
    assert (eye.update_rate, eye.always_on, eye.visualize) == (2000, False, True)
    assert (eye.topic, eye.frame) == ("1.0", "optical")


def test_units_become_si():
    info = sensor(
        "type: camera, link: base, camera: {horizontal_fov: 90 deg, near_clip: 20 mm, far_clip: 1 km}"
    ).camera_info
    assert info == CameraInfo(horizontal_fov=math.pi / 2, near_clip=0.02, far_clip=1000)
    noise = sensor("type: imu, link: base, imu: {angular_velocity_noise: {stddev: 180 deg/s}}").imu_info
    assert noise.angular_velocity_noise.stddev == math.pi


@pytest.mark.parametrize("kind", ["camera", "depth_camera", "rgbd_camera", "lidar", "imu", "gps", "force_torque"])
def test_what_a_type_measures_has_defaults(kind: str):
    one = sensor(f"type: {kind}, link: base")
    infos = [one.camera_info, one.lidar_info, one.imu_info, one.gps_info, one.force_torque_info]
    assert len([info for info in infos if info]) == 1


@pytest.mark.parametrize("kind", ["ray", "gpu_lidar"])
def test_a_lidar_of_the_simulator_may_do_without_its_rays(kind: str):
    assert sensor(f"type: {kind}, link: base").lidar_info is None
    assert sensor(f"type: {kind}, link: base, lidar: {{}}").lidar_info == LidarInfo()


def test_an_empty_info_is_accepted():
    assert sensor("type: imu, link: base, imu: {}").imu_info == IMUInfo()


def test_a_faulty_sensor_is_reported_completely_and_its_name_stays_known():
    assert robot_of("""
        name: cart
        links: {base: }
        sensors:
          eye:
            type: camera
            link: base
            update_rate: fast   # E[LF5001]:18 update_rate takes a frequency such as '20 Hz', found 'fast'
            camera:
              width: 1.5   # E[LF5001]:14 width takes a whole number, found 1.5
              near_clip: 0   # E[LF5006]:18 near_clip must be above 0 m, found 0
    """).sensors


def test_a_sensor_its_frame_and_relative_topic_get_the_prefix():
    robot = robot_of(
        Spec(
            """
            name: cart
            links: {base: }
            modules:
              left: {parent: base}
            """,
            {
                "left": Spec("""
                    name: eye
                    links: {head: }
                    sensors:
                      eye: {type: camera, link: head, topic: image, frame: optical}
                """)
            },
        )
    )
    eye = robot.sensor("left_eye")
    assert (eye.link_name, eye.topic, eye.frame) == ("left_head", "left_image", "left_optical")
