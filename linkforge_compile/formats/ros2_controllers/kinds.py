"""Classes of ros2_controllers: which of their parameters have the joints, interfaces and sensors of a controller.

The names are those of the parameters that each package declares in its `…_parameters.yaml`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.diagnostics.suggest import nearest

TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
GRIPPER = "parallel_gripper_action_controller/GripperActionController"
OLD_GRIPPER = "position_controllers/GripperActionController"
EFFORT_GRIPPER = "effort_controllers/GripperActionController"
FORWARD = "forward_command_controller/ForwardCommandController"
POSITION_GROUP = "position_controllers/JointGroupPositionController"
VELOCITY_GROUP = "velocity_controllers/JointGroupVelocityController"
EFFORT_GROUP = "effort_controllers/JointGroupEffortController"
STATES = "joint_state_broadcaster/JointStateBroadcaster"
DIFF_DRIVE = "diff_drive_controller/DiffDriveController"
IMU = "imu_sensor_broadcaster/IMUSensorBroadcaster"
FORCE_TORQUE = "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"

_TYPING_ERRORS = 2
"""By how many letters a misspelled class is shorter or longer; other packages have longer names."""

JOINT_FIELDS = ("joints", "left_wheels", "right_wheels")
"""The fields of a controller with names of joints."""

_ANY: Mapping[str, str] = {
    "joints": "joints",
    "left_wheels": "left_wheel_names",
    "right_wheels": "right_wheel_names",
    "sensor": "sensor_name",
    "frame": "frame_id",
    "command_interfaces": "command_interfaces",
    "state_interfaces": "state_interfaces",
}


class Kind(NamedTuple):
    """A class of controllers.

    `parameters` are the names of its parameters by the fields of Controller; those in `single` have one name and no
    list. It needs those in `required`, other parameters too. All of its parameters are in `parameters.py`. `commands`
    and `states` are the interfaces of its joints that it claims where its fields have none.
    """

    parameters: Mapping[str, str] = MappingProxyType(_ANY)
    single: frozenset[str] = frozenset()
    required: tuple[str, ...] = ()
    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()


def _kind(*fields: str, single: tuple[str, ...] = (), required: tuple[str, ...] = (), **renamed: str) -> Kind:
    names = {field: _ANY[field] for field in fields} | renamed
    return Kind(names, frozenset(single), required or tuple(names[field] for field in fields))


_GROUP, _SENSOR = _kind("joints"), _kind("sensor", "frame")
_OLD_GRIPPER = _kind(single=("joints",), required=("joint",), joints="joint")._replace(states=("position", "velocity"))
_GRIPPER = _OLD_GRIPPER._replace(
    parameters={"joints": "joint", "state_interfaces": "state_interfaces"}, commands=("position",)
)

KINDS: Mapping[str, Kind] = {
    TRAJECTORY: _kind("joints", "command_interfaces", "state_interfaces"),
    GRIPPER: _GRIPPER,
    OLD_GRIPPER: _OLD_GRIPPER._replace(commands=("position",)),
    EFFORT_GRIPPER: _OLD_GRIPPER._replace(commands=("effort",)),
    FORWARD: _kind("joints", single=("command_interfaces",), command_interfaces="interface_name"),
    POSITION_GROUP: _GROUP._replace(commands=("position",)),
    VELOCITY_GROUP: _GROUP._replace(commands=("velocity",)),
    EFFORT_GROUP: _GROUP._replace(commands=("effort",)),
    STATES: Kind({"joints": "joints", "state_interfaces": "interfaces"}),
    DIFF_DRIVE: _kind(
        "left_wheels",
        "right_wheels",
        required=("left_wheel_names", "right_wheel_names", "wheel_separation", "wheel_radius"),
    )._replace(commands=("velocity",)),
    IMU: _SENSOR,
    FORCE_TORQUE: _SENSOR,
}

OTHER_CLASSES = (
    "ackermann_steering_controller/AckermannSteeringController",
    "admittance_controller/AdmittanceController",
    "battery_state_broadcaster/BatteryStateBroadcaster",
    "bicycle_steering_controller/BicycleSteeringController",
    "chained_filter_controller/ChainedFilter",
    "forward_command_controller/MultiInterfaceForwardCommandController",
    "gpio_controllers/GpioCommandController",
    "gps_sensor_broadcaster/GPSSensorBroadcaster",
    "magnetometer_broadcaster/MagnetometerBroadcaster",
    "mecanum_drive_controller/MecanumDriveController",
    "motion_primitives_controllers/MotionPrimitivesForwardController",
    "omni_wheel_drive_controller/OmniWheelDriveController",
    "pid_controller/PidController",
    "pose_broadcaster/PoseBroadcaster",
    "range_sensor_broadcaster/RangeSensorBroadcaster",
    "state_interfaces_broadcaster/StateInterfacesBroadcaster",
    "tricycle_controller/TricycleController",
    "tricycle_steering_controller/TricycleSteeringController",
)
"""The other classes of ros2_controllers, which have the usual names."""

ANY_KIND = Kind()
"""What any other class is given: all that a controller has, under the usual names."""


def kind_of(type_: str | None) -> Kind:
    return KINDS.get(type_ or "", ANY_KIND)


def misspelled_class(type_: str | None) -> str | None:
    """Return the class of ros2_controllers that a type misspells; None for a class of another package."""
    if not type_ or type_ in KINDS or type_ in OTHER_CLASSES:
        return None
    near = nearest(type_, (*KINDS, *OTHER_CLASSES))
    if near is None:
        return None
    is_of_package = type_.split("/")[0] == near.split("/")[0]
    return near if is_of_package or abs(len(type_) - len(near)) <= _TYPING_ERRORS else None
