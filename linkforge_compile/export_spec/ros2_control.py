"""ros2_control blocks as a spec writes them."""

from __future__ import annotations

from collections.abc import Sequence

from linkforge_compile.core.constants import CONTROL_TYPE_SYSTEM
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap, YamlNode


def written_ros2_control(pen: Pen, control: Ros2Control) -> YamlMap:
    return pen.element(
        control,
        type=pen.text(control.type, CONTROL_TYPE_SYSTEM),
        hardware_plugin=pen.text(control.hardware_plugin),
        parameters=pen.free_map(control.parameters),
        joints=pen.named("ros2_control joint", _components(pen, control.joints), told=False),
        sensors=pen.named("ros2_control sensor", _components(pen, control.sensors), told=False),
        gpios=pen.named("gpio", _components(pen, control.gpios), told=False),
    )


def _components(
    pen: Pen, components: Sequence[Ros2ControlJoint | Ros2ControlSensor | Ros2ControlGpio]
) -> list[tuple[str, YamlNode]]:
    return [(component.name, _component(pen, component)) for component in components]


def _component(pen: Pen, component: Ros2ControlJoint | Ros2ControlSensor | Ros2ControlGpio) -> YamlMap:
    commands = () if isinstance(component, Ros2ControlSensor) else component.command_interfaces
    return pen.element(
        component,
        command_interfaces=_interfaces(pen, commands),
        state_interfaces=_interfaces(pen, component.state_interfaces),
        parameters=pen.free_map(component.parameters),
    )


def _interfaces(pen: Pen, names: Sequence[str]) -> YamlNode | None:
    """Return interfaces as a list of names, or as a map where one of them has more to say."""
    interfaces = [Interface.of(name) for name in names]
    if not any(one.parameters or one.extra_attributes or one.extra_elements or one.extra_inside for one in interfaces):
        return pen.texts(interfaces)
    return pen.named("interface", ((str(one), _interface(pen, one)) for one in interfaces), told=False)


def _interface(pen: Pen, interface: Interface) -> YamlMap:
    return pen.element(interface, **{name: pen.free(text) for name, text in interface.parameters.items()})
