"""A link under construction: its sensors, and the joint to its parent."""

from __future__ import annotations

import math
from typing import Any, Self, TypeAlias

from linkforge_compile.core import constants as default
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import IDENTITY, Transform, Vector3
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.models.named_table import NamedTable
from linkforge_compile.core.models.ros2_control import Ros2Control, Ros2ControlJoint
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
from linkforge_compile.core.models.transmission import Transmission

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


class JointDraft(LinkDraft):
    """The calls that describe the joint; without a parent there is none, and they have no effect."""

    def __init__(self, name: str, parent: str | None, joint_name: str | None) -> None:
        super().__init__(name)
        self._parent = parent
        self._joint_name = joint_name
        self._joint_type = JointType.FIXED
        self._joint_origin = IDENTITY
        self._joint_parts: dict[str, Any] = {}  # fields of Joint, none of which LinkForge gives to a fixed one
        self._transmission: dict[str, Any] | None = None  # arguments of Transmission.create_simple
        self._control: dict[str, Any] | None = None  # fields of Ros2ControlJoint
        self._control_system: str | None = None

    def at_origin(self, xyz: Triple = (0, 0, 0), rpy: Triple = (0, 0, 0)) -> Self:
        """Place this link's frame in its parent's, at `xyz` [m] turned by `rpy` [rad]."""
        self._check_not_committed()
        self._joint_origin = pose(xyz, rpy)
        return self

    def fixed(self, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None) -> Self:
        """Fix the link to its parent; here and below, None keeps the name and the pose as they are."""
        return self._set_joint(JointType.FIXED, name, xyz, rpy)

    def revolute(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        limits: tuple[float, float],
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float = default.DEFAULT_JOINT_EFFORT,
        velocity: float = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link turn about an axis of any length within (lower, upper) [rad], [N·m], [rad/s]."""
        bounds = JointLimits(lower=limits[0], upper=limits[1], effort=effort, velocity=velocity)
        return self._set_joint(JointType.REVOLUTE, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def continuous(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float | None = default.DEFAULT_JOINT_EFFORT,
        velocity: float | None = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link turn about an axis without end, [N·m], [rad/s]; its limits are 0 to 0, unused.

        One of effort and velocity that is None counts as 0; without both the joint has no limits.
        """
        bounds = None
        if effort is not None or velocity is not None:
            bounds = JointLimits(lower=0.0, upper=0.0, effort=effort or 0.0, velocity=velocity or 0.0)
        return self._set_joint(JointType.CONTINUOUS, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def prismatic(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        limits: tuple[float, float],
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float = default.DEFAULT_JOINT_EFFORT,
        velocity: float = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link slide along an axis of any length within (lower, upper) [m], [N], [m/s]."""
        bounds = JointLimits(lower=limits[0], upper=limits[1], effort=effort, velocity=velocity)
        return self._set_joint(JointType.PRISMATIC, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def floating(self, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None) -> Self:
        """Let the link move freely."""
        return self._set_joint(JointType.FLOATING, name, xyz, rpy)

    def planar(
        self, axis: Triple, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None
    ) -> Self:
        """Let the link move in the plane whose normal is the axis."""
        return self._set_joint(JointType.PLANAR, name, xyz, rpy, axis=unit_axis(axis))

    def dynamics(
        self, damping: float = default.DEFAULT_JOINT_DAMPING, friction: float = default.DEFAULT_JOINT_FRICTION
    ) -> Self:
        """Let the joint resist: [N·m·s/rad] and [N·m], or [N·s/m] and [N]."""
        return self._set_parts(dynamics=JointDynamics(damping, friction))

    def mimic(self, joint: str, multiplier: float = 1.0, offset: float = 0.0) -> Self:
        """Let the joint follow another: multiplier times its position plus offset [rad] or [m]."""
        return self._set_parts(mimic=JointMimic(joint, multiplier, offset))

    def safety(
        self,
        soft_lower: float | None = None,
        soft_upper: float | None = None,
        k_position: float | None = None,
        k_velocity: float = 0.0,
    ) -> Self:
        """Give the joint a safety controller; see JointSafetyController."""
        return self._set_parts(safety_controller=JointSafetyController(soft_lower, soft_upper, k_position, k_velocity))

    def calibration(self, rising: float | None = None, falling: float | None = None) -> Self:
        """Give the positions at which the joint's reference switch changes [rad] or [m]."""
        return self._set_parts(calibration=JointCalibration(rising, falling))

    def transmission(
        self,
        reduction: float = 1.0,
        interface: str = default.HW_IF_EFFORT,
        actuator: str | None = None,
        name: str | None = None,
    ) -> Self:
        """Drive the joint by an actuator; None for `actuator_LINK` and `trans_JOINT`."""
        self._check_not_committed()
        self._transmission = {
            "name": name,
            "actuator_name": actuator or f"actuator_{self._link_name}",
            "mechanical_reduction": reduction,
            "hardware_interfaces": [interface],
        }
        return self

    def ros2_control(
        self,
        command_interfaces: list[str],
        state_interfaces: list[str],
        parameters: dict[str, Any] | None = None,
        system_name: str | None = None,
    ) -> Self:
        """Let a ros2_control system move the joint; None for the first system that the robot has."""
        self._check_not_committed()
        self._control = {
            "command_interfaces": command_interfaces,
            "state_interfaces": state_interfaces,
            "parameters": {name: str(value) for name, value in (parameters or {}).items()},
        }
        self._control_system = system_name
        return self

    def _set_joint(
        self, joint_type: JointType, name: str | None, xyz: Triple | None, rpy: Triple | None, **parts: object
    ) -> Self:
        self._check_not_committed()
        self._joint_type = joint_type
        self._joint_parts.update(parts)
        self._joint_name = name or self._joint_name
        if xyz is not None or rpy is not None:
            self._joint_origin = pose(xyz, rpy)
        return self

    def _set_parts(self, **parts: object) -> Self:
        self._check_not_committed()
        self._joint_parts.update(parts)
        return self

    def _make_joint(self) -> Joint | None:
        if not self._parent:
            return None
        return Joint(
            name=self._joint_name or f"{self._parent}_to_{self._link_name}",
            type=self._joint_type,
            parent=self._parent,
            child=self._link_name,
            origin=self._joint_origin,
            **({} if self._joint_type is JointType.FIXED else self._joint_parts),
        )

    def _make_transmission(self, joint: Joint) -> Transmission | None:
        if self._transmission is None:
            return None
        name = self._transmission["name"] or f"trans_{joint.name}"
        return Transmission.create_simple(**{**self._transmission, "name": name, "joint_name": joint.name})

    def _make_control(self, joint: Joint, systems: NamedTable[Ros2Control]) -> Ros2Control | None:
        """Return the ros2_control system that is to move the joint, with the joint in it.

        Raises:
            RobotValidationError: VALUE_EMPTY if there are no systems, GENERIC_FAILURE if the named one is missing.

        """
        if self._control is None:
            return None
        if not systems:
            message = f"Joint '{joint.name}' requested ros2_control interfaces, but no global system exists."
            raise RobotValidationError.empty(message, "Ros2Control")
        system = systems.get(self._control_system) if self._control_system else systems[0]
        if system is None:
            message = (
                f"Joint '{joint.name}' requested ros2_control system '{self._control_system}', but it was not found."
            )
            raise RobotValidationError(ValidationErrorCode.GENERIC_FAILURE, message, "Ros2Control")
        return system.with_fields(joints=(*system.joints, Ros2ControlJoint(joint.name, **self._control)))
