"""Read transmissions of URDF, in the form of ros2_control and its predecessor since ROS Hydro."""

from __future__ import annotations

import re

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.urdf.elements import Names
from linkforge_compile.importers.urdf.free_part import exact_number, read_word, take_texts
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_NAME = re.compile(r"[\w.\-/]+")
_COUNTS = {
    "transmission_interface/SimpleTransmission": 1,
    "transmission_interface/DifferentialTransmission": 2,
    "transmission_interface/FourBarLinkageTransmission": 2,
}
"""The number of joints, and of actuators, by type."""


def read_transmission(transmission: ElementReader, names: Names) -> YamlMap:
    """Read a transmission whose name is taken; one with an unknown joint stays raw."""
    draft, span = transmission.draft, transmission.span
    kind = transmission.required("type", read_word)
    ends = {tag: _ends(transmission, tag, names) for tag in ("joint", "actuator")}
    count = _COUNTS.get(kind.text) if isinstance(kind, YamlScalar) else None
    for tag, found in ends.items():
        if not found or (count and len(found) != count):
            reason = f"it has {len(found) or 'no'} <{tag}>, and takes {count or 'at least one'}"
            raise transmission.cannot_represent(reason)
    parameters = take_texts(transmission, transmission.remaining())
    return transmission.map(
        type=kind,
        joints=draft.map_of(ends["joint"], span),
        actuators=draft.map_of(ends["actuator"], span),
        parameters=draft.map_of(parameters, span) if parameters else None,
    )


def _ends(transmission: ElementReader, tag: str, names: Names) -> dict[str, YamlNode | None]:
    ends: dict[str, YamlNode | None] = {}
    for child in transmission.remaining(tag):
        name = child.get("name") or ""
        if not _NAME.fullmatch(name) or name in ends:
            reason = f"a <{tag}> in it is named '{name}', which is no name or is there already"
            raise transmission.cannot_represent(reason)
        if tag == "joint" and name not in names["joint"]:
            raise CannotRepresentError(f"there is no joint named '{name}'", child.attributes["name"].span)
        ends[name] = transmission.read(child, _end)
    return ends


def _end(end: ElementReader) -> YamlMap:
    end.attribute("name")
    interfaces = [end.read(child, read_word) for child in end.remaining("hardwareInterface")]
    is_default = [one.text for one in interfaces if isinstance(one, YamlScalar)] == ["position"]
    return end.map(
        hardware_interfaces=None if is_default else end.draft.list_of(interfaces, end.span),
        mechanical_reduction=_number(end, "mechanicalReduction"),
        offset=_number(end, "offset"),
    )


def _number(end: ElementReader, tag: str) -> YamlNode | None:
    """Take a child that is a number in normal form, and no reduction of 0; others stay raw."""
    children = end.remaining(tag)
    if len(children) != 1 or (value := exact_number(children[0])) is None or (value == 0 and tag != "offset"):
        return None
    return end.read(children[0], lambda child: child.text_number())
