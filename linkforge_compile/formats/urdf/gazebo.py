"""Gazebo's tags in URDF: blocks, the physics of links, plugins, and sensors in the dialect of either Gazebo."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from linkforge_compile.core.fields import tags_with_text
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.models.link import USUAL_PHYSICS, Link, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import Sensor, SensorNoise, SensorType
from linkforge_compile.core.part import Element
from linkforge_compile.formats.element import (
    attributes,
    attributes_at,
    attributes_of,
    elements,
    parameter_elements,
    placed,
)
from linkforge_compile.formats.source_map import active_origins
from linkforge_compile.formats.views import View, Views
from linkforge_compile.formats.xml_text import NOTHING, Xml, spelled

# Gazebo Sim has no lidar on the CPU and refuses one with a warning; a type that is not listed keeps its name.
_TYPES: Mapping[str, Mapping[SensorType, str]] = {
    "gz": {SensorType.LIDAR: "gpu_lidar", SensorType.RAY: "gpu_lidar", SensorType.GPS: "navsat"},
    "classic": {
        SensorType.DEPTH_CAMERA: "depth",
        SensorType.RGBD_CAMERA: "depth",
        SensorType.LIDAR: "ray",
        SensorType.GPU_LIDAR: "gpu_ray",
    },
}
_INFO_TAGS: Mapping[str, Mapping[str, str]] = {"gz": {"gps": "navsat"}, "classic": {"lidar": "ray"}}

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


def has_physics(link: Link) -> bool:
    """Whether physics of a link differ from the defaults of simulators, or are stated."""
    return link.physics is not USUAL_PHYSICS and link.physics != USUAL_PHYSICS


def physics_views(links: Iterable[Link]) -> Iterator[View]:
    """Yield a block for each link with physics of its own."""
    for link in filter(has_physics, links):
        yield View(
            attributes=attributes_at(link.physics.source, reference=link.name),
            tags=[
                (tag, placed(spelled(getattr(link.physics, name)), link.physics.source, name))
                for name, tag in tags_with_text(LinkPhysics).items()
                if link.physics.is_written(name)
            ],
            properties=NOTHING,
            plugins=(),
            elements=NOTHING,
        )


def gazebo_view(block: GazeboElement) -> View:
    return View(
        attributes=attributes_of(block),
        tags=[
            (tag, placed(spelled(value), block.source, name))
            for name, tag in tags_with_text(GazeboElement).items()
            if (value := getattr(block, name)) is not None
        ],
        properties=_properties(block),
        plugins=[plugin_view(plugin) for plugin in block.plugins],
        elements=elements(block),
    )


def _properties(block: GazeboElement) -> Xml:
    if not active_origins():
        return parameter_elements(block.properties)
    # Tags of Gazebo that are keys of the language are written in the block itself, others in its `properties`.
    own = block.source.node if block.source else None
    return Xml(
        "\n".join(
            parameter_elements({tag: part}, block.source, *(() if own and own.child(tag) else ("properties",)))
            for tag, part in block.properties.items()
        )
    )


def plugin_view(plugin: GazeboPlugin) -> View:
    """Return a plugin; `content` is its raw XML, or its parameters as elements."""
    if plugin.raw_xml is None:
        content = parameter_elements(plugin.parameters, plugin.source, "parameters")
    else:
        from linkforge_compile.formats.raw import raw_elements

        content = raw_elements(plugin.raw_xml)
    return View(attributes=attributes_of(plugin), content=content, elements=elements(plugin))


def sensor_view(views: Views, sensor: Sensor, robot: Robot, gazebo: str) -> View:
    """Return a sensor; `info` is what it measures, how well: its `kind` names its template, `tag` its element."""
    kind = INFOS[SensorType(sensor.type)]
    info: Element | None = getattr(sensor, f"{kind}_info")
    # Gazebo Classic leaves the frame to the plugin that publishes.
    frame = {} if gazebo == "gz" else {"frame": None}
    return views.view(
        sensor,
        reference=placed(sensor_reference(sensor, robot), sensor.source, "link"),
        attributes=attributes_of(sensor, type=_TYPES[gazebo].get(sensor.type, sensor.type)),
        pose=_pose(sensor.origin),
        info=info and views.view(info, kind=kind, tag=_INFO_TAGS[gazebo].get(kind, kind)),
        **frame,
        **_NO_INFOS,
    )


_NO_INFOS: Mapping[str, None] = dict.fromkeys(("camera", "lidar", "imu", "navsat", "contact", "force_torque"))
"""The infos by tag, which a view of a sensor has as `info`."""


def sensor_reference(sensor: Sensor, robot: Robot) -> str:
    """Return the name that `<gazebo reference>` gives: the link, or the joint above it, where Gazebo senses forces."""
    if sensor.type == SensorType.FORCE_TORQUE and (joint := robot.get_parent_joint(sensor.link_name)):
        return joint.name
    return sensor.link_name


def _pose(pose: Transform) -> Xml:
    if not pose.is_written:
        return NOTHING
    text, inner = spelled((*pose.xyz, *pose.rpy)), elements(pose)
    return Xml(f"<pose{attributes(pose)}>{text}{inner}</pose>")


def noise_view(views: Views, noise: SensorNoise) -> View:
    """Return noise with its type as a text, since only some sensors have it as an attribute, and no bias of 0."""
    return views.view(
        noise,
        attributes=attributes(noise),
        type=placed(noise.type, noise.source, "type"),
        **{name: None for name in ("bias_mean", "bias_stddev") if not noise.is_written(name)},
    )
