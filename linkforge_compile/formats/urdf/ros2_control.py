"""ros2_control blocks as URDF writes them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.formats.element import attributes, elements, placed
from linkforge_compile.formats.xml_text import Xml, spelled

if TYPE_CHECKING:
    from linkforge_compile.source import SourceRef

Parameters: TypeAlias = tuple[tuple[str, str], ...]
"""Names and texts of `<param>`."""


class InterfaceView(NamedTuple):
    """`<command_interface>` or `<state_interface>`."""

    attributes: Xml
    parameters: Parameters
    elements: Xml


class ComponentView(NamedTuple):
    """`<joint>`, `<sensor>` or `<gpio>` of a ros2_control block, by its tag."""

    tag: str
    attributes: Xml
    command_interfaces: tuple[InterfaceView, ...]
    state_interfaces: tuple[InterfaceView, ...]
    parameters: Parameters
    elements: Xml


class Ros2ControlView(NamedTuple):
    """`<ros2_control>`."""

    attributes: Xml
    hardware_plugin: str
    parameters: Parameters
    components: tuple[ComponentView, ...]
    elements: Xml


def ros2_control_views(controls: Iterable[Ros2Control]) -> tuple[Ros2ControlView, ...]:
    return tuple(
        Ros2ControlView(
            attributes(control, name=control.name, type=control.type),
            placed(control.hardware_plugin, control.source, "hardware_plugin"),
            _parameters(control.parameters, control.source, "parameters"),
            (
                *(_component("joint", joint, joint.command_interfaces) for joint in control.joints),
                *(_component("sensor", sensor, ()) for sensor in control.sensors),
                *(_component("gpio", gpio, gpio.command_interfaces) for gpio in control.gpios),
            ),
            elements(control),
        )
        for control in controls
    )


def _component(
    tag: str, component: Ros2ControlJoint | Ros2ControlSensor | Ros2ControlGpio, commands: Sequence[str]
) -> ComponentView:
    return ComponentView(
        tag,
        attributes(component, name=component.name),
        tuple(map(_interface, commands)),
        tuple(map(_interface, component.state_interfaces)),
        _parameters(component.parameters, component.source, "parameters"),
        elements(component),
    )


def _interface(name: str) -> InterfaceView:
    interface = Interface.of(name)
    return InterfaceView(
        attributes(interface, name=interface), _parameters(interface.parameters, interface.source), elements(interface)
    )


def _parameters(parameters: Mapping[str, str], source: SourceRef | None, *path: str) -> Parameters:
    return tuple((placed(name, source, *path, name), spelled(value)) for name, value in parameters.items())
