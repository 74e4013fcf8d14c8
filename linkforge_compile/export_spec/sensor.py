"""Sensors as a spec writes them: where they are, how often they measure, and what."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.part import Element
from linkforge_compile.export_spec.elements import written_element, written_fields
from linkforge_compile.export_spec.gazebo import written_plugin
from linkforge_compile.export_spec.geometry import written_origin
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap

if TYPE_CHECKING:
    pass

_INFOS = ("camera", "lidar", "imu", "gps", "contact", "force_torque")


def written_sensor(pen: Pen, sensor: Sensor) -> YamlMap:
    return pen.element(
        sensor,
        type=pen.text(sensor.type),
        link=pen.text(sensor.link_name),
        origin=written_origin(pen, sensor.origin),
        update_rate=written_fields(pen, sensor).get("update_rate"),
        always_on=pen.flag(sensor.always_on, True),
        visualize=pen.flag(sensor.visualize, False),
        topic=pen.text(sensor.topic),
        frame=pen.text(sensor.frame),
        plugin=written_plugin(pen, sensor.plugin, named=True) if sensor.plugin else None,
        **{key: _info(pen, getattr(sensor, f"{key}_info")) for key in _INFOS},
    )


def _info(pen: Pen, info: Element | None) -> YamlMap | None:
    return written_element(pen, info) if info else None
