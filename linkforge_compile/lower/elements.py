"""Elements read from an object of the tree as their class describes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkforge_compile.core.fields import Choice, Flag, Noise, Number, Spec, Text, field_specs, number_fields
from linkforge_compile.core.part import Element, Part
from linkforge_compile.lower.extra import besides
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.quantities import Measure, measure_of
from linkforge_compile.units import FieldUnit, Motion

if TYPE_CHECKING:
    from linkforge_compile.core.models.sensor import SensorNoise

E = TypeVar("E", bound=Element)


def lower_element(kind: type[E], fields: Fields, motion: Motion = Motion.OTHER, **values: Any) -> E | None:
    """Read an element whose other fields are `values`; None where it cannot be made, which is reported."""
    values |= lower_fields(kind, fields, motion)
    if is_incomplete(kind, values):
        return None
    return fields.build(lambda: kind(**values, **besides(fields)))


def lower_fields(kind: type[Part], fields: Fields, motion: Motion = Motion.OTHER) -> dict[str, Any]:
    """Read the fields that a model class describes, numbers in SI; what is faulty is reported, and replaced."""
    specs = field_specs(kind).items()
    return {name: lower_field(name, spec, fields, motion) for name, spec in specs if isinstance(spec, _LOWERED)}


_LOWERED = (Number, Noise, Text, Flag, Choice)


def is_incomplete(kind: type[Part], values: dict[str, Any]) -> bool:
    """Whether a field that the language requires has no value."""
    specs = field_specs(kind).items()
    return any(isinstance(spec, Number | Text) and spec.example and values[name] is None for name, spec in specs)


def stated_numbers(kind: type[Part], fields: Fields) -> Sequence[str]:
    """Return the names of the numbers that an object has a value for."""
    return [name for name in number_fields(kind) if fields.node.get(name) is not None]


def lower_field(name: str, spec: Spec, fields: Fields, motion: Motion = Motion.OTHER) -> Any:
    """Read one field of a model class as its spec says."""
    match spec:
        case Number():
            return _lower_number(name, spec, fields, measure_of(spec.unit, spec.bound, motion, spec.may_be_far), motion)
        case Noise():
            return _lower_noise(name, spec.unit, fields)
        case Text():
            value: Any = fields.text(name, required=spec.example_for(motion))
        case Flag():
            value = fields.flag(name)
        case Choice():
            value = fields.choice(name, spec.words)
            value = None if value is None else str(value)
    return spec.implied if value is None else value


def _lower_number(name: str, spec: Number, fields: Fields, measure: Measure, motion: Motion) -> float | None:
    read = fields.integer if spec.is_whole else fields.number
    value = read(name, measure, required=spec.example_for(motion))
    if value is not None:
        return value
    is_faulty = spec.example or fields.said(name) is not None or fields.is_faulty
    return spec.stand_in if is_faulty and spec.stand_in is not None else spec.implied


def _lower_noise(name: str, unit: FieldUnit, fields: Fields) -> SensorNoise | None:
    """Read a noise in the unit of what is sensed."""
    noise = fields.map(name)
    if noise is None:
        return None
    # Most robots have no sensors, whose classes take their time to define.
    from linkforge_compile.core.models.sensor import SensorNoise

    measure = measure_of(unit, None, Motion.UNKNOWN)
    numbers = {
        name: _lower_number(name, spec, noise, measure, Motion.UNKNOWN)
        for name, spec in number_fields(SensorNoise).items()
    }
    kind = noise.text("type")
    stated = [name for name in stated_numbers(SensorNoise, noise) if name.startswith("bias") and numbers[name] == 0]
    values: dict[str, Any] = numbers if kind is None else {"type": kind, **numbers}
    return noise.build(lambda: SensorNoise(**values, stated=stated, **besides(noise)))
