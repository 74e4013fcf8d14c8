"""Write transmissions, whose ends state their interfaces and reduction by rules of their own."""

from __future__ import annotations

from linkforge_compile.core.constants import HW_IF_POSITION
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_element
from linkforge_compile.syntax import YamlMap


def export_transmission(builder: SpecBuilder, transmission: Transmission) -> YamlMap:
    """Return a transmission."""
    joints = ((joint.name, _end(builder, joint)) for joint in transmission.joints)
    actuators = ((actuator.name, _end(builder, actuator)) for actuator in transmission.actuators)
    return export_element(
        builder,
        transmission,
        joints=builder.named("transmission joint", joints, with_origins=False),
        actuators=builder.named("actuator", actuators, with_origins=False),
    )


def _end(builder: SpecBuilder, end: TransmissionJoint | TransmissionActuator) -> YamlMap:
    is_default = tuple(end.hardware_interfaces) == (HW_IF_POSITION,) and not builder.full
    interfaces = None if is_default else builder.texts(end.hardware_interfaces)
    return export_element(
        builder,
        end,
        hardware_interfaces=interfaces if end.interfaces_stated else builder.list_of(()),
        # Written even if it is 1: without it there is no reduction in the URDF.
        mechanical_reduction=builder.number(end.mechanical_reduction),
    )
