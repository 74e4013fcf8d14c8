"""Sensors as Gazebo's tags in URDF, in the dialect of Gazebo Sim or of Gazebo Classic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import SimpleNamespace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.models.sensor import Sensor, SensorNoise, SensorType
from linkforge_compile.core.part import Element
from linkforge_compile.formats.element import attributes, elements, whole
from linkforge_compile.formats.markup import NOTHING, Xml, placed, spelled
from linkforge_compile.formats.urdf.gazebo import PluginView, plugin_view
from linkforge_compile.units import number_text

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.source import SourceRef

# Gazebo Sim has no lidar on the CPU and turns one away with a warning; what is not listed keeps its name.
_TYPES: Mapping[str, Mapping[SensorType, str]] = {
    "gz": {SensorType.LIDAR: "gpu_lidar", SensorType.RAY: "gpu_lidar", SensorType.GPS: "navsat"},
    "classic": {
        SensorType.DEPTH_CAMERA: "depth",
        SensorType.RGBD_CAMERA: "depth",
        SensorType.LIDAR: "ray",
        SensorType.GPU_LIDAR: "gpu_ray",
    },
}
_INFO_TAGS: Mapping[str, Mapping[str, str]] = {
    "gz": {"gps": "navsat"},
    "classic": {"lidar": "ray"},
}

INFOS: Mapping[SensorType, str] = {
    SensorType.CAMERA: "camera",
    SensorType.DEPTH_CAMERA: "camera",
    SensorType.RGBD_CAMERA: "camera",
    SensorType.LIDAR: "lidar",
    SensorType.RAY: "lidar",
    SensorType.GPU_LIDAR: "lidar",
    SensorType.IMU: "imu",
    SensorType.GPS: "gps",
    SensorType.FORCE_TORQUE: "force_torque",
    SensorType.CONTACT: "contact",
}
"""Which of its infos a sensor of each type writes: `camera` for its `camera_info`, and so on."""


class NoiseView(NamedTuple):
    """`<noise>`; None for a bias that nobody states."""

    attributes: Xml
    type: str
    mean: str
    stddev: str
    bias_mean: str | None
    bias_stddev: str | None
    elements: Xml


Value: TypeAlias = str | NoiseView | None


class InfoView(NamedTuple):
    """What a sensor measures, how well; `values` has the fields of the model, ready, under their own names.

    `kind` names its template, `tag` its element.
    """

    kind: str
    tag: str
    attributes: Xml
    values: SimpleNamespace
    elements: Xml


class SensorView(NamedTuple):
    """`<sensor>` in its `<gazebo reference>`; None or nothing for what is not stated."""

    reference: str
    attributes: Xml
    always_on: str
    update_rate: str
    visualize: str
    pose: Xml
    topic: str | None
    frame: str | None
    info: InfoView | None
    plugin: PluginView | None
    elements: Xml


def sensor_views(robot: Robot, gazebo: str) -> tuple[SensorView, ...]:
    return tuple(
        SensorView(
            placed(sensor_reference(sensor, robot), sensor.source, "link"),
            attributes(sensor, name=sensor.name, type=_TYPES[gazebo].get(sensor.type, sensor.type)),
            placed(spelled(sensor.always_on), sensor.source, "always_on"),
            placed(number_text(sensor.update_rate), sensor.source, "update_rate"),
            placed(spelled(sensor.visualize), sensor.source, "visualize"),
            _pose(sensor.origin),
            None if sensor.topic is None else placed(sensor.topic, sensor.source, "topic"),
            # Gazebo Classic leaves the frame to the plugin that publishes.
            None if sensor.frame is None or gazebo != "gz" else placed(sensor.frame, sensor.source, "frame"),
            _info(sensor, gazebo),
            plugin_view(sensor.plugin) if sensor.plugin else None,
            elements(sensor),
        )
        for sensor in robot.sensors
    )


def sensor_reference(sensor: Sensor, robot: Robot) -> str:
    """Return the name that `<gazebo reference>` gives: the link, or the joint above it, where Gazebo senses forces."""
    if sensor.type == SensorType.FORCE_TORQUE and (joint := robot.get_parent_joint(sensor.link_name)):
        return joint.name
    return sensor.link_name


def _info(sensor: Sensor, gazebo: str) -> InfoView | None:
    kind = INFOS[SensorType(sensor.type)]
    info: Element | None = getattr(sensor, f"{kind}_info")
    if info is None:
        return None
    names = [field.name for field in fields(info) if field.name not in _EVERYWHERE]
    values = {name: _ready(getattr(info, name), info.source, name) for name in names}
    tag = _INFO_TAGS[gazebo].get(kind, kind)
    return InfoView(kind, tag, attributes(info), SimpleNamespace(**values), elements(info))


_EVERYWHERE = frozenset(field.name for field in fields(Element))


def _ready(value: str | float | SensorNoise | None, source: SourceRef | None, name: str) -> Value:
    if isinstance(value, SensorNoise):
        return _noise(value)
    return None if value is None else placed(spelled(value), source, name)


def _noise(noise: SensorNoise) -> NoiseView:
    return NoiseView(
        attributes(noise),
        placed(noise.type, noise.source, "type"),
        placed(number_text(noise.mean), noise.source, "mean"),
        placed(number_text(noise.stddev), noise.source, "stddev"),
        _bias(noise, "bias_mean"),
        _bias(noise, "bias_stddev"),
        elements(noise),
    )


def _pose(pose: Transform) -> Xml:
    return whole("pose", pose, Xml(spelled((*pose.xyz, *pose.rpy)))) if pose.is_written else NOTHING


def _bias(noise: SensorNoise, name: str) -> str | None:
    return placed(number_text(getattr(noise, name)), noise.source, name) if noise.is_written(name) else None
