"""Sensors in MJCF: cameras in bodies, and what is measured at sites in bodies."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.constants import DEFAULT_CAMERA_FAR, DEFAULT_CAMERA_NEAR, NOISE_GAUSSIAN
from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ForceTorqueDirection,
    ForceTorqueFrame,
    Sensor,
    SensorNoise,
    SensorType,
)
from linkforge_compile.core.physics import rotation_matrix
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.mjcf.poses import pose
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

_CAMERAS = (SensorType.CAMERA, SensorType.DEPTH_CAMERA, SensorType.RGBD_CAMERA)

_USUAL_CLIP = (DEFAULT_CAMERA_NEAR, DEFAULT_CAMERA_FAR)

PLUGINS = "plugins of sensors"

_WIDEST = 179.0
"""MuJoCo refuses a field of view of half a turn [deg]."""


def sensor_loss(sensor: Sensor) -> str | None:
    """Return what of a sensor MuJoCo has no counterpart for; None for one that it has."""
    info = sensor.force_torque_info
    if sensor.type == SensorType.FORCE_TORQUE and info:
        is_of_parent = info.frame == ForceTorqueFrame.PARENT
        return "force-torque sensors in the frame of the parent" if is_of_parent else None
    return None if sensor.type in (*_CAMERAS, SensorType.IMU) else f"sensors of type {sensor.type}"


def sensor_losses(sensor: Sensor) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the parts of a sensor, or the whole sensor, that MuJoCo does not have, with their paths."""
    if loss := sensor_loss(sensor):
        yield loss, ("type",)
        return
    if sensor.plugin:
        yield PLUGINS, ("plugin",)
    camera, imu, wrench = sensor.camera_info, sensor.imu_info, sensor.force_torque_info
    if camera and camera.noise:
        yield "noise of cameras", ("camera", "noise")
    if camera and (camera.near_clip, camera.far_clip) != _USUAL_CLIP:
        yield "clip distances of cameras", ("camera",)
    noises = {
        ("imu", "angular_velocity_noise"): imu and imu.angular_velocity_noise,
        ("imu", "linear_acceleration_noise"): imu and imu.linear_acceleration_noise,
        ("force_torque", "noise"): wrench and wrench.noise,
    }
    for path, noise in noises.items():
        if noise and noise != SensorNoise(NOISE_GAUSSIAN, stddev=noise.stddev):
            yield "noise other than a standard deviation", path


def has_opposite_sign(sensor: Sensor) -> bool:
    """Whether a sensor is to measure the force of the child on the parent; MuJoCo's has the other direction."""
    info = sensor.force_torque_info if sensor_loss(sensor) is None else None
    return info is not None and info.measure_direction == ForceTorqueDirection.CHILD_TO_PARENT


def elements_in_body(robot: Robot, link: str) -> list[Xml]:
    """Return the cameras and sites of the sensors on a link."""
    on_link = (sensor for sensor in robot.sensors if sensor.link_name == link and sensor_loss(sensor) is None)
    return [_camera(sensor) if sensor.type in _CAMERAS else _site(sensor) for sensor in on_link]


def _site(sensor: Sensor) -> Xml:
    """Return where a sensor measures; forces are those at the joint, in axes that may be turned."""
    origin = sensor.origin
    if sensor.type == SensorType.FORCE_TORQUE:
        is_turned = sensor.force_torque_info and sensor.force_torque_info.frame == ForceTorqueFrame.SENSOR
        origin = Transform(rpy=origin.rpy) if is_turned else Transform()
    return leaf_at("site", sensor.source, name=sensor.name, **pose(origin))


def _camera(sensor: Sensor) -> Xml:
    """Return a camera: that of Gazebo looks along x with z up, that of MuJoCo along -z with y up."""
    info = sensor.camera_info or CameraInfo()
    rows = rotation_matrix(sensor.origin.rpy)
    axes = (*(-row[1] for row in rows), *(row[2] for row in rows))
    half_height = math.tan(info.horizontal_fov / 2) * info.height / info.width
    return leaf_at(
        "camera",
        sensor.source,
        name=sensor.name,
        pos=sensor.origin.xyz,
        xyaxes=axes,
        fovy=min(math.degrees(2 * math.atan(half_height)), _WIDEST),
        resolution=(info.width, info.height),
    )


def sensor_elements(robot: Robot) -> Iterator[Xml]:
    """Yield what is measured at the sites of sensors."""
    for sensor in robot.sensors:
        if sensor_loss(sensor) is None and sensor.type not in _CAMERAS:
            yield from _imu(sensor) if sensor.type == SensorType.IMU else _force_torque(sensor)


def _imu(sensor: Sensor) -> Sequence[Xml]:
    """Return the sensors of an IMU, with the names that mujoco_ros2_control looks for."""
    info, source, name = sensor.imu_info, sensor.source, sensor.name
    turning = _stddev(info.angular_velocity_noise) if info else None
    pushing = _stddev(info.linear_acceleration_noise) if info else None
    return (
        leaf_at("gyro", source, name=f"{name}_gyro", site=name, noise=turning),
        leaf_at("accelerometer", source, name=f"{name}_accel", site=name, noise=pushing),
        leaf_at("framequat", source, name=f"{name}_quat", objtype="site", objname=name),
    )


def _force_torque(sensor: Sensor) -> Sequence[Xml]:
    name = sensor.name
    noise = _stddev(sensor.force_torque_info.noise) if sensor.force_torque_info else None
    return tuple(
        leaf_at(kind, sensor.source, name=f"{name}_{kind}", site=name, noise=noise) for kind in ("force", "torque")
    )


def _stddev(noise: SensorNoise | None) -> float | None:
    return noise.stddev or None if noise else None
