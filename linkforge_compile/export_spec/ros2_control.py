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
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.syntax import YamlMap, YamlNode


def written_ros2_control(builder: SpecBuilder, control: Ros2Control) -> YamlMap:
    return builder.element(
        control,
        type=builder.text(control.type, CONTROL_TYPE_SYSTEM),
        hardware_plugin=builder.text(control.hardware_plugin),
        parameters=builder.free_map(control.parameters),
        joints=builder.named("ros2_control joint", _components(builder, control.joints), told=False),
        sensors=builder.named("ros2_control sensor", _components(builder, control.sensors), told=False),
        gpios=builder.named("gpio", _components(builder, control.gpios), told=False),
    )


def _components(
    builder: SpecBuilder, components: Sequence[Ros2ControlJoint | Ros2ControlSensor | Ros2ControlGpio]
) -> list[tuple[str, YamlNode]]:
    return [(component.name, _component(builder, component)) for component in components]


def _component(builder: SpecBuilder, component: Ros2ControlJoint | Ros2ControlSensor | Ros2ControlGpio) -> YamlMap:
    commands = () if isinstance(component, Ros2ControlSensor) else component.command_interfaces
    return builder.element(
        component,
        command_interfaces=_interfaces(builder, commands),
        state_interfaces=_interfaces(builder, component.state_interfaces),
        parameters=builder.free_map(component.parameters),
    )


def _interfaces(builder: SpecBuilder, names: Sequence[str]) -> YamlNode | None:
    """Return interfaces as a list of names, or as a map where one of them has more to say."""
    interfaces = [Interface.of(name) for name in names]
    if not any(one.parameters or one.extra_attributes or one.extra_elements or one.extra_inside for one in interfaces):
        return builder.texts(interfaces)
    return builder.named("interface", ((str(one), _interface(builder, one)) for one in interfaces), told=False)


def _interface(builder: SpecBuilder, interface: Interface) -> YamlMap:
    return builder.element(interface, **{name: builder.free(text) for name, text in interface.parameters.items()})
