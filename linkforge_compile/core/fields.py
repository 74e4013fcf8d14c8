"""What a field of a model class says about itself, for the walkers that read, write and compare its values.

A field is annotated with a spec: `effort: Annotated[float, Number(EFFORT, NOT_NEGATIVE)]`. Type checkers, constructors
and `typing.get_type_hints` see the plain type; a walker asks `field_specs` for the specs.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from enum import StrEnum
from functools import cache
from types import NoneType
from typing import Any, NamedTuple, TypeAlias, get_args, get_type_hints

from linkforge_compile.core.constants import EPSILON
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.rules import not_finite, require_finite
from linkforge_compile.units import BARE, FieldUnit, Motion

_LARGEST, _SMALLEST = sys.float_info.max, math.ulp(0.0)


@dataclass(frozen=True, slots=True)
class Bound:
    """A range that a number must keep to, and its words in "must be …"; all from `least` to `most` keep to it."""

    words: str
    holds: Callable[[float], bool]
    least: float = -_LARGEST
    most: float = _LARGEST


ABOVE_ZERO = Bound("above 0", lambda value: value > 0, least=_SMALLEST)
NOT_NEGATIVE = Bound("0 or above", lambda value: value >= 0, least=0.0)
NOT_ZERO = Bound("other than 0", lambda value: value != 0, least=_SMALLEST)
BEYOND_EPSILON = Bound("further than 1e-9 from 0", lambda value: abs(value) >= EPSILON, least=EPSILON)
UP_TO_HALF_A_TURN = Bound(
    "above 0 and at most pi", lambda value: 0 < value <= math.pi * (1 + 1e-9), least=_SMALLEST, most=math.pi
)
ZERO_TO_ONE = Bound("from 0 to 1", lambda value: 0 <= value <= 1, least=0.0, most=1.0)


class Number(NamedTuple):
    """A number: its unit and range, and what takes its place.

    `example` is what to write where the language requires the number, by motion if that matters; empty where it does
    not. `stand_in` takes the place of a faulty one, so that its element stays for the checks; None for `implied`.
    `implied` is what the absence of the number means: the default of its class, which `field_specs` fills in, unless
    it is required. `may_be_none` is filled in from the annotation. A length that `may_be_far` is not taken for
    millimetres.
    """

    unit: FieldUnit = BARE
    bound: Bound | None = None
    example: str | Mapping[Motion, str] = ""
    stand_in: float | None = None
    implied: float | None = None
    is_whole: bool = False
    may_be_far: bool = False
    may_be_none: bool = False
    is_required_in_urdf: bool = False

    def example_for(self, motion: Motion) -> str:
        """Return what to write where the number is required; empty where it is not."""
        return self.example if isinstance(self.example, str) else self.example.get(motion, "")


class Text(NamedTuple):
    """A text; `example` and `implied` are as for Number."""

    example: str = ""
    implied: str | None = None


class Flag(NamedTuple):
    """True or false; `implied` is as for Number."""

    implied: bool | None = None


class Choice(NamedTuple):
    """One word of an enumeration; `implied` is as for Number."""

    words: type[StrEnum]
    implied: str | None = None


class Noise(NamedTuple):
    """The noise on a value of a unit."""

    unit: FieldUnit = BARE


Spec: TypeAlias = Number | Text | Flag | Choice | Noise


def field_specs(kind: type) -> Mapping[str, Spec]:
    """Return what the fields of a model class say about themselves, in their order, those that say something."""
    return _field_specs(kind)


@cache
def _field_specs(kind: type) -> Mapping[str, Spec]:
    hints = get_type_hints(kind, include_extras=True)
    specs = {name: spec for name, hint in hints.items() if (spec := _spec_in(hint)) is not None}
    return {name: _with_default(spec, kind, name) for name, spec in specs.items()}


def _spec_in(hint: Any) -> Spec | None:
    """Return the spec in an annotation, None for one without; a number knows whether it may be None."""
    spec = next((spec for spec in getattr(hint, "__metadata__", ()) if isinstance(spec, Spec)), None)
    return spec._replace(may_be_none=NoneType in get_args(hint.__origin__)) if isinstance(spec, Number) else spec


def _with_default(spec: Spec, kind: type[Any], name: str) -> Spec:
    default = next((one.default for one in fields(kind) if one.name == name), MISSING)
    match spec:
        case Number(example="") | Text(example="") | Flag() | Choice() if default is not MISSING:
            return spec._replace(implied=default)
    return spec


def number_fields(kind: type) -> Mapping[str, Number]:
    """Return the specs of the numbers of a model class, in the order of its fields."""
    return _number_fields(kind)


@cache
def _number_fields(kind: type) -> Mapping[str, Number]:
    return {name: spec for name, spec in _field_specs(kind).items() if isinstance(spec, Number)}


def written_numbers(part: object) -> Iterator[tuple[str, float]]:
    """Yield the numbers of a part that become attributes, by name.

    A class with a field `stated` leaves out an implied value, unless `stated` names it: the author wrote it.
    """
    stated: tuple[str, ...] | None = getattr(part, "stated", None)
    for name, spec in number_fields(type(part)).items():
        value: float | None = getattr(part, name)
        if value is not None and (stated is None or value != spec.implied or name in stated):
            yield name, value


def check_numbers(part: object) -> None:
    """Refuse a number of a part outside of its bound, NaN, infinity, and None where the field has no place for it.

    Raises:
        RobotValidationError: OUT_OF_RANGE.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """
    kind = type(part)
    specs = number_fields(kind)
    for name, spec in specs.items():
        value: float | None = getattr(part, name)
        if value is None:
            if not spec.may_be_none:
                raise not_finite(value, name, f"{kind.__name__}.{name}", (name,))
        elif spec.bound and not (spec.bound.holds(value) or math.isnan(value)):
            unit = spec.unit.text(Motion.OTHER)
            raise RobotValidationError(
                ValidationErrorCode.OUT_OF_RANGE,
                f"{name} must be {spec.bound.words}{unit and f' [{unit}]'}, found {value}",
                target=f"{kind.__name__}.{name}",
                value=value,
                field=(name,),
            )
    require_finite(part, *specs)
