"""The parameters that known classes of controllers and the controller manager declare, and their types.

They are those of ros2_controllers and ros2_control since ROS 2 Humble. ROS 2 converts no type: a node ends with an
error where a parameter declared as a double is a whole number. A name that is not declared has no effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.core.models.controller_kinds import (
    DIFF_DRIVE,
    EFFORT_GRIPPER,
    EFFORT_GROUP,
    FORCE_TORQUE,
    FORWARD,
    GRIPPER,
    IMU,
    OLD_GRIPPER,
    POSITION_GROUP,
    STATES,
    TRAJECTORY,
    VELOCITY_GROUP,
)
from linkforge_compile.units import parse_quantity

DOUBLE, INT, BOOL, STRING, ANY = "a number", "a whole number without a unit", "true or false", "a text", ""
DOUBLES, STRINGS = "a list of numbers", "a list of strings"

Type = str | Mapping[str, "Type"]
"""What a parameter accepts, ANY for whatever it is given, or the parameters in it by name."""

NAMED = "*"
"""In place of the names that a robot gives: of the joints of a controller, or of the controllers of the manager."""


def _each(type_: Type, names: str) -> dict[str, Type]:
    return dict.fromkeys(names.split(), type_)


_COMMON: Mapping[str, Type] = {
    **_each(INT, "update_rate thread_priority"),
    **_each(BOOL, "is_async use_sim_time start_type_description_service"),
    **_each(ANY, "async_parameters qos_overrides"),
}

_GAINS: Mapping[str, Type] = {
    **_each(DOUBLE, "p i d ff_velocity_scale i_clamp i_clamp_max i_clamp_min u_clamp_max u_clamp_min"),
    **_each(DOUBLE, "tracking_time_constant error_deadband"),
    **_each(BOOL, "angle_wraparound normalize_error"),
    "antiwindup_strategy": STRING,
}

_TRAJECTORY: Mapping[str, Type] = {
    **_each(STRINGS, "joints command_joints command_interfaces state_interfaces"),
    **_each(BOOL, "allow_partial_joints_goal allow_trajectory_replacement allow_nonzero_velocity_at_trajectory_end"),
    **_each(BOOL, "allow_integration_in_goal_trajectories interpolate_from_desired_state open_loop_control"),
    **_each(BOOL, "set_last_command_interface_value_as_state_on_activation start_with_holding"),
    **_each(DOUBLE, "action_monitor_rate state_publish_rate cmd_timeout"),
    "interpolation_method": STRING,
    "speed_scaling": {"initial_scaling_factor": DOUBLE, **_each(STRING, "state_interface command_interface")},
    "positions_upsampling": {"enable": BOOL, "policy_frequency": DOUBLE},
    "gains": {NAMED: _GAINS},
    "constraints": {
        **_each(DOUBLE, "goal_time stopped_velocity_tolerance"),
        "decelerate_on_cancel": BOOL,
        NAMED: _each(DOUBLE, "trajectory goal max_deceleration_on_cancel"),
    },
}

_OLD_GRIPPER: Mapping[str, Type] = {
    **_each(DOUBLE, "action_monitor_rate goal_tolerance max_effort stall_velocity_threshold stall_timeout"),
    "allow_stalling": BOOL,
    "joint": STRING,
}
_GRIPPER: Mapping[str, Type] = {
    **_OLD_GRIPPER,
    **_each(STRING, "max_effort_interface max_velocity_interface"),
    "max_velocity": DOUBLE,
    "state_interfaces": STRINGS,
}

_STATES: Mapping[str, Type] = {
    **_each(STRINGS, "joints extra_joints interfaces"),
    **_each(BOOL, "use_local_topics use_urdf_to_filter publish_dynamic_joint_states"),
    "frame_id": STRING,
    "map_interface_to_joint_state": _each(STRING, "position velocity effort"),
}

_AXIS: Mapping[str, Type] = {
    **_each(DOUBLE, "max_velocity min_velocity max_acceleration min_acceleration max_jerk min_jerk"),
    **_each(DOUBLE, "max_deceleration max_acceleration_reverse max_deceleration_reverse"),
    **_each(BOOL, "has_velocity_limits has_acceleration_limits has_jerk_limits"),
}
_DIFF_DRIVE: Mapping[str, Type] = {
    **_each(STRINGS, "left_wheel_names right_wheel_names"),
    **_each(DOUBLE, "wheel_separation wheel_radius wheel_separation_multiplier cmd_vel_timeout publish_rate"),
    **_each(DOUBLE, "left_wheel_radius_multiplier right_wheel_radius_multiplier"),
    **_each(BOOL, "tf_frame_prefix_enable open_loop position_feedback enable_odom_tf publish_limited_velocity"),
    **_each(BOOL, "use_stamped_vel"),
    **_each(STRING, "tf_frame_prefix odom_frame_id base_frame_id"),
    **_each(DOUBLES, "pose_covariance_diagonal twist_covariance_diagonal"),
    **_each(INT, "velocity_rolling_window_size wheels_per_side"),
    "linear": {"x": _AXIS},
    "angular": {"z": _AXIS},
}

_IMU: Mapping[str, Type] = {
    **_each(STRING, "sensor_name frame_id"),
    **_each(DOUBLES, "static_covariance_orientation static_covariance_angular_velocity"),
    "static_covariance_linear_acceleration": DOUBLES,
    "rotation_offset": _each(DOUBLE, "roll pitch yaw"),
}
_FORCE_TORQUE: Mapping[str, Type] = {
    **_each(STRING, "sensor_name frame_id"),
    "interface_names": _each(_each(STRING, "x y z"), "force torque"),
    **_each(_each(_each(DOUBLE, "x y z"), "force torque"), "offset multiplier"),
    "sensor_filter_chain": ANY,
    "target_frames": STRINGS,
    "tf_timeout": DOUBLE,
}

_PERIOD: Mapping[str, Type] = _each(_each(DOUBLE, "warn error"), "mean_error standard_deviation")
_MANAGER: Mapping[str, Type] = {
    **_each(INT, "update_rate thread_priority"),
    **_each(BOOL, "enforce_command_limits handle_exceptions lock_memory use_sim_time start_type_description_service"),
    **_each(ANY, "cpu_affinity qos_overrides"),
    "robot_description": STRING,
    "hardware_components_initial_state": {
        **_each(STRINGS, "unconfigured inactive"),
        "shutdown_on_initial_state_failure": BOOL,
    },
    "defaults": {
        "switch_controller": {"strictness": STRING},
        **_each(BOOL, "allow_controller_activation_with_inactive_hardware"),
        **_each(BOOL, "deactivate_controllers_on_hardware_self_deactivate"),
    },
    "diagnostics": {
        "threshold": {
            "controller_manager": {"periodicity": _PERIOD},
            **_each(_each(_PERIOD, "periodicity execution_time"), "controllers hardware_components"),
        }
    },
    "overruns": {"print_warnings": BOOL},
    NAMED: {"type": STRING, **_each(ANY, "params_file fallback_controllers"), "node_options_args": STRINGS},
}

_GROUP: Mapping[str, Type] = {"joints": STRINGS}

_CLASSES: Mapping[str, Mapping[str, Type]] = {
    TRAJECTORY: _TRAJECTORY,
    FORWARD: {**_GROUP, "interface_name": STRING},
    POSITION_GROUP: _GROUP,
    VELOCITY_GROUP: _GROUP,
    EFFORT_GROUP: _GROUP,
    GRIPPER: _GRIPPER,
    OLD_GRIPPER: _OLD_GRIPPER,
    EFFORT_GRIPPER: _OLD_GRIPPER,
    STATES: _STATES,
    DIFF_DRIVE: _DIFF_DRIVE,
    IMU: _IMU,
    FORCE_TORQUE: _FORCE_TORQUE,
}

PARAMETERS: Mapping[str, Mapping[str, Type]] = {
    MANAGER: _MANAGER,
    **{type_: {**own, **_COMMON} for type_, own in _CLASSES.items()},
}
"""The parameters of classes and of the controller manager; a class that is not here may have any."""


class Misfit(NamedTuple):
    """A parameter at a path that is not declared, or whose value has another type than `expected`."""

    path: tuple[str, ...]
    expected: str | None
    value: object
    near: tuple[str, ...]


def find_misfits(
    values: Mapping[str, object], declared: Mapping[str, Type], named: Iterable[str], path: tuple[str, ...] = ()
) -> Iterator[Misfit]:
    """Yield each parameter that is not declared or has another type; `named` are the names in place of NAMED."""
    names = tuple(named)
    for name, value in values.items():
        type_ = type_of(name, declared, names)
        if type_ is None:
            known = (*(one for one in declared if one != NAMED), *(names if NAMED in declared else ()))
            yield Misfit((*path, name), None, value, known)
        elif isinstance(type_, str):
            if type_ and value is not None and not _fits(convert(value, type_), type_):
                yield Misfit((*path, name), type_, value, ())
        elif isinstance(value, Mapping):
            yield from find_misfits(value, type_, (*names, *names_below(name, names)), (*path, name))
        elif value is not None:
            yield Misfit((*path, name), "a map of parameters", value, ())


def type_of(name: str, declared: Mapping[str, Type], named: Iterable[str]) -> Type | None:
    """Return the type of a parameter, None if it has none; a name in `named` with dots is in nested maps."""
    of_names = declared.get(NAMED)
    if name in declared or of_names is None:
        return declared.get(name)
    if names_below(name, named) and isinstance(of_names, Mapping):
        return {**of_names, NAMED: of_names}
    return of_names if name in named else None


def names_below(name: str, named: Iterable[str]) -> tuple[str, ...]:
    """Return the rest of each name with dots that begins with `name`."""
    return tuple(one.removeprefix(f"{name}.") for one in named if one.startswith(f"{name}."))


def convert(value: object, type_: Type) -> object:
    """Return a value as a parameter of a type: a number with decimals, a quantity in SI units, or unchanged."""
    if type_ == DOUBLES and isinstance(value, list | tuple):
        return [convert(item, DOUBLE) for item in value]
    if type_ != DOUBLE:
        return value
    if isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    quantity = parse_quantity(value) if isinstance(value, str) else None
    return quantity.value if quantity else value


def _fits(value: object, type_: str) -> bool:
    if type_ in {DOUBLES, STRINGS}:
        item_type = DOUBLE if type_ == DOUBLES else STRING
        return isinstance(value, list | tuple) and all(_fits(item, item_type) for item in value)
    if type_ == INT:
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, {DOUBLE: float, BOOL: bool, STRING: str}[type_])
