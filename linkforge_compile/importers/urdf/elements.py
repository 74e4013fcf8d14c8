"""Elements whose fields are numbers: read from URDF as their class describes them."""

from __future__ import annotations

from collections.abc import Collection

from linkforge_compile.core.fields import Number, number_fields
from linkforge_compile.core.part import Element
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Motion


def read_element(reading: ElementReader, kind: type[Element], motion: Motion = Motion.OTHER) -> YamlMap:
    """Read an element whose fields are numbers; decline one without a number that readers of URDF require."""
    require_numbers(reading, kind)
    return reading.map(**read_numbers(reading, kind, motion))


def require_numbers(reading: ElementReader, kind: type[Element]) -> None:
    """Decline an element without a number that readers of URDF require."""
    required = [name for name, spec in number_fields(kind).items() if spec.is_required_in_urdf]
    if missing := [name for name in required if reading.element.get(name) is None]:
        raise reading.cannot_represent(f"it has no {' and no '.join(map(repr, missing))}")


def read_numbers(
    reading: ElementReader, kind: type[Element], motion: Motion = Motion.OTHER, *, without: Collection[str] = ()
) -> dict[str, YamlNode | None]:
    """Read the numbers of a model class, None for one that is not written or has its implied value."""
    specs = number_fields(kind).items()
    return {name: _read_number(reading, name, spec, motion) for name, spec in specs if name not in without}


def _read_number(reading: ElementReader, name: str, spec: Number, motion: Motion) -> YamlScalar | None:
    written = reading.element.get(name) or ""
    node = reading.number(name, spec.unit.dimension(motion), default=spec.implied)
    value = number_of(written)
    if spec.bound and value is not None and not spec.bound.holds(value):
        raise reading.cannot_represent(f"{name} must be {spec.bound.words}, found {written}")
    return node
