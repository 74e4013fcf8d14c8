"""Sensors as a spec writes them: where they are, how often they measure, and what."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.part import Element
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import written_element, written_fields
from linkforge_compile.export_spec.gazebo import written_plugin
from linkforge_compile.export_spec.geometry import written_origin
from linkforge_compile.syntax import YamlMap

if TYPE_CHECKING:
    pass

_INFOS = ("camera", "lidar", "imu", "gps", "contact", "force_torque")


def written_sensor(builder: SpecBuilder, sensor: Sensor) -> YamlMap:
    return builder.element(
        sensor,
        type=builder.text(sensor.type),
        link=builder.text(sensor.link_name),
        origin=written_origin(builder, sensor.origin),
        update_rate=written_fields(builder, sensor).get("update_rate"),
        always_on=builder.flag(sensor.always_on, True),
        visualize=builder.flag(sensor.visualize, False),
        topic=builder.text(sensor.topic),
        frame=builder.text(sensor.frame),
        plugin=written_plugin(builder, sensor.plugin, named=True) if sensor.plugin else None,
        **{key: _info(builder, getattr(sensor, f"{key}_info")) for key in _INFOS},
    )


def _info(builder: SpecBuilder, info: Element | None) -> YamlMap | None:
    return written_element(builder, info) if info else None
