"""Transmissions as a spec writes them."""

from __future__ import annotations

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.syntax import YamlMap


def written_transmission(builder: SpecBuilder, transmission: Transmission) -> YamlMap:
    joints = ((joint.name, _end(builder, joint)) for joint in transmission.joints)
    actuators = ((actuator.name, _end(builder, actuator)) for actuator in transmission.actuators)
    return builder.element(
        transmission,
        type=builder.text(transmission.type),
        joints=builder.named("transmission joint", joints, told=False),
        actuators=builder.named("actuator", actuators, told=False),
        parameters=builder.free_map(transmission.parameters),
    )


def _end(builder: SpecBuilder, end: TransmissionJoint | TransmissionActuator) -> YamlMap:
    usual = tuple(end.hardware_interfaces) == (HW_IF_POSITION,) and not builder.full
    interfaces = None if usual else builder.texts(end.hardware_interfaces)
    return builder.element(
        end,
        hardware_interfaces=interfaces if end.interfaces_stated else builder.list_of(()),
        # A reduction of 1 is written as well: what is not said is none, and an actuator without one has no default.
        mechanical_reduction=builder.number(end.mechanical_reduction),
        offset=builder.number(end.offset, default=None if end.is_written("offset") else 0),
    )
