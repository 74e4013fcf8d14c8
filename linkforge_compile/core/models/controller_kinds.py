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

_ALL_FIELDS: Mapping[str, str] = MappingProxyType(
    {
        "joints": "joints",
        "left_wheels": "left_wheel_names",
        "right_wheels": "right_wheel_names",
        "sensor": "sensor_name",
        "frame": "frame_id",
        "command_interfaces": "command_interfaces",
        "state_interfaces": "state_interfaces",
    }
)


class Kind(NamedTuple):
    """A class of controllers.

    `parameters` are the names of its parameters by the fields of Controller; those of the fields in `single` have one
    name and no list. It does not start without its parameters in `required`, or those that `instead` has for them. All
    of its parameters are in `parameters.py`. `commands` and `states` are the interfaces of its joints that it claims
    where its fields have none.
    """

    parameters: Mapping[str, str]
    single: frozenset[str] = frozenset()
    required: tuple[str, ...] = ()
    instead: Mapping[str, str] = MappingProxyType({})
    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()


KINDS: Mapping[str, Kind] = {
    TRAJECTORY: Kind(
        {"joints": "joints", "command_interfaces": "command_interfaces", "state_interfaces": "state_interfaces"},
        required=("joints", "command_interfaces", "state_interfaces"),
    ),
    GRIPPER: Kind(
        {"joints": "joint", "state_interfaces": "state_interfaces"},
        single=frozenset({"joints"}),
        required=("joint",),
        commands=("position",),
        states=("position", "velocity"),
    ),
    OLD_GRIPPER: Kind(
        {"joints": "joint"},
        single=frozenset({"joints"}),
        required=("joint",),
        commands=("position",),
        states=("position", "velocity"),
    ),
    EFFORT_GRIPPER: Kind(
        {"joints": "joint"},
        single=frozenset({"joints"}),
        required=("joint",),
        commands=("effort",),
        states=("position", "velocity"),
    ),
    FORWARD: Kind(
        {"joints": "joints", "command_interfaces": "interface_name"},
        single=frozenset({"command_interfaces"}),
        required=("joints", "interface_name"),
    ),
    POSITION_GROUP: Kind({"joints": "joints"}, required=("joints",), commands=("position",)),
    VELOCITY_GROUP: Kind({"joints": "joints"}, required=("joints",), commands=("velocity",)),
    EFFORT_GROUP: Kind({"joints": "joints"}, required=("joints",), commands=("effort",)),
    STATES: Kind({"joints": "joints", "state_interfaces": "interfaces"}),
    DIFF_DRIVE: Kind(
        {"left_wheels": "left_wheel_names", "right_wheels": "right_wheel_names"},
        required=("left_wheel_names", "right_wheel_names", "wheel_separation", "wheel_radius"),
        commands=("velocity",),
    ),
    IMU: Kind({"sensor": "sensor_name", "frame": "frame_id"}, required=("sensor_name", "frame_id")),
    FORCE_TORQUE: Kind(
        {"sensor": "sensor_name", "frame": "frame_id"},
        required=("sensor_name", "frame_id"),
        instead={"sensor_name": "interface_names"},
    ),
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

ANY_KIND = Kind(_ALL_FIELDS)
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
