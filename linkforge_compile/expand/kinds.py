"""The types of parameters: which values each takes, in what words, and which constraints mean something for it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from linkforge_compile.expressions import Value
from linkforge_compile.expressions.types import as_text, dimension_name
from linkforge_compile.units import Dimension, Quantity, units_of


@dataclass(frozen=True)
class Kind:
    """A type: its words in "takes …", and `take`, which gives a value of it or None for one that does not fit."""

    name: str
    words: str
    take: Callable[[Value], Value]
    constraints: frozenset[str] = frozenset({"enum"})

    @property
    def is_text(self) -> bool:
        """Whether a plain scalar is taken as it was written: `1.10` stays so, `3 kg` is no mass."""
        return self.take is as_text

    @property
    def is_structured(self) -> bool:
        return self.name in ("vector", "list", "map")


def kind_of(value: Value) -> Kind:
    """Return the type that follows from a default."""
    match value:
        case bool():
            return KINDS["boolean"]
        case int() | float():
            return KINDS["number"]
        case Quantity():
            return KINDS[value.dimension]
        case tuple():
            return KINDS["list" if _vector(value) is None else "vector"]
        case Mapping():
            return KINDS["map"]
    return KINDS["string"]


def _number(value: Value) -> Value:
    """A finite number; what is none cannot be compared with a minimum or a maximum."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return value if math.isfinite(value) else None


def _integer(value: Value) -> Value:
    """A whole number; 3.0 is one, as in JSON Schema."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    return None if isinstance(value, bool) or not isinstance(value, int) else value


def _quantity(dimension: Dimension, value: Value) -> Value:
    """A quantity of the dimension; a bare number is one in SI units."""
    if isinstance(value, Quantity):
        return value if value.dimension is dimension and math.isfinite(value.value) else None
    number = _number(value)
    return Quantity(float(number), dimension) if isinstance(number, int | float) else None


def _vector(value: Value) -> Value:
    if not isinstance(value, tuple) or len(value) != 3:
        return None
    sizes = [item.value if isinstance(item, Quantity) else item for item in value]
    return value if all(_number(size) is not None for size in sizes) else None


def _boolean(value: Value) -> Value:
    return value if isinstance(value, bool) else None


def _list(value: Value) -> Value:
    return value if isinstance(value, tuple) else None


def _map(value: Value) -> Value:
    return value if isinstance(value, Mapping) else None


def _dimension_words(dimension: Dimension) -> str:
    *others, last = units_of(dimension)[:3]
    return f"{dimension_name(dimension)} in {', '.join(others)} or {last}"


_BOUNDED = frozenset({"minimum", "maximum", "enum"})
_MATCHED = frozenset({"pattern", "enum"})

_TABLE = (
    Kind("number", "a bare number", _number, _BOUNDED),
    Kind("integer", "a whole number", _integer, _BOUNDED),
    Kind("boolean", "true or false", _boolean),
    Kind("string", "text", as_text, _MATCHED),
    Kind("file", "a path", as_text, _MATCHED),
    Kind("vector", "three numbers", _vector),
    Kind("list", "a list", _list),
    Kind("map", "a map", _map),
    *(Kind(dimension, _dimension_words(dimension), partial(_quantity, dimension), _BOUNDED) for dimension in Dimension),
)

KINDS = {kind.name: kind for kind in _TABLE}
"""Every type by the word that declares it."""
