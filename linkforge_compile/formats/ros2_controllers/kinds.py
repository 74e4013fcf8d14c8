"""Classes of ros2_controllers: which of their parameters have the joints, interfaces and sensors of a controller.

The names are those of the parameters that each package declares in its `…_parameters.yaml`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

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

ANY_KIND = Kind()
"""What any other class is given: all that a controller has, under the usual names."""


def kind_of(type_: str | None) -> Kind:
    return KINDS.get(type_ or "", ANY_KIND)
