"""Read ros2_control blocks of URDF."""

from __future__ import annotations

from collections.abc import Callable

from linkforge_compile.core.models.ros2_control import Ros2ControlType
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.urdf.free_part import is_empty, read_word, text_of
from linkforge_compile.syntax import YamlMap, YamlNode

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
