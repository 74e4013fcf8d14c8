"""Elements written as their class describes them."""

from __future__ import annotations

from linkforge_compile.core.fields import Choice, Flag, Noise, Number, Spec, Text, field_specs
from linkforge_compile.core.part import Element, Part
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension, FieldUnit, Motion


def written_element(
    pen: Pen,
    part: Element,
    motion: Motion = Motion.OTHER,
    unit: FieldUnit | None = None,
    /,
    **entries: YamlNode | None,
) -> YamlMap:
    """Return the object of a part: these entries, then its fields without those that have their implied value.

    `unit` is that of its numbers, where they are the noise on a value; None for the units that the class describes.
    """
    stated: tuple[str, ...] = getattr(part, "stated", ())
    return pen.element(part, **entries, **written_fields(pen, part, motion, unit, stated=stated))


def written_fields(
    pen: Pen,
    part: Part,
    motion: Motion = Motion.OTHER,
    unit: FieldUnit | None = None,
    /,
    *,
    stated: tuple[str, ...] = (),
) -> dict[str, YamlNode | None]:
    """Return the fields of a part that its class describes; those that are `stated` may have their implied value."""
    written: dict[str, YamlNode | None] = {}
    for name, spec in field_specs(type(part)).items():
        value = getattr(part, name)
        if not isinstance(spec, _WRITTEN):
            continue
        is_implied = not isinstance(spec, Noise) and value == spec.implied and name not in stated
        if value is not None and (pen.full or not is_implied):
            dimension = (unit or spec.unit).dimension(motion) if isinstance(spec, Number) else None
            written[name] = _written(pen, value, spec, dimension)
    return written


_WRITTEN = (Number, Noise, Text, Flag, Choice)


def _written(pen: Pen, value: object, spec: Spec, dimension: Dimension | None) -> YamlNode | None:
    match spec, value:
        case Number(), int() | float():
            return pen.quantity(value, dimension)
        case ((Text() | Choice()), str()):
            return pen.text(value)
        case Flag(), _:
            return pen.flag(bool(value))
        case Noise(), Element():
            return written_element(pen, value, Motion.UNKNOWN, spec.unit)
    raise TypeError(f"{type(value).__name__} is not a value of {type(spec).__name__}")
