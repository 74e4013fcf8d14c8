"""Sensors that are SDF already, in the settings of Gazebo, where the link that they are on is a frame."""

from __future__ import annotations

from linkforge_compile.formats.raw import plain_text, well_formed_elements
from linkforge_compile.formats.sdf.settings import Settings
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.source.xml_tree import XmlElement


def sensors_of_frame(settings: Settings, link: str) -> Xml:
    """Return the sensors of a link without a body, for the body that holds it: their poses are relative to the link."""
    sensors = (sensor for one in settings if one.tag == "sensor" for sensor in well_formed_elements(one.xml))
    return Xml("".join(plain_text(_posed(sensor, link)) for sensor in sensors))


def _posed(sensor: XmlElement, link: str) -> XmlElement:
    pose = next((child for child in sensor.children if child.tag == "pose"), None)
    if pose is None:
        added = sensor._replace(tag="pose", values={"relative_to": link}, content=(), children=(), text="")
        return sensor._replace(content=(added, *sensor.content))
    if pose.get("relative_to"):
        return sensor
    changed = pose._replace(values={**pose.values, "relative_to": link})
    return sensor._replace(content=tuple(changed if one is pose else one for one in sensor.content))
