"""Elements whose fields are numbers: written as their class describes them."""

from __future__ import annotations

from linkforge_compile.core.fields import number_fields
from linkforge_compile.core.part import Element
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Motion
from linkforge_compile.writers.pen import Pen


def written_element(pen: Pen, part: Element, motion: Motion = Motion.OTHER, /, **entries: YamlNode | None) -> YamlMap:
    """Return the object of a part: these entries, then its numbers without those that have their implied value."""
    stated: tuple[str, ...] = getattr(part, "stated", ())
    numbers = {
        name: pen.number(
            getattr(part, name), spec.unit.dimension(motion), default=None if name in stated else spec.implied
        )
        for name, spec in number_fields(type(part)).items()
    }
    return pen.element(part, **entries, **numbers)
