"""A link under construction: its name and its sensors."""

from __future__ import annotations

import math
from typing import Any, Self, TypeAlias

from linkforge_compile.core import constants as default
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    GPSInfo,
    IMUInfo,
    LidarInfo,
    Sensor,
    SensorType,
)

Triple: TypeAlias = tuple[float, float, float]


def pose(xyz: Triple | None, rpy: Triple | None) -> Transform:
    """Return the pose at `xyz` [m], turned by `rpy` [rad]; None for zeros."""
    return Transform(*(Vector3(0.0, 0.0, 0.0) if triple is None else Vector3(*triple) for triple in (xyz, rpy)))


def unit_axis(axis: Triple) -> Vector3:
    """Return the vector of length 1 in that direction.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a vector that has none.

    """
    length = math.hypot(*axis)
    if length < default.EPSILON:
        code, message = ValidationErrorCode.OUT_OF_RANGE, "Joint axis magnitude is too small"
        raise RobotValidationError(code, message, "JointAxis", 0.0, field=("axis",))
    return Vector3(*(component / length for component in axis))


class LinkDraft:
    """A link that is described call by call, and added to the robot when it is committed.

    Sensors are at `xyz` [m] turned by `rpy` [rad] in the link frame; rates are in [Hz].
    """

    def __init__(self, name: str) -> None:
        self._link_name = name
        self._committed = False
        self._sensors: list[Sensor] = []

    def _check_not_committed(self) -> None:
        if self._committed:
            raise RuntimeError(f"LinkBuilder '{self._link_name}' already committed")

    def camera(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        fov: float = default.DEFAULT_CAMERA_FOV,
        width: int = default.DEFAULT_CAMERA_WIDTH,
        height: int = default.DEFAULT_CAMERA_HEIGHT,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add a camera by its horizontal field of view [rad] and size [px]."""
        info = CameraInfo(horizontal_fov=fov, width=width, height=height)
        return self._add_sensor(name, SensorType.CAMERA, xyz, rpy, camera_info=info)

    def lidar(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        range_min: float = default.DEFAULT_LIDAR_RANGE_MIN,
        range_max: float = default.DEFAULT_LIDAR_RANGE_MAX,
        samples: int = default.DEFAULT_LIDAR_SAMPLES,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add a lidar of one layer by its range [m] and the rays in its sweep, half a turn ahead."""
        info = LidarInfo(range_min=range_min, range_max=range_max, horizontal_samples=samples)
        return self._add_sensor(name, SensorType.LIDAR, xyz, rpy, lidar_info=info)

    def gpu_lidar(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        range_min: float = default.DEFAULT_LIDAR_RANGE_MIN,
        range_max: float = default.DEFAULT_LIDAR_RANGE_MAX,
        samples: int = default.DEFAULT_LIDAR_SAMPLES,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add a lidar that the simulator renders, otherwise as `lidar` does."""
        info = LidarInfo(range_min=range_min, range_max=range_max, horizontal_samples=samples)
        return self._add_sensor(name, SensorType.GPU_LIDAR, xyz, rpy, lidar_info=info)

    def imu(
        self,
        name: str,
        update_rate: float = default.DEFAULT_UPDATE_RATE_IMU,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add an inertial unit."""
        return self._add_sensor(name, SensorType.IMU, xyz, rpy, update_rate=update_rate, imu_info=IMUInfo())

    def gps(
        self,
        name: str,
        update_rate: float = default.DEFAULT_UPDATE_RATE_GPS,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add a satellite receiver."""
        return self._add_sensor(name, SensorType.GPS, xyz, rpy, update_rate=update_rate, gps_info=GPSInfo())

    def force_torque(
        self,
        name: str,
        update_rate: float = default.DEFAULT_UPDATE_RATE_FORCE_TORQUE,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
    ) -> Self:
        """Add a force and torque sensor."""
        values = {"update_rate": update_rate, "force_torque_info": ForceTorqueInfo()}
        return self._add_sensor(name, SensorType.FORCE_TORQUE, xyz, rpy, **values)

    def contact(self, name: str, collision: str, update_rate: float = default.DEFAULT_UPDATE_RATE_CONTACT) -> Self:
        """Add a touch sensor that feels with a collision of that name."""
        info = ContactInfo(collision)
        return self._add_sensor(name, SensorType.CONTACT, update_rate=update_rate, contact_info=info)

    def sensor(self, sensor: Sensor) -> Self:
        """Add a sensor as it is, but on this link."""
        self._check_not_committed()
        self._sensors.append(sensor.with_fields(link_name=self._link_name))
        return self

    def _add_sensor(
        self, name: str, kind: SensorType, xyz: Triple | None = None, rpy: Triple | None = None, **values: Any
    ) -> Self:  # Any: each field of Sensor has a type of its own
        return self.sensor(Sensor(name, kind, self._link_name, origin=pose(xyz, rpy), **values))
