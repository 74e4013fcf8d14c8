"""Sensors: a sensor without the object that its type requires gets one with its defaults."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.core.fields import Child, field_specs
from linkforge_compile.core.models.sensor import REQUIRED_INFO, Sensor, SensorType
from linkforge_compile.lower.elements import lower_element, lower_fields
from linkforge_compile.lower.fields import Fields


def lower_sensors(file: Fields) -> Iterator[Sensor]:
    """Lower the sensors of a file, without the faulty ones."""
    for _, sensor in file.each("sensors", "sensor", _lower_sensor):
        if sensor:
            yield sensor


def _lower_sensor(fields: Fields, name: str) -> Sensor | None:
    sensor_type = fields.choice("type", SensorType, required="camera")
    values = lower_fields(Sensor, fields, name=name, type=sensor_type)
    info = REQUIRED_INFO.get(sensor_type) if sensor_type else None
    if info and values[info] is None:
        spec = field_specs(Sensor)[info]
        if info == "contact_info":
            fields.get("contact", required="{collision: fingertip_collision}")
        if info == "contact_info" or fields.get(spec.key or info) is not None or not isinstance(spec, Child):
            return None
        values[info] = spec.kinds[0]()
    return lower_element(Sensor, fields, **values)
