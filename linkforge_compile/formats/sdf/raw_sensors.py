"""Sensors that are SDF already, in the settings of Gazebo, with their place and collisions in SDF."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.sensor import ForceTorqueFrame, SensorType
from linkforge_compile.formats.raw import plain_text, well_formed_elements
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.source.xml_tree import XmlElement

if TYPE_CHECKING:
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.formats.sdf.settings import Setting, Settings


CollisionName: TypeAlias = Callable[[str, str], str | None]
"""Finds the name in SDF of a collision to which a contact sensor on a link refers; None for an unknown one."""


def sensor_elements(settings: Settings, link: Link, body: Link, collision_name: CollisionName) -> Xml:
    """Return the sensors in the settings of a link for the body that holds it, at their poses on the link."""
    return Xml("".join(_written(one, link, body, collision_name) for one in settings if one.tag == "sensor"))


def collisions_in(setting: Setting) -> Iterator[tuple[str, str]]:
    """Yield the name of each contact sensor with that of a collision that it feels."""
    if setting.tag == "sensor":
        for sensor in well_formed_elements(setting.xml):
            for collision in _nested(sensor, "contact", "collision"):
                yield sensor.get("name") or "", collision.text.strip()


def frames_of_forces(setting: Setting) -> Iterator[str]:
    """Yield the frame of the axes of each force-torque sensor: parent, child, which is the default, or sensor."""
    for sensor in well_formed_elements(setting.xml) if setting.tag == "sensor" else ():
        if sensor.get("type") == SensorType.FORCE_TORQUE:
            yield next((one.text.strip() for one in _nested(sensor, "force_torque", "frame")), ForceTorqueFrame.CHILD)


def _written(setting: Setting, link: Link, body: Link, collision_name: CollisionName) -> str:
    def renamed(collision: XmlElement) -> XmlElement:
        reference = collision.text.strip()
        return collision._replace(content=(collision_name(link.name, reference) or reference,))

    sensors = (
        _changed(sensor, "contact", lambda contact: _changed(contact, "collision", renamed))
        for sensor in well_formed_elements(setting.xml)
    )
    return "".join(plain_text(sensor if link is body else _posed(sensor, link.name)) for sensor in sensors)


def _nested(sensor: XmlElement, outer: str, inner: str) -> Iterator[XmlElement]:
    """Yield the elements of a tag that are in children of a sensor with another tag."""
    return (two for one in sensor.children if one.tag == outer for two in one.children if two.tag == inner)


def _posed(sensor: XmlElement, link: str) -> XmlElement:
    if not any(child.tag == "pose" for child in sensor.children):
        pose = sensor._replace(tag="pose", values={"relative_to": link}, content=(), children=(), text="")
        return sensor._replace(content=(pose, *sensor.content))
    return _changed(
        sensor,
        "pose",
        lambda pose: pose if pose.get("relative_to") else pose._replace(values={**pose.values, "relative_to": link}),
    )


def _changed(element: XmlElement, tag: str, change: Callable[[XmlElement], XmlElement]) -> XmlElement:
    """Return an element with its children of a tag changed."""
    return element._replace(
        content=tuple(change(one) if isinstance(one, XmlElement) and one.tag == tag else one for one in element.content)
    )
