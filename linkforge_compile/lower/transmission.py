"""Transmissions: the joints that they move and the actuators that drive them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TypeVar

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.fields import BEYOND_EPSILON
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.lower.extra import common_kwargs, free_elements
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import joints_of, position_type_of_node
from linkforge_compile.lower.numbers import NumberType
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax import YamlList, YamlNode

End = TypeVar("End", TransmissionJoint, TransmissionActuator)

_REDUCTION = NumberType(bound=BEYOND_EPSILON)


def lower_transmissions(file: Fields) -> Iterator[Transmission]:
    """Lower the transmissions of a file, without those that are lost."""
    joints = joints_of(file.node)
    for _, transmission in file.each("transmissions", "transmission", partial(_transmission, joints)):
        if transmission:
            yield transmission


def _transmission(written: Mapping[str, Located], fields: Fields, name: str) -> Transmission | None:
    valid = fields.name_is_valid(name, "transmission")
    kind = fields.text("type", required="transmission_interface/SimpleTransmission")
    joints = dict(fields.each("joints", "transmission joint", partial(_joint, written)))
    actuators = dict(fields.each("actuators", "transmission actuator", _actuator))
    parameters = free_elements(fields, "parameters")
    whole_joints = [joint for joint in joints.values() if joint]
    whole_actuators = [actuator for actuator in actuators.values() if actuator]
    if not valid or kind is None:
        return None
    make = partial(Transmission, name, kind, whole_joints, whole_actuators, parameters)
    return fields.build(lambda: make(**common_kwargs(fields)))


def _joint(written: Mapping[str, Located], end: Fields, name: str) -> TransmissionJoint | None:
    return _end(TransmissionJoint, end, name, position_type_of_node(written.get(name)))


def _actuator(end: Fields, name: str) -> TransmissionActuator | None:
    # Nobody says whether a motor turns or slides.
    return _end(TransmissionActuator, end, name, position_type_of_node(None))


def _end(kind: type[End], end: Fields, name: str, position: NumberType) -> End | None:
    said = end.node.get("hardware_interfaces")
    are_stated = not _is_empty_list(said)
    interfaces = end.names("hardware_interfaces") if said and are_stated else (HW_IF_POSITION,)
    reduction = end.number("mechanical_reduction", _REDUCTION)
    offset = end.number("offset", position)
    make = partial(kind, name, interfaces, reduction, offset or 0.0, stated=("offset",) if offset == 0 else ())
    return end.build(lambda: make(interfaces_stated=are_stated, **common_kwargs(end)))


def _is_empty_list(node: YamlNode | None) -> bool:
    return isinstance(node, YamlList) and not len(node)
