"""ros2_control: interfaces are a list of names, or a map by name where some have parameters."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TypeVar

from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
    Ros2ControlType,
)
from linkforge_compile.lower.elements import lower_element
from linkforge_compile.lower.extra import EXTRA_KEYS, common_kwargs, texts_in
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlMap

Component = TypeVar("Component", Ros2ControlJoint, Ros2ControlGpio, Ros2ControlSensor)


def lower_ros2_controls(file: Fields) -> Iterator[Ros2Control]:
    """Lower the ros2_control blocks of a file, without the faulty ones."""
    for _, control in file.each("ros2_control", "ros2_control", _lower_control):
        if control:
            yield control


def _lower_control(fields: Fields, name: str) -> Ros2Control | None:
    kind = Ros2ControlType.SYSTEM if fields.get("type") is None else fields.choice("type", Ros2ControlType)
    return lower_element(
        Ros2Control,
        fields,
        name=name,
        type=kind and kind.value,
        joints=_lower_components(Ros2ControlJoint, fields, "joints"),
        sensors=_lower_components(Ros2ControlSensor, fields, "sensors"),
        gpios=_lower_components(Ros2ControlGpio, fields, "gpios"),
    )


def _lower_components(kind: type[Component], fields: Fields, key: str) -> list[Component]:
    lowered = fields.each(key, f"ros2_control {kind.TAG}", partial(_lower_component, kind))
    return [component for _, component in lowered if component]


def _lower_component(kind: type[Component], fields: Fields, name: str) -> Component | None:
    states = _lower_interfaces(fields, "state_interfaces")
    if kind is Ros2ControlSensor:
        return lower_element(kind, fields, name=name, state_interfaces=states)
    commands = _lower_interfaces(fields, "command_interfaces")
    return lower_element(kind, fields, name=name, command_interfaces=commands, state_interfaces=states)


def _lower_interfaces(fields: Fields, key: str) -> tuple[Interface, ...]:
    if isinstance(fields.get(key), YamlMap):
        by_name = fields.each(key, "interface", _lower_interface)
        return tuple(interface for _, interface in by_name if interface is not None)
    named = fields.named_items(key)
    return tuple(Interface(name, source=SourceRef(node, None, fields.trail)) for name, node in named)


def _lower_interface(fields: Fields, name: str) -> Interface:
    return Interface(name, texts_in(fields, *EXTRA_KEYS), **common_kwargs(fields))
