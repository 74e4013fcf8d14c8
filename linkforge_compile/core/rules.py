"""Checks for constructors: empty names, names with invalid characters, numbers that are not finite."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from enum import StrEnum
from typing import Protocol

from linkforge_compile.core.exceptions import FieldPath, RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.naming import is_valid_name

_LARGEST = sys.float_info.max


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str: ...


def require_name(name: str, what: str, target: str, field: FieldPath = ("name",)) -> None:
    """Refuse an empty name.

    Raises:
        RobotValidationError: NAME_EMPTY.

    """
    if not name:
        raise RobotValidationError(
            ValidationErrorCode.NAME_EMPTY, f"{what} cannot be empty", target=target, value=name, field=field
        )


def require_not_blank(name: str, what: str, target: str, field: FieldPath = ("name",)) -> None:
    """Refuse a name without a visible character.

    Raises:
        RobotValidationError: NAME_EMPTY.

    """
    if not name.strip():
        raise RobotValidationError(
            ValidationErrorCode.NAME_EMPTY, f"{what} cannot be empty or blank", target=target, field=field
        )


def require_valid_characters(name: str, what: str, target: str) -> None:
    """Refuse characters that URDF readers refuse in names.

    Raises:
        RobotValidationError: INVALID_NAME.

    """
    if not is_valid_name(name):
        raise RobotValidationError(
            ValidationErrorCode.INVALID_NAME,
            f"{what} may hold letters, digits and '_', '-', '.', '/', found '{name}'",
            target=target,
            value=name,
            field=("name",),
        )


def require_choice(found: str, words: type[StrEnum], what: str, target: str, field: str) -> None:
    """Refuse a text that is none of an enumeration's words.

    Raises:
        RobotValidationError: INVALID_VALUE.

    """
    if found not in tuple(words):
        raise RobotValidationError(
            ValidationErrorCode.INVALID_VALUE,
            f"{what} must be one of {', '.join(words)}, found '{found}'",
            target=target,
            value=found,
            field=(field,),
        )


def require_unique_names(named: Iterable[Named], owner: str, target: str, field: str) -> None:
    """Refuse two items of one name in one collection; the path of the field ends in that name.

    Raises:
        RobotValidationError: DUPLICATE_NAME.

    """
    seen: set[str] = set()
    for thing in named:
        if thing.name in seen:
            raise RobotValidationError(
                ValidationErrorCode.DUPLICATE_NAME,
                f"{owner} names '{thing.name}' twice in its {field}",
                target=target,
                value=thing.name,
                field=(field, thing.name),
            )
        seen.add(thing.name)


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
    return RobotMathError(
        ValidationErrorCode.INVALID_VALUE,
        f"{what} must be a finite number, found {value}",
        target=target,
        value=value,
        field=field,
    )
