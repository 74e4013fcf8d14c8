"""Transmissions as a spec writes them."""

from __future__ import annotations

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap


def written_transmission(pen: Pen, transmission: Transmission) -> YamlMap:
    joints = ((joint.name, _end(pen, joint)) for joint in transmission.joints)
    actuators = ((actuator.name, _end(pen, actuator)) for actuator in transmission.actuators)
    return pen.element(
        transmission,
        type=pen.text(transmission.type),
        joints=pen.named("transmission joint", joints, told=False),
        actuators=pen.named("actuator", actuators, told=False),
        parameters=pen.free_map(transmission.parameters),
    )


def _end(pen: Pen, end: TransmissionJoint | TransmissionActuator) -> YamlMap:
    usual = tuple(end.hardware_interfaces) == (HW_IF_POSITION,) and not pen.full
    interfaces = None if usual else pen.texts(end.hardware_interfaces)
    return pen.element(
        end,
        hardware_interfaces=interfaces if end.interfaces_stated else pen.list_of(()),
        # A reduction of 1 is written as well: what is not said is none, and an actuator without one has no default.
        mechanical_reduction=pen.number(end.mechanical_reduction),
        offset=pen.number(end.offset, default=None if end.is_written("offset") else 0),
    )
