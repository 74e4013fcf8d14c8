"""Read the transmissions and ros2_control blocks of a URDF."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlType,
)
from linkforge_compile.core.models.transmission import (
    JOINTS_AND_ACTUATORS,
    Transmission,
    TransmissionActuator,
    TransmissionJoint,
)
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.elements import (
    Names,
    read_children,
    read_element,
    read_field,
    require_parts,
)
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.texts import read_text, read_word
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar


def read_ros2_control(control: ElementReader) -> YamlMap:
    """Read a block whose name is taken."""
    require_parts(control, Ros2Control)
    node = read_element(
        control,
        Ros2Control,
        first={
            "type": read_field(control, Ros2Control, "type"),
            **{entry.name: entry.value for entry in control.required("hardware", _hardware)},
        },
        joints=lambda control: read_children(control, "joint", _joint),
    )
    kind, section = control.element.get("type"), node.get("joints")
    joints = [entry.value for entry in section] if isinstance(section, YamlMap) else []
    if kind == Ros2ControlType.ACTUATOR and len(joints) != 1:
        raise _refusal_in(control) or control.cannot_represent(f"an actuator has one joint, found {len(joints)}")
    if kind == Ros2ControlType.SENSOR and any(joint.child("command_interfaces") for joint in joints):
        raise control.cannot_represent("a sensor commands nothing, found a <command_interface>")
    return node


def _hardware(hardware: ElementReader) -> YamlMap:
    """Read the element that has two fields of its owner, and no place for anything else."""
    plugin, parameters = hardware.required("plugin", read_word), read_children(hardware, "param", read_text)
    hardware.require_used_up()
    return hardware.draft.map_of({"hardware_plugin": plugin, "parameters": parameters}, hardware.span)


def _joint(joint: ElementReader) -> YamlMap:
    node = read_element(joint, Ros2ControlJoint)
    if node.get("command_interfaces") is None and node.get("state_interfaces") is None:
        raise _refusal_in(joint) or joint.cannot_represent(
            "it has neither a <command_interface> nor a <state_interface>"
        )
    return node


def _refusal_in(part: ElementReader) -> CannotRepresentError | None:
    """Return why an interface in a part of a block, or in a block, is refused; None if none is."""
    inside = (one for child in part.element.children for one in (child, *child.children))
    return next((refusal for one in inside if (refusal := part.draft.refused.get(one))), None)


def find_commanded_again(robot: XmlElement) -> dict[XmlElement, CannotRepresentError]:
    """Return the command interfaces that an earlier block has; with both, a spec does not compile (LF6101)."""
    first: dict[str, XmlElement] = {}
    found: dict[XmlElement, CannotRepresentError] = {}
    for control in _children(robot, Ros2Control.TAG):
        for part in _children(control, Ros2ControlJoint.TAG, Ros2ControlGpio.TAG):
            for interface in _children(part, "command_interface"):
                name = f"{part.get('name')}/{interface.get('name')}"
                owner = first.setdefault(name, control)
                if owner is not control:
                    reason = f"'{name}' is already commanded by ros2_control '{owner.get('name')}'"
                    found[interface] = CannotRepresentError(reason, interface.span)
    return found


def _children(element: XmlElement, *tags: str) -> Iterator[XmlElement]:
    return (child for child in element.children if child.tag in tags)


_NAME = re.compile(r"[\w.\-/]+")


def read_transmission(transmission: ElementReader, names: Names) -> YamlMap:
    """Read a transmission whose name is taken; one with an unknown joint stays raw."""
    node = read_element(
        transmission,
        Transmission,
        joints=lambda transmission: _ends(transmission, TransmissionJoint, names),
        actuators=lambda transmission: _ends(transmission, TransmissionActuator, names),
    )
    kind = node.get("type")
    count = JOINTS_AND_ACTUATORS.get(kind.text) if isinstance(kind, YamlScalar) else None
    for tag in (TransmissionJoint.TAG, TransmissionActuator.TAG):
        ends = node.get(f"{tag}s")
        found = len(ends) if isinstance(ends, YamlMap) else 0
        if not found or (count and found != count):
            reason = f"it has {found or 'no'} <{tag}>, and requires {count or 'at least one'}"
            raise transmission.cannot_represent(reason)
    return node


def _ends(transmission: ElementReader, kind: type[TransmissionJoint | TransmissionActuator], names: Names) -> YamlMap:
    """Read the joints or actuators; without one of them a transmission would be another."""
    tag, ends = kind.TAG, dict[str, YamlNode | None]()
    for child in transmission.remaining(tag):
        name = child.get("name") or ""
        if not _NAME.fullmatch(name) or name in ends:
            reason = f"a <{tag}> in it is named '{name}', which is not a name or already exists"
            raise transmission.cannot_represent(reason)
        if name not in names.get(tag, (name,)):
            raise CannotRepresentError(f"there is no {tag} named '{name}'", child.attributes["name"].span)
        ends[name] = transmission.read(child, lambda end: _end(end, kind))
    return transmission.draft.map_of(ends, transmission.span)


def _end(end: ElementReader, kind: type[TransmissionJoint | TransmissionActuator]) -> YamlMap:
    end.attribute("name")
    return read_element(end, kind)
