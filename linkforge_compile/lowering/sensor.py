"""Sensors: on which link, how often, and the one object that says what they measure."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import StrEnum
from typing import NamedTuple, TypeVar

from linkforge_compile.core import constants as default
from linkforge_compile.core.fields import ABOVE_ZERO, UP_TO_HALF_A_TURN
from linkforge_compile.core.models.sensor import (
    REQUIRED_INFO,
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    GPSInfo,
    IMUInfo,
    LidarInfo,
    Sensor,
    SensorNoise,
    SensorType,
)
from linkforge_compile.lowering.extra import besides
from linkforge_compile.lowering.fields import Fields, or_default
from linkforge_compile.lowering.gazebo import lower_plugin
from linkforge_compile.lowering.quantities import ANGLE, BARE, COUNT, EXTENT, LENGTH, Measure
from linkforge_compile.units import Dimension

T = TypeVar("T")

_OWN_INFO = {kind: field.removesuffix("_info") for kind, field in REQUIRED_INFO.items()}
"""The key of what a sensor of each type says about itself."""

_RATE = Measure((Dimension.FREQUENCY,), ABOVE_ZERO)
_FIELD_OF_VIEW = Measure((Dimension.ANGLE,), UP_TO_HALF_A_TURN)
_SIGHT = Measure((Dimension.LENGTH,), may_be_far=True)
_MOVING, _TURNING = Measure((Dimension.VELOCITY,)), Measure((Dimension.ANGULAR_VELOCITY,))
_LOAD = Measure((Dimension.FORCE, Dimension.TORQUE))


class _Infos(NamedTuple):
    """What a sensor says that it measures, in the order of Sensor; None for what is not said."""

    camera: CameraInfo | None
    lidar: LidarInfo | None
    imu: IMUInfo | None
    gps: GPSInfo | None
    contact: ContactInfo | None
    force_torque: ForceTorqueInfo | None


class _Frame(StrEnum):
    CHILD = default.FT_FRAME_CHILD
    PARENT = default.FT_FRAME_PARENT
    SENSOR = default.FT_FRAME_SENSOR


class _Direction(StrEnum):
    CHILD_TO_PARENT = default.FT_DIR_CHILD_TO_PARENT
    PARENT_TO_CHILD = default.FT_DIR_PARENT_TO_CHILD


def lower_sensors(file: Fields) -> Iterator[Sensor]:
    """Lower the sensors of a file, without those that are lost."""
    for _, sensor in file.each("sensors", "sensor", _sensor):
        if sensor:
            yield sensor


def _sensor(fields: Fields, name: str) -> Sensor | None:
    sensor_type, link = fields.choice("type", SensorType, required="camera"), fields.text("link", required="head")
    update_rate = fields.number("update_rate", _RATE)
    always_on, visualize = fields.flag("always_on"), fields.flag("visualize")
    origin, topic, frame = fields.origin(), fields.text("topic"), fields.text("frame")
    plugin = fields.map("plugin")
    lowered_plugin, rest = lower_plugin(plugin) if plugin else None, besides(fields)
    own = _OWN_INFO.get(sensor_type) if sensor_type else None
    infos = _infos(fields, own)
    if sensor_type is None or link is None or (own and getattr(infos, own) is None):
        return None
    return fields.build(
        lambda: Sensor(
            name,
            sensor_type,
            link,
            or_default(update_rate, default.DEFAULT_UPDATE_RATE),
            or_default(always_on, True),
            or_default(visualize, False),
            *infos,
            origin,
            topic,
            lowered_plugin,
            frame=frame,
            **rest,
        )
    )


def _infos(fields: Fields, own: str | None) -> _Infos:
    """Read what the sensor measures; `own` is what its type asks for, and where that is not said, a plain one."""
    if own == "contact":
        fields.said("contact", "{collision: fingertip_collision}")
    return _Infos(
        _info(fields, "camera", _camera, CameraInfo() if own == "camera" else None),
        _info(fields, "lidar", _lidar, LidarInfo() if own == "lidar" else None),
        _info(fields, "imu", _imu, IMUInfo() if own == "imu" else None),
        _info(fields, "gps", _gps, GPSInfo() if own == "gps" else None),
        _info(fields, "contact", _contact, None),
        _info(fields, "force_torque", _force_torque, ForceTorqueInfo() if own == "force_torque" else None),
    )


def _info(fields: Fields, key: str, lower: Callable[[Fields], T | None], unsaid: T | None) -> T | None:
    if fields.node.get(key) is None:
        return unsaid
    info = fields.map(key)
    return lower(info) if info else None


def _camera(info: Fields) -> CameraInfo | None:
    unsaid = CameraInfo()
    return info.build(
        lambda: CameraInfo(
            or_default(info.number("horizontal_fov", _FIELD_OF_VIEW), unsaid.horizontal_fov),
            or_default(info.integer("width", COUNT), unsaid.width),
            or_default(info.integer("height", COUNT), unsaid.height),
            or_default(info.text("format"), unsaid.format),
            or_default(info.number("near_clip", EXTENT), unsaid.near_clip),
            or_default(_sight(info, "far_clip"), unsaid.far_clip),
            _noise(info, "noise"),
            **besides(info),
        )
    )


def _sight(info: Fields, key: str) -> float | None:
    """Read how far a sensor sees [m]."""
    node = info.said(key)
    return None if node is None else info.number_at(node, key, _SIGHT)


def _lidar(info: Fields) -> LidarInfo | None:
    unsaid = LidarInfo()
    return info.build(
        lambda: LidarInfo(
            or_default(info.integer("horizontal_samples", COUNT), unsaid.horizontal_samples),
            or_default(info.number("horizontal_resolution"), unsaid.horizontal_resolution),
            or_default(info.number("horizontal_min_angle", ANGLE), unsaid.horizontal_min_angle),
            or_default(info.number("horizontal_max_angle", ANGLE), unsaid.horizontal_max_angle),
            or_default(info.integer("vertical_samples"), unsaid.vertical_samples),
            or_default(info.number("vertical_resolution"), unsaid.vertical_resolution),
            or_default(info.number("vertical_min_angle", ANGLE), unsaid.vertical_min_angle),
            or_default(info.number("vertical_max_angle", ANGLE), unsaid.vertical_max_angle),
            or_default(info.number("range_min", EXTENT), unsaid.range_min),
            or_default(_sight(info, "range_max"), unsaid.range_max),
            or_default(info.number("range_resolution", EXTENT), unsaid.range_resolution),
            _noise(info, "noise", LENGTH),
            **besides(info),
        )
    )


def _imu(info: Fields) -> IMUInfo | None:
    return info.build(
        lambda: IMUInfo(
            _noise(info, "angular_velocity_noise", _TURNING),
            _noise(info, "linear_acceleration_noise"),
            **besides(info),
        )
    )


def _gps(info: Fields) -> GPSInfo | None:
    return info.build(
        lambda: GPSInfo(
            _noise(info, "position_sensing_horizontal_noise", LENGTH),
            _noise(info, "position_sensing_vertical_noise", LENGTH),
            _noise(info, "velocity_sensing_horizontal_noise", _MOVING),
            _noise(info, "velocity_sensing_vertical_noise", _MOVING),
            **besides(info),
        )
    )


def _contact(info: Fields) -> ContactInfo | None:
    collision, noise = info.text("collision", required="fingertip_collision"), _noise(info, "noise")
    if collision is None:
        return None
    return info.build(lambda: ContactInfo(collision, noise, **besides(info)))


def _force_torque(info: Fields) -> ForceTorqueInfo | None:
    return info.build(
        lambda: ForceTorqueInfo(
            or_default(info.choice("frame", _Frame), _Frame.CHILD).value,
            or_default(info.choice("measure_direction", _Direction), _Direction.CHILD_TO_PARENT).value,
            _noise(info, "noise", _LOAD),
            **besides(info),
        )
    )


def _noise(info: Fields, key: str, measure: Measure = BARE) -> SensorNoise | None:
    """Read a noise in the measure of what is sensed."""
    noise = info.map(key)
    if noise is None:
        return None
    names = ("mean", "stddev", "bias_mean", "bias_stddev")
    said = {name: number for name in names if (number := noise.number(name, measure)) is not None}
    return noise.build(
        lambda: SensorNoise(
            or_default(noise.text("type"), default.NOISE_GAUSSIAN),
            **said,
            stated=[name for name in names[2:] if said.get(name) == 0],
            **besides(noise),
        )
    )
