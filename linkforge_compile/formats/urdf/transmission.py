"""Transmissions as URDF writes them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.formats.element import attributes, elements, placed
from linkforge_compile.formats.parameters import parameter_elements
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.units import number_text


class EndView(NamedTuple):
    """`<joint>` or `<actuator>` of a transmission; None for a reduction or offset that is not written."""

    attributes: Xml
    hardware_interfaces: Sequence[str]
    mechanical_reduction: str | None
    offset: str | None
    elements: Xml


class TransmissionView(NamedTuple):
    """`<transmission>`."""

    attributes: Xml
    type: str
    joints: tuple[EndView, ...]
    actuators: tuple[EndView, ...]
    parameters: Xml
    elements: Xml


def transmission_views(transmissions: Iterable[Transmission]) -> tuple[TransmissionView, ...]:
    return tuple(
        TransmissionView(
            attributes(transmission, name=transmission.name),
            placed(transmission.type, transmission.source, "type"),
            tuple(map(_end, transmission.joints)),
            tuple(map(_end, transmission.actuators)),
            parameter_elements(transmission.parameters, transmission.source, "parameters"),
            elements(transmission),
        )
        for transmission in transmissions
    )


def _end(end: TransmissionJoint | TransmissionActuator) -> EndView:
    reduction = end.mechanical_reduction
    return EndView(
        attributes(end, name=end.name),
        [
            placed(interface, end.source, "hardware_interfaces", number)
            for number, interface in enumerate(end.hardware_interfaces if end.interfaces_stated else ())
        ],
        # One of 1 is written too, because loaders ask for it; None is what nobody said.
        None if reduction is None else placed(number_text(reduction), end.source, "mechanical_reduction"),
        placed(number_text(end.offset), end.source, "offset") if end.is_written("offset") else None,
        elements(end),
    )
