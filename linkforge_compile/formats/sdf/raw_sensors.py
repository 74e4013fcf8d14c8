"""Sensors that are SDF already, in the settings of Gazebo, with their place and collisions in SDF."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from linkforge_compile.formats.raw import plain_text, well_formed_elements
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.source.xml_tree import XmlElement

if TYPE_CHECKING:
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.formats.sdf.part_names import PartNames
    from linkforge_compile.formats.sdf.settings import Setting, Settings


def sensor_elements(settings: Settings, link: Link, body: Link, names: PartNames) -> Xml:
    """Return the sensors in the settings of a link for the body that holds it, at their poses on the link."""
    return Xml("".join(_written(one, link, body, names) for one in settings if one.tag == "sensor"))


def collisions_in(setting: Setting) -> Iterator[tuple[str, str]]:
    """Yield the name of each contact sensor with that of a collision that it feels."""
    if setting.tag == "sensor":
        for sensor in well_formed_elements(setting.xml):
            for collision in _collisions(sensor):
                yield sensor.get("name") or "", collision.text.strip()


def _written(setting: Setting, link: Link, body: Link, names: PartNames) -> str:
    def renamed(collision: XmlElement) -> XmlElement:
        reference = collision.text.strip()
        return collision._replace(content=(names.collision(link.name, reference) or reference,))

    sensors = (
        _changed(sensor, "contact", lambda contact: _changed(contact, "collision", renamed))
        for sensor in well_formed_elements(setting.xml)
    )
    return "".join(plain_text(sensor if link is body else _posed(sensor, link.name)) for sensor in sensors)


def _collisions(sensor: XmlElement) -> Iterator[XmlElement]:
    contacts = (child for child in sensor.children if child.tag == "contact")
    return (child for contact in contacts for child in contact.children if child.tag == "collision")


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
