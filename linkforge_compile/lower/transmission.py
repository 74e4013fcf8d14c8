"""Transmissions: the joints that they move and the actuators that drive them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TypeVar

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.fields import BEYOND_EPSILON
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.lower.elements import lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import NumberType
from linkforge_compile.lower.positions import joints_of, position_type_of_node
from linkforge_compile.source.span import Located
from linkforge_compile.syntax.nodes import YamlList

End = TypeVar("End", TransmissionJoint, TransmissionActuator)

_REDUCTION = NumberType(bound=BEYOND_EPSILON)


def lower_transmissions(file: Fields) -> Iterator[Transmission]:
    """Lower the transmissions of a file, without the faulty ones."""
    written_joints = joints_of(file.node)
    for _, transmission in file.each("transmissions", "transmission", partial(_lower_transmission, written_joints)):
        if transmission:
            yield transmission


def _lower_transmission(written_joints: Mapping[str, Located], fields: Fields, name: str) -> Transmission | None:
    is_valid = fields.name_is_valid(name, "transmission")
    joints = fields.each("joints", "transmission joint", partial(_lower_joint, written_joints))
    actuators = fields.each("actuators", "transmission actuator", _lower_actuator)
    return lower_element(
        Transmission,
        fields,
        name=name if is_valid else None,
        joints=[joint for _, joint in joints if joint],
        actuators=[actuator for _, actuator in actuators if actuator],
    )


def _lower_joint(written_joints: Mapping[str, Located], fields: Fields, name: str) -> TransmissionJoint | None:
    return _lower_end(TransmissionJoint, fields, name, position_type_of_node(written_joints.get(name)))


def _lower_actuator(fields: Fields, name: str) -> TransmissionActuator | None:
    # A spec does not say whether a motor turns or slides.
    return _lower_end(TransmissionActuator, fields, name, position_type_of_node(None))


def _lower_end(kind: type[End], fields: Fields, name: str, position: NumberType) -> End | None:
    node = fields.node.get("hardware_interfaces")
    are_stated = not (isinstance(node, YamlList) and not node.items)
    offset = fields.number("offset", position)
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
