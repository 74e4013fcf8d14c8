"""ros2_control: pieces of hardware with the joints, sensors and pins behind them."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from functools import partial
from typing import TypeVar

from linkforge_compile.core.constants import CONTROL_TYPE_ACTUATOR, CONTROL_TYPE_SENSOR, CONTROL_TYPE_SYSTEM
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.lower.extra import EXTRA_KEYS, common_kwargs, free_texts, texts_in
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlMap

Commanded = TypeVar("Commanded", Ros2ControlJoint, Ros2ControlGpio)


class _Type(StrEnum):
    SYSTEM = CONTROL_TYPE_SYSTEM
    ACTUATOR = CONTROL_TYPE_ACTUATOR
    SENSOR = CONTROL_TYPE_SENSOR


def lower_ros2_controls(file: Fields) -> Iterator[Ros2Control]:
    """Lower the ros2_control blocks of a file, without those that are lost."""
    for _, control in file.each("ros2_control", "ros2_control", _control):
        if control:
            yield control


def _control(fields: Fields, name: str) -> Ros2Control | None:
    kind = _Type.SYSTEM if fields.node.get("type") is None else fields.choice("type", _Type)
    plugin = fields.text("hardware_plugin", required="mock_components/GenericSystem")
    joints = dict(fields.each("joints", "ros2_control joint", partial(_commanded, Ros2ControlJoint)))
    sensors = dict(fields.each("sensors", "ros2_control sensor", _sensor))
    gpios = dict(fields.each("gpios", "ros2_control gpio", partial(_commanded, Ros2ControlGpio)))
    parameters = free_texts(fields, "parameters")
    if kind is None or plugin is None:
        return None
    return fields.build(
        lambda: Ros2Control(
            name,
            kind.value,
            plugin,
            [joint for joint in joints.values() if joint],
            [sensor for sensor in sensors.values() if sensor],
            parameters,
            gpios=[gpio for gpio in gpios.values() if gpio],
            **common_kwargs(fields),
        )
    )


def _commanded(kind: type[Commanded], part: Fields, name: str) -> Commanded | None:
    commands = tuple(_interfaces(part, "command_interfaces"))
    states = tuple(_interfaces(part, "state_interfaces"))
    parameters = free_texts(part, "parameters")
    make = partial(kind, name, commands, states, parameters, **common_kwargs(part))
    return part.build(make)


def _sensor(part: Fields, name: str) -> Ros2ControlSensor | None:
    states, parameters = tuple(_interfaces(part, "state_interfaces")), free_texts(part, "parameters")
    return part.build(lambda: Ros2ControlSensor(name, states, parameters, **common_kwargs(part)))


def _interfaces(part: Fields, key: str) -> Iterator[Interface]:
    """Read interfaces: a list of their names, or a map by name where some have parameters."""
    if isinstance(part.node.get(key), YamlMap):
        yield from (interface for _, interface in part.each(key, "interface", _interface) if interface is not None)
        return
    for name, node in part.named_items(key):
        yield Interface(name, source=SourceRef(node, None, part.trail))


def _interface(interface: Fields, name: str) -> Interface:
    parameters = texts_in(interface, *EXTRA_KEYS)
    return Interface(name, parameters, **common_kwargs(interface))
