"""Elements read from an object of the tree as their class describes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkforge_compile.core.fields import Choice, Flag, Noise, Number, Spec, Text, field_specs, number_fields
from linkforge_compile.core.models.geometry import IDENTITY, Transform
from linkforge_compile.core.part import Element, Part
from linkforge_compile.lower.extra import common_kwargs
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import ANGLE, LENGTH, number_type
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlList
from linkforge_compile.units import FieldUnit, Motion

if TYPE_CHECKING:
    from linkforge_compile.core.models.sensor import SensorNoise

E = TypeVar("E", bound=Element)


def lower_element(kind: type[E], fields: Fields, motion: Motion = Motion.OTHER, **values: Any) -> E | None:
    """Read an element whose other fields are `values`; None where it cannot be made, which is reported."""
    values |= lower_fields(kind, fields, motion)
    if _is_incomplete(kind, values):
        return None
    return fields.build(lambda: kind(**values, **common_kwargs(fields)))


def lower_fields(
    kind: type[Part], fields: Fields, motion: Motion = Motion.OTHER, unit: FieldUnit | None = None
) -> dict[str, Any]:
    """Read the fields that a model class describes, numbers in SI; what is faulty is reported, and replaced.

    `unit` is that of its numbers, where they are the noise on a value; None for the units that the class describes.
    """
    return {name: _lower_field(name, spec, fields, motion, unit) for name, spec in field_specs(kind).items()}


def _is_incomplete(kind: type[Part], values: dict[str, Any]) -> bool:
    """Whether a field that the language requires has no value."""
    specs = field_specs(kind).items()
    return any(isinstance(spec, Number | Text) and spec.example and values[name] is None for name, spec in specs)


def stated_numbers(kind: type[Part], fields: Fields) -> Sequence[str]:
    """Return the names of the numbers that an object has a value for."""
    return [name for name in number_fields(kind) if fields.node.get(name) is not None]


def _lower_field(name: str, spec: Spec, fields: Fields, motion: Motion, unit: FieldUnit | None) -> Any:
    match spec:
        case Number():
            return _lower_number(name, spec, fields, motion, unit or spec.unit)
        case Noise():
            return _lower_noise(name, spec.unit, fields)
        case Text():
            value: Any = fields.text(name, required=spec.example)
        case Flag():
            value = fields.flag(name)
        case Choice():
            value = fields.choice(name, spec.words)
            value = None if value is None else str(value)
    return spec.implied if value is None else value


def _lower_number(name: str, spec: Number, fields: Fields, motion: Motion, unit: FieldUnit) -> float | None:
    kind = number_type(unit, spec.bound, motion, spec.may_be_far)
    read = fields.integer if spec.is_whole else fields.number
    value = read(name, kind, required=spec.example_for(motion))
    if value is not None:
        return value
    is_faulty = spec.example or fields.get(name) is not None or fields.is_faulty
    return spec.stand_in if is_faulty and spec.stand_in is not None else spec.implied


def _lower_noise(name: str, unit: FieldUnit, fields: Fields) -> SensorNoise | None:
    """Read a noise in the unit of what is sensed."""
    noise = fields.map(name)
    if noise is None:
        return None
    # Most robots have no sensors, whose classes take their time to define.
    from linkforge_compile.core.models.sensor import SensorNoise

    values = lower_fields(SensorNoise, noise, Motion.UNKNOWN, unit)
    stated = [name for name in stated_numbers(SensorNoise, noise) if name.startswith("bias") and values[name] == 0]
    return noise.build(lambda: SensorNoise(**values, stated=stated, **common_kwargs(noise)))


def lower_origin(fields: Fields) -> Transform:
    """Read `origin`, a pose in the parent's frame: `[x, y, z]` or `{xyz, rpy}`; an absent or faulty part is 0."""
    node = fields.get("origin")
    if node is None:
        return IDENTITY
    if isinstance(node, YamlList):
        xyz = fields.vector3_at(node, "origin", LENGTH)
        return Transform(xyz, is_stated=True, source=SourceRef(node, None, fields.trail)) if xyz else IDENTITY
    pose = fields.map_at(node, "origin")
    if pose is None:
        return IDENTITY
    xyz, rpy = pose.vector3("xyz", LENGTH), pose.vector3("rpy", ANGLE)
    is_stated = pose.get("xyz") is not None or pose.get("rpy") is not None
    return Transform(xyz or IDENTITY.xyz, rpy or IDENTITY.rpy, is_stated=is_stated, **common_kwargs(pose))
