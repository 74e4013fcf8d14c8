"""Sensors as a spec writes them: where they are, how often they measure, and what."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING

from linkforge_compile.core.constants import DEFAULT_UPDATE_RATE
from linkforge_compile.core.models.sensor import LidarInfo, Sensor, SensorNoise
from linkforge_compile.core.part import Element
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension
from linkforge_compile.writers.gazebo import written_plugin
from linkforge_compile.writers.geometry import written_origin
from linkforge_compile.writers.pen import Pen

if TYPE_CHECKING:
    from dataclasses import Field

_INFOS = ("camera", "lidar", "imu", "gps", "contact", "force_torque")
_NOT_SAID = frozenset((*(field.name for field in fields(Element)), "stated"))
"""The fields that are no keys of what a sensor measures, or of its noise."""

_ANGLES = ("horizontal_min_angle", "horizontal_max_angle", "vertical_min_angle", "vertical_max_angle")
_LENGTHS = ("near_clip", "far_clip", "range_min", "range_max", "range_resolution")
_UNITS: Mapping[str, Dimension] = {
    "horizontal_fov": Dimension.ANGLE,
    **dict.fromkeys(_ANGLES, Dimension.ANGLE),
    **dict.fromkeys(_LENGTHS, Dimension.LENGTH),
    "angular_velocity_noise": Dimension.ANGULAR_VELOCITY,
    **dict.fromkeys(("position_sensing_horizontal_noise", "position_sensing_vertical_noise"), Dimension.LENGTH),
    **dict.fromkeys(("velocity_sensing_horizontal_noise", "velocity_sensing_vertical_noise"), Dimension.VELOCITY),
}
"""The dimension of each number, and of the numbers in each noise; the rest have none, or one of several."""


def written_sensor(pen: Pen, sensor: Sensor) -> YamlMap:
    return pen.element(
        sensor,
        type=pen.text(sensor.type),
        link=pen.text(sensor.link_name),
        origin=written_origin(pen, sensor.origin),
        update_rate=pen.number(sensor.update_rate, Dimension.FREQUENCY, default=DEFAULT_UPDATE_RATE),
        always_on=pen.flag(sensor.always_on, True),
        visualize=pen.flag(sensor.visualize, False),
        topic=pen.text(sensor.topic),
        frame=pen.text(sensor.frame),
        plugin=written_plugin(pen, sensor.plugin, named=True) if sensor.plugin else None,
        **{key: _info(pen, getattr(sensor, f"{key}_info")) for key in _INFOS},
    )


def _info(pen: Pen, info: Element | None, unit: Dimension | None = None) -> YamlMap | None:
    """Return what a sensor measures, or a noise; `unit` is that of the numbers whose name tells none."""
    if info is None:
        return None
    said = {field.name: _value(pen, info, field, unit) for field in fields(info) if field.name not in _NOT_SAID}
    return pen.element(info, **said)


def _value(pen: Pen, info: Element, field: Field[object], unit: Dimension | None) -> YamlNode | None:
    value, unit = getattr(info, field.name), _UNITS.get(field.name, unit)
    if isinstance(value, SensorNoise):
        return _info(pen, value, Dimension.LENGTH if isinstance(info, LidarInfo) else unit)
    if isinstance(value, str):
        return pen.text(value, field.default if isinstance(field.default, str) else None)
    is_stated = isinstance(info, SensorNoise) and field.name in info.stated
    unsaid = field.default if isinstance(field.default, int | float) and not is_stated else None
    return pen.number(value, unit, default=unsaid)
