"""Specs of the fields of model classes, for walkers that read, write, compare and prefix values.

A field is annotated with a spec: `effort: Annotated[float, Number(EFFORT, NOT_NEGATIVE)]`. Type checkers, constructors
and `typing.get_type_hints` see the plain type; a walker asks `field_specs` for the specs of a class. A field without
a spec is not part of the language: where an element was written, and how.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, MISSING, dataclass, field, fields, replace
from enum import StrEnum
from functools import cache
from types import NoneType
from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

from linkforge_compile.core.constants import EPSILON
from linkforge_compile.core.exceptions import FieldPath, RobotMathError, RobotValidationError
from linkforge_compile.units import BARE, FieldUnit, Motion


@dataclass(frozen=True)
class Bound:
    """The range of a number, of its distance from 0 if `is_of_magnitude`; `words` follow "must be"."""

    words: str
    least: float = -math.inf
    most: float = math.inf
    is_of_magnitude: bool = False

    def holds(self, value: float) -> bool:
        """Whether a number is in the range; NaN is in none."""
        return self.least <= (abs(value) if self.is_of_magnitude else value) <= self.most


_SMALLEST = math.ulp(0.0)

ABOVE_ZERO = Bound("above 0", least=_SMALLEST)
NOT_NEGATIVE = Bound("at least 0", least=0.0)
NOT_ZERO = Bound("other than 0", least=_SMALLEST, is_of_magnitude=True)
BEYOND_EPSILON = Bound("further than 1e-9 from 0", least=EPSILON, is_of_magnitude=True)
UP_TO_HALF_A_TURN = Bound("above 0 and at most pi", least=_SMALLEST, most=math.pi * (1 + 1e-9))
ZERO_TO_ONE = Bound("from 0 to 1", least=0.0, most=1.0)


@dataclass(frozen=True, kw_only=True)
class Spec:
    """The spelling of a field, its default and whether it is required.

    `key` is its key in the language: the name of the field where none is given, empty where the value is itself a key
    (of the map that holds the element) or is spelled by several keys.
    `xml` is an XPath from the element in XML, `@lower` or `mass/@value`: where none is given, the attribute or child
    element of the field's name; empty where the value has no place of its own.
    `example` is what to write where the language requires the field, by motion if that matters; empty where it does
    not require it. `is_required_in_urdf` is whether URDF readers refuse the element without it.

    `field_specs` fills in the rest. `implied` is the value of a field that is not written: the default of its class,
    None for a required one. `may_be_none` and `container` (None, Sequence or Mapping) follow from the annotation.
    """

    key: str | None = None
    xml: str | None = None
    example: str | Mapping[Motion, str] = ""
    is_required_in_urdf: bool = field(default=False, kw_only=True)
    implied: Any = None  # a value of the field's own type
    may_be_none: bool = False
    container: type | None = None

    def example_for(self, motion: Motion) -> str:
        """Return what to write where the field is required; empty where it is not."""
        return self.example if isinstance(self.example, str) else self.example.get(motion, "")


@dataclass(frozen=True)
class Number(Spec):
    """A number, with its unit and range.

    `stand_in` replaces a faulty one, so that its element can be checked further; None for `implied`. A length
    that `may_be_far` is not taken for millimetres.
    """

    unit: FieldUnit = BARE
    bound: Bound | None = None
    _: KW_ONLY
    stand_in: float | None = None
    is_whole: bool = False
    may_be_far: bool = False


@dataclass(frozen=True)
class Vector(Spec):
    """Three numbers along x, y, z, each with this unit and range."""

    unit: FieldUnit = BARE
    bound: Bound | None = None


@dataclass(frozen=True)
class Axis(Vector):
    """A direction of length 1; the language has words for those along an axis of the frame."""


@dataclass(frozen=True)
class Text(Spec):
    """A text, or a sequence of them."""


@dataclass(frozen=True)
class Name(Text):
    """The element's own name, which gets the prefix; in the language mostly the key of the map around it."""

    key: str | None = ""


@dataclass(frozen=True)
class Reference(Text):
    """The name of another element, with the prefix; a sequence of names, or a mapping by names.

    `to` is the kind of what is named: link, joint, part (a link or joint), collision, group, sensor, frame or topic.
    Absolute topics get no prefix.
    """

    to: str = ""


@dataclass(frozen=True)
class Flag(Spec):
    """True or false."""


@dataclass(frozen=True)
class Choice(Spec):
    """One word of an enumeration."""

    words: type[StrEnum]


@dataclass(frozen=True)
class Child(Spec):
    """An element of its own class, or one of several classes: `kinds`, which `field_specs` fills in."""

    _: KW_ONLY
    kinds: tuple[type, ...] = ()


@dataclass(frozen=True)
class Pose(Child):
    """A Transform, which moves nothing where it is not given."""


@dataclass(frozen=True)
class Colour(Child):
    """A Color: three or four numbers from 0 to 1 in one."""


@dataclass(frozen=True)
class Noise(Child):
    """The noise on a value of a unit."""

    unit: FieldUnit = BARE


@dataclass(frozen=True)
class Children(Child):
    """A sequence of elements: in the language a map by their names where they have a Name, else a list."""


@dataclass(frozen=True)
class Parameters(Spec):
    """A mapping whose names and texts the format does not know, such as what a plugin reads."""


@dataclass(frozen=True)
class Data(Spec):
    """A mapping of values whose types are kept: numbers, booleans, texts, and lists and mappings of them."""


