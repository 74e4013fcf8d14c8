"""Sensors, transmissions, ros2_control systems, controllers and Gazebo blocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import TypedDict, TypeVar

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.fields import BEYOND_EPSILON, Child, field_specs
from linkforge_compile.core.models.controller import MANAGER, Controller, kind_of_names
from linkforge_compile.core.models.gazebo import ELEMENT_TAGS, GazeboElement
from linkforge_compile.core.models.link import PHYSICS_TAGS
from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
    Ros2ControlType,
)
from linkforge_compile.core.models.sensor import INFO_FIELDS, MAY_LACK_INFO, Sensor, SensorType
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.core.part import FreePart, SourcedText
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.model import NOT_OF_MANAGER, TAG_TWICE
from linkforge_compile.diagnostics.entry_fixes import leave_out, leave_out_entry
from linkforge_compile.lower.elements import EXTRA_KEYS, extras_of, lower_element, lower_fields
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.free_parts import free_elements, is_absent, texts_in
from linkforge_compile.lower.joint import joints_of, position_type_of_node
from linkforge_compile.lower.nested_keys import with_nested_keys
from linkforge_compile.lower.numbers import ANGLE_OR_LENGTH, BARE, LENGTH, NumberType
from linkforge_compile.source import Key, Located, ModuleUse, SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, is_in_full, number_text


class Devices(TypedDict, total=False):
    """The arguments of a robot for its devices."""

    sensors: list[Sensor]
    transmissions: list[Transmission]
    ros2_controls: list[Ros2Control]
    gazebo_elements: list[GazeboElement]
    controllers: list[Controller]


def lower_devices(file: Fields) -> Devices:
    """Lower the devices and the Gazebo blocks of a file, without the faulty ones."""
    joints = joints_of(file.node)
    return {
        "sensors": _lowered(file.each("sensors", "sensor", _lower_sensor)),
        "transmissions": _lowered(file.each("transmissions", "transmission", partial(_lower_transmission, joints))),
        "ros2_controls": _lowered(file.each("ros2_control", "ros2_control", _lower_control)),
        "gazebo_elements": list(_lower_gazebo_elements(file, joints)),
        "controllers": _lowered(file.each("controllers", "controller", _lower_controller)),
    }


def _lowered(parts: Iterable[tuple[str, T | None]]) -> list[T]:
    """Return the parts that are not faulty."""
    return [part for _, part in parts if part is not None]


# Sensors: one without the object that its type requires gets it with its defaults


def _lower_sensor(fields: Fields, name: str) -> Sensor | None:
    sensor_type = fields.choice("type", SensorType, required="camera")
    values = lower_fields(Sensor, fields, name=name, type=sensor_type)
    info = INFO_FIELDS[sensor_type] if sensor_type and sensor_type not in MAY_LACK_INFO else None
    if info and values[info] is None:
        spec = field_specs(Sensor)[info]
        if info == "contact_info":
            fields.get("contact", required="{collision: fingertip_collision}")
        if info == "contact_info" or fields.get(spec.key or info) is not None or not isinstance(spec, Child):
            return None
        values[info] = spec.kinds[0]()
    return lower_element(Sensor, fields, **values)


T = TypeVar("T")
End = TypeVar("End", TransmissionJoint, TransmissionActuator)

_REDUCTION = NumberType(bound=BEYOND_EPSILON)


def _lower_transmission(written_joints: Mapping[str, Located], fields: Fields, name: str) -> Transmission | None:
    is_valid = fields.name_is_valid(name, "transmission")
    joints = fields.each("joints", "transmission joint", partial(_lower_end, TransmissionJoint, written_joints))
    # A spec does not say whether a motor turns or slides.
    actuators = fields.each("actuators", "transmission actuator", partial(_lower_end, TransmissionActuator, {}))
    return lower_element(
        Transmission,
        fields,
        name=name if is_valid else None,
        joints=_lowered(joints),
        actuators=_lowered(actuators),
    )


def _lower_end(kind: type[End], written_joints: Mapping[str, Located], fields: Fields, name: str) -> End | None:
    node = fields.node.get("hardware_interfaces")
    are_stated = not (isinstance(node, YamlList) and not node.items)
    offset = fields.number("offset", position_type_of_node(written_joints.get(name)))
    return lower_element(
        kind,
        fields,
        name=name,
        hardware_interfaces=fields.names("hardware_interfaces") if node and are_stated else (HW_IF_POSITION,),
        mechanical_reduction=fields.number("mechanical_reduction", _REDUCTION),
        offset=offset or 0.0,
        stated=("offset",) if offset == 0 else (),
        interfaces_stated=are_stated,
    )


Component = TypeVar("Component", Ros2ControlJoint, Ros2ControlGpio, Ros2ControlSensor)


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


def _lower_controller(fields: Fields, name: str) -> Controller | None:
    fields = with_nested_keys(fields, "parameters")
    if name == MANAGER:
        return _lower_manager(fields)
    type_ = fields.text("type", required="joint_trajectory_controller/JointTrajectoryController")
    return lower_element(Controller, fields, name=name, type=type_)


def _lower_manager(fields: Fields) -> Controller | None:
    for entry in fields.node:
        if entry.name != "parameters" and fields.node.get(entry.name) is not None:
            fix = leave_out(fields.ref, entry.name)
            fields.report(NOT_OF_MANAGER, fields.ref, Key(entry.name), fixes=[fix], field=entry.name)
    values = lower_fields(Controller, fields, name=MANAGER, type=None)
    if node := fields.node.get("parameters"):
        values["parameters"] = _with_sources(values["parameters"], node, fields.trail)
    return lower_element(Controller, fields, **values)


def _with_sources(value: object, node: YamlNode, trail: tuple[ModuleUse, ...], path: tuple[str, ...] = ()) -> object:
    """Return parameters of the manager with the places of their names, and of those in lists of names."""
    if isinstance(value, dict) and isinstance(node, YamlMap):
        entries = ((node.entries[name], item) for name, item in value.items())
        return {
            SourcedText(entry.name, SourceRef(entry.value, entry.key, trail)): _with_sources(
                item, entry.value, trail, (*path, entry.name)
            )
            for entry, item in entries
        }
    if kind_of_names(path) is None:
        return value
    if isinstance(value, list) and isinstance(node, YamlList):
        return [_with_source(item, each, trail) for item, each in zip(value, node, strict=True)]
    return _with_source(value, node, trail)


def _with_source(name: object, node: YamlNode, trail: tuple[ModuleUse, ...]) -> object:
    return SourcedText(name, SourceRef(node, None, trail)) if isinstance(name, str) else name


def _lower_components(kind: type[Component], fields: Fields, key: str) -> list[Component]:
    return _lowered(fields.each(key, f"ros2_control {kind.TAG}", partial(_lower_component, kind)))


def _lower_component(kind: type[Component], fields: Fields, name: str) -> Component | None:
    states = _lower_interfaces(fields, "state_interfaces")
    if kind is Ros2ControlSensor:
        return lower_element(kind, fields, name=name, state_interfaces=states)
    commands = _lower_interfaces(fields, "command_interfaces")
    return lower_element(kind, fields, name=name, command_interfaces=commands, state_interfaces=states)


def _lower_interfaces(fields: Fields, key: str) -> tuple[Interface, ...]:
    if isinstance(fields.get(key), YamlMap):

        def lower(each: Fields, name: str) -> Interface:
            return Interface(name, texts_in(each, *EXTRA_KEYS), source=each.ref, **extras_of(each))

        return tuple(_lowered(fields.each(key, "interface", lower)))
    named = fields.named_items(key)
    return tuple(Interface(name, source=SourceRef(node, None, fields.trail)) for name, node in named)


def _lower_gazebo_elements(file: Fields, joints: Mapping[str, YamlMap]) -> Iterator[GazeboElement]:
    """Lower the Gazebo blocks of a file: those of its links, of its joints, and of the robot."""
    for section, noun in (("links", "link"), ("joints", "joint")):
        entries = file.node.get(section)
        for entry in entries if isinstance(entries, YamlMap) else ():
            if isinstance(entry.value, YamlMap) and "gazebo" in entry.value.entries:
                owner = Fields(entry.value, f"{noun} '{entry.name}'", file.sink, file.trail, entry.key)
                yield from lower_gazebo(owner, entry.name, {entry.name: entry.value})
    yield from lower_gazebo(file, None, joints)


def lower_gazebo(owner: Fields, reference: str | None, joints: Mapping[str, YamlMap]) -> Iterator[GazeboElement]:
    """Lower the blocks of the link or joint `reference`, None for the robot.

    A block of the robot may name what it refers to, such as a link of a module. `joints` are the nodes of the joints,
    by name, that a block may refer to.
    """
    physics = owner.node.get("physics")
    tags_of_physics = dict(_tags_of_physics(physics)) if isinstance(physics, YamlMap) else {}
    for node in owner.items("gazebo"):
        block = owner.map_at(node, "gazebo")
        if block is None:
            continue
        _report_repeated_tags(block, tags_of_physics)
        target = block.text("reference") if reference is None else reference
        position = position_type_of_node(joints.get(target) if target is not None else None)
        element = lower_element(
            GazeboElement,
            block,
            reference=target,
            properties={**dict(_known_properties(block, position)), **free_elements(block, "properties")},
        )
        if element:
            yield element


def _known_properties(block: Fields, position: NumberType) -> Iterator[tuple[str, FreePart]]:
    """Yield the tags that have keys of their own, in the order written; `position` is that of the joint."""
    for entry in block.node:
        read = _number_of(position) if entry.name == "springReference" else _READ.get(entry.name)
        text = read(block, entry.name) if read else None
        if text is not None:
            yield entry.name, text


def _report_repeated_tags(block: Fields, tags_of_physics: Mapping[str, YamlEntry]) -> None:
    first = dict(tags_of_physics)
    for tag, entry in _tags_of_block(block.node):
        earlier = first.setdefault(tag, entry)
        if earlier is not entry:
            notes = [Note("the first is here", earlier.key.span)]
            place = SourceRef(entry.key, None, block.trail)
            fault = TAG_TWICE.at(place, tag=tag, owner=block.owner, notes=notes)
            block.sink.report(fault.with_fix(leave_out_entry(entry.key.span, entry.value.span)))


def _tags_of_physics(physics: YamlMap) -> Iterator[tuple[str, YamlEntry]]:
    for entry in physics:
        tag = PHYSICS_TAGS.get(entry.name)
        if tag and physics.get(entry.name) is not None:
            yield tag, entry


def _tags_of_block(block: YamlMap) -> Iterator[tuple[str, YamlEntry]]:
    for entry in block:
        tag = entry.name if entry.name in _READ else ELEMENT_TAGS.get(entry.name)
        if tag and block.get(entry.name) is not None:
            yield tag, entry
    properties = block.get("properties")
    for entry in properties if isinstance(properties, YamlMap) else ():
        is_empty = isinstance(entry.value, YamlList) and not len(entry.value)  # no item of it is there
        if not (is_empty or is_absent(entry.value)):
            yield entry.name, entry


def _number(block: Fields, key: str, accepted: NumberType = BARE) -> str | None:
    """Read a number as text, as it was written unless it needs a conversion."""
    number = block.number(key, accepted)
    if number is None:
        return None
    node = block.get(key)
    return node.text if isinstance(node, YamlScalar) and is_in_full(node.text) else number_text(number)


def _number_of(accepted: NumberType) -> Callable[[Fields, str], str | None]:
    return lambda block, key: _number(block, key, accepted)


def _whole_number(block: Fields, key: str) -> str | None:
    number = block.integer(key)
    return None if number is None else str(number)


def _flag(block: Fields, key: str) -> str | None:
    flag = block.flag(key)
    return None if flag is None else str(flag).lower()


def _vector(block: Fields, key: str) -> str | None:
    vector = block.vector3(key)
    return None if vector is None else " ".join(map(number_text, vector))


_READ: dict[str, Callable[[Fields, str], str | None]] = {
    "mu1": _number,
    "mu2": _number,
    "fdir1": _vector,
    "kp": _number,
    "kd": _number,
    "maxVel": _number_of(NumberType((Dimension.VELOCITY,))),
    "minDepth": _number_of(LENGTH),
    "maxContacts": _whole_number,
    "selfCollide": _flag,
    "gravity": _flag,
    "turnGravityOff": _flag,
    "dampingFactor": _number,
    "laserRetro": _number,
    "springStiffness": _number,
    "springReference": _number_of(ANGLE_OR_LENGTH),
    "fudgeFactor": _number,
    "preserveFixedJoint": _flag,
    "disableFixedJointLumping": _flag,
}
"""The tags of SDFormat's URDF reader that are keys under their own names, and how each is read."""
