"""Values in a launch file, as what launch evaluates: texts, numbers, flags, vectors and substitutions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

Words: TypeAlias = str | Substitution | Sequence[str | Substitution]
"""A text, a substitution that gives one, or the parts of a text."""

Given: TypeAlias = Mapping[str, bool | int | float | Words | Sequence[float | str | Substitution]]
"""The values that a launch file gives parameters, by name."""


def substitutions_of(name: str, value: object) -> list[Substitution]:
    """Return what gives the text of a value; TypeError, which names the parameter, for one that no launch file has."""
    if isinstance(value, bool):
        value = "true" if value else "false"
    elif isinstance(value, int | float):
        value = _number(value)
    elif isinstance(value, list | tuple) and any(isinstance(item, int | float) for item in value):
        value = _vector(value)
    try:
        if isinstance(value, Mapping):
            raise TypeError  # launch would take its keys
        normal: list[Substitution] = normalize_to_list_of_substitutions(value)
    except TypeError:
        raise TypeError(
            f"'{name}' takes text, a number, true or false, a list of numbers, or substitutions; found {value!r}"
        ) from None
    return normal


def _number(value: float) -> str:
    # numpy's are floats that show as another thing.
    return repr(int(value)) if isinstance(value, int) else repr(float(value))


def _vector(items: Sequence[object]) -> list[object]:
    """Return the parts of the text `[1, 2, 3]`, in which an item may be a substitution."""
    parts: list[object] = []
    for item in items:
        parts += [", " if parts else "[", _number(item) if isinstance(item, int | float) else item]
    return [*parts, "]"]
