"""Elements whose fields are numbers: read from an object of the tree as their class describes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

from linkforge_compile.core.fields import Number, number_fields
from linkforge_compile.core.part import Element
from linkforge_compile.lowering.extra import besides
from linkforge_compile.lowering.fields import Fields
from linkforge_compile.lowering.quantities import measure_of
from linkforge_compile.units import Motion

E = TypeVar("E", bound=Element)


def lower_numbers(kind: type[Element], fields: Fields, motion: Motion = Motion.OTHER) -> dict[str, Any]:
    """Read the numbers of a model class [SI]; a faulty one is reported, and its stand-in returned."""
    return {name: _lower_number(name, spec, fields, motion) for name, spec in number_fields(kind).items()}


def _lower_number(name: str, spec: Number, fields: Fields, motion: Motion) -> float | None:
    value = fields.number(name, measure_of(spec.unit, spec.bound, motion), required=spec.example.get(motion, ""))
    if value is not None:
        return value
    is_faulty = spec.example or fields.said(name) is not None or fields.is_faulty
    return spec.stand_in if is_faulty and spec.stand_in is not None else spec.implied


def stated_numbers(kind: type[Element], fields: Fields) -> Sequence[str]:
    """Return the names of the numbers that an object has a value for."""
    return [name for name in number_fields(kind) if fields.node.get(name) is not None]


def lower_element(kind: type[E], fields: Fields, motion: Motion = Motion.OTHER, **values: Any) -> E | None:
    """Read an element whose other fields are `values`; None where its constructor refuses it, which is reported."""
    numbers = lower_numbers(kind, fields, motion)
    return fields.build(lambda: kind(**values, **numbers, **besides(fields)))
