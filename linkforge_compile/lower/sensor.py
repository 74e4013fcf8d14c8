"""Sensors: on which link, how often, and the one object that says what they measure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.models.sensor import (
    REQUIRED_INFO,
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    GPSInfo,
    IMUInfo,
    LidarInfo,
    Sensor,
    SensorType,
)
from linkforge_compile.core.part import Element
from linkforge_compile.lower.elements import lower_element, lower_field
from linkforge_compile.lower.extra import besides
from linkforge_compile.lower.fields import Fields, or_default
from linkforge_compile.lower.gazebo import lower_plugin

_OWN_INFO = {kind: field.removesuffix("_info") for kind, field in REQUIRED_INFO.items()}
"""The key of what a sensor of each type says about itself."""


class _Infos(NamedTuple):
    """What a sensor says that it measures, in the order of Sensor; None for what is not said."""

    camera: CameraInfo | None
    lidar: LidarInfo | None
    imu: IMUInfo | None
    gps: GPSInfo | None
    contact: ContactInfo | None
    force_torque: ForceTorqueInfo | None


def lower_sensors(file: Fields) -> Iterator[Sensor]:
    """Lower the sensors of a file, without those that are lost."""
    for _, sensor in file.each("sensors", "sensor", _sensor):
        if sensor:
            yield sensor


def _sensor(fields: Fields, name: str) -> Sensor | None:
    sensor_type, link = fields.choice("type", SensorType, required="camera"), fields.text("link", required="head")
    update_rate = lower_field("update_rate", field_specs(Sensor)["update_rate"], fields)
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
            update_rate,
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
    """Read what the sensor measures; `own` is what its type requires, and has its defaults where it is not written."""
    if own == "contact":
        fields.said("contact", "{collision: fingertip_collision}")
    infos = {key: _info(fields, key, kind, is_own=key == own) for key, kind in _INFOS.items()}
    return _Infos(**infos)


def _info(fields: Fields, key: str, kind: type[Element], *, is_own: bool) -> Any:
    if fields.node.get(key) is None:
        return kind() if is_own and kind is not ContactInfo else None
    info = fields.map(key)
    return lower_element(kind, info) if info else None


_INFOS: Mapping[str, type[Element]] = {
    "camera": CameraInfo,
    "lidar": LidarInfo,
    "imu": IMUInfo,
    "gps": GPSInfo,
    "contact": ContactInfo,
    "force_torque": ForceTorqueInfo,
}
