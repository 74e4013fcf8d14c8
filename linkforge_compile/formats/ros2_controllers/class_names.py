"""Names of the classes of ros2_controllers, and classes that misspell one."""

from __future__ import annotations

from linkforge_compile.core.models.controller_kinds import KINDS
from linkforge_compile.diagnostics.suggest import nearest

_TYPING_ERRORS = 2
"""By how many letters a misspelled class is shorter or longer; other packages have longer names."""

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


def misspelled_class(type_: str | None) -> str | None:
    """Return the class of ros2_controllers that a type misspells; None for a class of another package."""
    if not type_ or type_ in KINDS or type_ in OTHER_CLASSES:
        return None
    near = nearest(type_, (*KINDS, *OTHER_CLASSES))
    if near is None:
        return None
    is_of_package = type_.split("/")[0] == near.split("/")[0]
    return near if is_of_package or abs(len(type_) - len(near)) <= _TYPING_ERRORS else None
