"""Read the transmissions and ros2_control blocks of a URDF."""

from __future__ import annotations

import re
from collections.abc import Callable

from linkforge_compile.core.models.ros2_control import Ros2ControlType
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.elements import Names
from linkforge_compile.importers.plugin_data import exact_number, is_empty, read_word, take_texts, text_of
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_RESERVED = ("extra", "extra_attributes")
"""Keys of an interface, which its parameters cannot have."""

_Nodes = dict[str, YamlNode | None]


def read_ros2_control(control: ElementReader) -> YamlMap:
    """Read a block whose name is taken."""
    kind = control.required_text("type")
    if kind.text not in tuple(Ros2ControlType):
        raise CannotRepresentError(f"there is no type named '{kind.text}'", kind.span)
    hardware = control.required("hardware", _hardware)
    joints = _take_named(control, "joint", _joint)
    sensors, gpios = _take_named(control, "sensor", _sensor), _take_named(control, "gpio", _commanded)
    if kind.text == Ros2ControlType.ACTUATOR and len(joints) != 1:
        raise control.cannot_represent(f"an actuator has one joint, found {len(joints)}")
    if kind.text == Ros2ControlType.SENSOR and any(
        isinstance(one, YamlMap) and one.get("command_interfaces") for one in joints.values()
    ):
        raise control.cannot_represent("a sensor commands nothing, found a <command_interface>")
    return control.map(
        type=None if kind.text == Ros2ControlType.SYSTEM else kind,
        **{entry.name: entry.value for entry in hardware} if isinstance(hardware, YamlMap) else {},
        joints=_map_or_none(control, joints),
        sensors=_map_or_none(control, sensors),
        gpios=_map_or_none(control, gpios),
    )


def _hardware(hardware: ElementReader) -> YamlMap:
    node = hardware.draft.map_of(
        {"hardware_plugin": hardware.required("plugin", read_word), "parameters": _parameters(hardware)}, hardware.span
    )
    hardware.require_used_up()
    return node


def _joint(joint: ElementReader) -> YamlMap:
    node = _commanded(joint)
    if node.get("command_interfaces") is None and node.get("state_interfaces") is None:
        raise joint.cannot_represent("it has neither a <command_interface> nor a <state_interface>")
    return node


def _commanded(component: ElementReader) -> YamlMap:
    commands, states = _interfaces(component, "command_interface"), _interfaces(component, "state_interface")
    return component.map(command_interfaces=commands, state_interfaces=states, parameters=_parameters(component))


def _sensor(sensor: ElementReader) -> YamlMap:
    return sensor.map(state_interfaces=_interfaces(sensor, "state_interface"), parameters=_parameters(sensor))


def _interfaces(component: ElementReader, tag: str) -> YamlNode | None:
    """Read interfaces: a list of their names, or a map where one has parameters or extras."""
    interfaces = _take_named(component, tag, _interface)
    if not all(is_empty(node) for node in interfaces.values() if node is not None):
        return _map_or_none(component, interfaces)
    draft, names = component.draft, []
    for name, node in interfaces.items():
        if node is not None:
            names.append(draft.text(name, node.span))
            draft.note_same_source(names[-1], node)
    return draft.list_of(names, component.span) if names else None


def _interface(interface: ElementReader) -> YamlMap:
    parameters = _take_named(interface, "param", _parameter)
    if any(name in _RESERVED for name in parameters):
        raise interface.cannot_represent("a parameter of it is named as a key of the language")
    return interface.map(**parameters)


def _parameters(owner: ElementReader) -> YamlNode | None:
    return _map_or_none(owner, _take_named(owner, "param", _parameter))


def _parameter(parameter: ElementReader) -> YamlNode:
    node = parameter.draft.word(text_of(parameter.element), parameter.span)
    parameter.take_text()
    parameter.require_used_up()
    return node


def _map_or_none(owner: ElementReader, nodes: _Nodes) -> YamlMap | None:
    return owner.draft.map_of(nodes, owner.span) if nodes else None


def _take_named(owner: ElementReader, tag: str, read: Callable[[ElementReader], YamlNode]) -> _Nodes:
    """Take the children of a tag by name; one without a name, or with a name that is taken, stays raw."""
    nodes: _Nodes = {}

    def read_one(child: ElementReader) -> YamlNode:
        name = child.attribute("name")
        if not name.value or name.value in nodes:
            raise CannotRepresentError(f"there is a <{tag}> '{name.value}' already", name.span)
        nodes[name.value] = node = read(child)
        return node

    for child in owner.remaining(tag):
        owner.try_read(child, read_one)
    return nodes


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