_TUPLES = (Vector, Colour)


class _Described(NamedTuple):
    specs: Mapping[str, Spec]
    numbers: Mapping[str, Number]
    containers: Mapping[str, type]
    tuples: Mapping[str, type]


def field_specs(kind: type) -> Mapping[str, Spec]:
    """Return the specs of the fields of a model class, in their order; fields without one are omitted."""
    return _describe(kind).specs


def key_fields(kind: type) -> tuple[str, ...]:
    """Return the fields that are keys of the maps around an element in the language, the outer one first."""
    specs = field_specs(kind)
    keys = [name for name, spec in specs.items() if isinstance(spec, Text) and not (spec.key or spec.container)]
    return tuple(sorted(keys, key=lambda name: isinstance(specs[name], Name)))  # a name comes after what it is within


def number_fields(kind: type) -> Mapping[str, Number]:
    """Return the specs of the numbers of a model class, in the order of its fields."""
    return _describe(kind).numbers


def container_fields(kind: type) -> Mapping[str, type]:
    """Return Sequence or Mapping for each field of a model class that holds one, be it without a spec."""
    return _describe(kind).containers


def tuple_fields(kind: type) -> Mapping[str, type]:
    """Return the class, Vector3 or Color, for each field of a model class that holds a few numbers in one."""
    return _describe(kind).tuples


@cache  # not on the public functions: for mypy, a class whose instances define `__hash__` is not hashable itself
def _describe(kind: type) -> _Described:
    defaults = {field.name: field.default for field in fields(kind) if field.default is not MISSING}
    specs: dict[str, Spec] = {}
    hints = get_type_hints(kind, include_extras=True)
    for name, hint in hints.items():
        spec = next((given for given in getattr(hint, "__metadata__", ()) if isinstance(given, Spec)), None)
        if spec is not None:
            specs[name] = _complete(spec, name, hint.__origin__, defaults.get(name))
    numbers = {name: spec for name, spec in specs.items() if isinstance(spec, Number)}
    containers = {name: container for name, hint in hints.items() if (container := _container(hint))}
    tuples = {name: _classes(hints[name].__origin__)[0] for name, spec in specs.items() if isinstance(spec, _TUPLES)}
    return _Described(specs, numbers, containers, tuples)


def _container(hint: Any) -> type | None:
    origin = get_origin(hint.__origin__ if get_origin(hint) is Annotated else hint)
    return origin if origin in {Sequence, Mapping} else None


def _complete(spec: Spec, name: str, annotation: Any, default: object) -> Spec:
    """Fill in what follows from a field's name, type and default."""
    may_be_none = NoneType in get_args(annotation)
    spec = replace(
        spec,
        key=name if spec.key is None else spec.key,
        implied=None if spec.example else default,
        may_be_none=may_be_none,
        container=_container(annotation),
    )
    if not isinstance(spec, Child):
        return replace(spec, xml=f"@{name}" if spec.xml is None else spec.xml)
    kinds = spec.kinds or _classes(annotation)
    return replace(spec, kinds=kinds, xml=getattr(kinds[0], "TAG", name) if spec.xml is None else spec.xml)


def _classes(annotation: Any) -> tuple[type, ...]:
    """Return the classes of a union, or the only one; without None."""
    return tuple(kind for kind in get_args(annotation) or (annotation,) if kind is not NoneType)


def tags_with_text(kind: type) -> dict[str, str]:
    """Return the tags of the fields of a class that become elements with a text, by field, in order."""
    spellings = ((name, spec.xml or "") for name, spec in field_specs(kind).items())
    return {name: xml.removesuffix("/text()") for name, xml in spellings if xml.endswith("/text()")}


def check_numbers(part: object) -> None:
    """Refuse numbers of a part that are out of range or not finite, and None where it is not allowed.

    Raises:
        RobotValidationError: OUT_OF_RANGE.
        RobotMathError: INVALID_VALUE for NaN or infinity, and for None.

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
            raise RobotValidationError.out_of_range(
                f"{name} must be {spec.bound.words}{unit and f' {unit}'}, found {value}",
                f"{kind.__name__}.{name}",
                value,
                name,
            )
    require_finite(part, *specs)


_LARGEST = sys.float_info.max


def require_choice(found: str, words: type[StrEnum], what: str, target: str, field: str) -> None:
    """Refuse a text that is none of an enumeration's words.

    Raises:
        RobotValidationError: INVALID_VALUE.

    """
    if found not in tuple(words):
        raise RobotValidationError.invalid(
            f"{what} must be one of {', '.join(words)}, found '{found}'", target, found, field
        )


def require_finite(part: object, *names: str) -> None:
    """Refuse NaN and infinity in the named fields; None passes.

    Raises:
        RobotMathError: INVALID_VALUE.

    """
    for name in names:
        value: float | None = getattr(part, name)
        if value.__class__ is float and -_LARGEST <= value <= _LARGEST:
            continue  # most numbers, without a call
        if value is not None and not is_finite(value):
            raise not_finite(value, name, f"{type(part).__name__}.{name}", (name,))


def is_finite(value: float) -> bool:
    """Return whether a number is finite as a double, which an integer beyond 1e308 is not."""
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def not_finite(value: float | None, what: str, target: str, field: FieldPath) -> RobotMathError:
    """Return the error for a number that is not finite."""
    return RobotMathError.invalid(f"{what} must be a finite number, found {value}", target, value, *field)
