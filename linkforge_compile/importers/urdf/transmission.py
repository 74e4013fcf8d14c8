"""Transmissions of URDF, in the form that ros2_control and its forerunner have had since ROS Hydro."""

from __future__ import annotations

import re
from collections.abc import Collection

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.urdf.free_part import exact_number, read_word, take_texts
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_NAME = re.compile(r"[\w.\-/]+")
_COUNTS = {
    "transmission_interface/SimpleTransmission": 1,
    "transmission_interface/DifferentialTransmission": 2,
    "transmission_interface/FourBarLinkageTransmission": 2,
}
"""How many joints, and how many actuators, these types have."""


def read_transmission(transmission: ElementReader, joints: Collection[str]) -> YamlMap:
    """Read a transmission, whose name is taken; `joints` are the names of all joints: what names another stays raw."""
    kind = transmission.required("type", read_word)
    kind_text = kind.text if isinstance(kind, YamlScalar) else ""
    ends = {tag: _ends(transmission, tag, joints) for tag in ("joint", "actuator")}
    count = _COUNTS.get(kind_text)
    for tag, found in ends.items():
        if not found or (count and len(found) != count):
            raise transmission.cannot_represent(
                f"it has {len(found) or 'no'} <{tag}>, and takes {count or 'at least one'}"
            )
    parameters = take_texts(transmission, transmission.remaining())
    return transmission.map(
        type=kind,
        joints=transmission.draft.map_of(ends["joint"], transmission.span),
        actuators=transmission.draft.map_of(ends["actuator"], transmission.span),
        parameters=transmission.draft.map_of(parameters, transmission.span) if parameters else None,
    )


def _ends(transmission: ElementReader, tag: str, joints: Collection[str]) -> dict[str, YamlNode | None]:
    ends: dict[str, YamlNode | None] = {}
    for child in [child for child in transmission.remaining() if child.tag == tag]:
        name = child.get("name") or ""
        if not _NAME.fullmatch(name) or name in ends:
            raise transmission.cannot_represent(
                f"a <{tag}> in it is named '{name}', which is no name or is there already"
            )
        if tag == "joint" and name not in joints:
            raise CannotRepresentError(f"there is no joint named '{name}'", child.attributes["name"].span)
        ends[name] = transmission.read(child, _end)
    return ends


def _end(end: ElementReader) -> YamlMap:
    end.attribute("name")
    interfaces = [end.read(child, read_word) for child in end.remaining() if child.tag == "hardwareInterface"]
    usual = [one.text for one in interfaces if isinstance(one, YamlScalar)] == ["position"]
    return end.map(
        hardware_interfaces=None if usual else end.draft.list_of(interfaces, end.span),
        mechanical_reduction=_number(end, "mechanicalReduction"),
        offset=_number(end, "offset"),
    )


def _number(end: ElementReader, tag: str) -> YamlNode | None:
    """Take a number that comes back as it is spelled, and is no reduction of 0; any other child is left."""
    children = [child for child in end.remaining() if child.tag == tag]
    if len(children) != 1 or (value := exact_number(children[0])) is None or (value == 0 and tag != "offset"):
        return None
    return end.read(children[0], lambda child: child.text_number())
