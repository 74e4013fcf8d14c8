"""Classes of ros2_controllers: which of their parameters have the joints, interfaces and sensors of a controller.

The names are those of the parameters that each package declares in its `…_parameters.yaml`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.core.models.controller import Controller
from linkforge_compile.core.part import FrozenMap

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


PARAMETERS_OF_FIELDS: Mapping[str, str] = FrozenMap(
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
"""The usual names of the parameters that the fields of a controller become, by field."""

_TEXTS = ("sensor", "frame")
"""The fields of one name, where others are lists."""


class Kind(NamedTuple):
    """A class of controllers.

    `parameters` are the names of its parameters by the fields of Controller; those of the fields in `single` have one
    name and no list. It does not start without its parameters in `required`, or those that `instead` has for them. All
    of its parameters are in `formats/ros2_controllers/parameters.py`. `commands` and `states` are the interfaces of its
    joints that it claims where its fields have none.
    """

    parameters: Mapping[str, str]
    single: frozenset[str] = frozenset()
    required: tuple[str, ...] = ()
    instead: Mapping[str, str] = FrozenMap()
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

_LIFTED_OF_OTHERS: Mapping[str, str] = {"joints": "joints", "sensor": "sensor_name"}
"""The fields that parameters of those classes are; the `frame_id` of some is no link of the robot."""

ANY_KIND = Kind(PARAMETERS_OF_FIELDS)
"""What any other class is given: all that a controller has, under the usual names."""


def kind_of(type_: str | None) -> Kind:
    return KINDS.get(type_ or "", ANY_KIND)


def lift_parameters(controller: Controller) -> Controller:
    """Return a controller of ros2_controllers with each parameter that is a field's in that field.

    A parameter stays where the field is stated as well, and where its value is none that the field accepts.
    """
    kind, is_other = kind_of(controller.type), controller.type in OTHER_CLASSES
    parameters = _LIFTED_OF_OTHERS if is_other else kind.parameters if kind is not ANY_KIND else {}
    lifted: dict[str, object] = {}
    for field, parameter in parameters.items():
        value = controller.parameters.get(parameter)
        is_one = field in _TEXTS or field in kind.single
        items = [value] if is_one else value if isinstance(value, list | tuple) else ()
        are_names = bool(items) and all(item and isinstance(item, str) for item in items)
        if are_names and not stated_field(controller, field):
            lifted[field] = value if field in _TEXTS else tuple(items)
    if not lifted:
        return controller
    names = {kind.parameters[field] for field in lifted}
    others = {name: value for name, value in controller.parameters.items() if name not in names}
    return controller.with_fields(**lifted, parameters=FrozenMap(others))


def stated_field(controller: Controller, field: str) -> str | None:
    """Return the field that gives a controller a field: for `joints` also its `group`; None if none does."""
    fields = ("joints", "group") if field == "joints" else (field,)
    return next((each for each in fields if getattr(controller, each)), None)


def written_names(controller: Controller, field: str) -> tuple[str, ...]:
    """Return the names of a field with several that are written: none without a parameter, one for a single one."""
    kind, names = kind_of(controller.type), tuple(getattr(controller, field))
    if field not in kind.parameters:
        return ()
    return names[:1] if field in kind.single else names


def path_of_field(controller: Controller, field: str) -> tuple[str, ...]:
    """Return the path below a controller at which a field was written: that of a parameter for a lifted one."""
    node = controller.source.node if controller.source else None
    parameters = node.child("parameters") if node else None
    name = kind_of(controller.type).parameters.get(field, field)
    if node and parameters and node.child(field) is None and parameters.child(name) is not None:
        return ("parameters", name)
    return (field,)
