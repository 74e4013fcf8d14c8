"""Which names are valid, checks of names for constructors, and how a prefix is put before names."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Iterable
from itertools import chain, count
from typing import Protocol, overload

from linkforge_compile.core.exceptions import FieldPath, RobotValidationError, ValidationErrorCode

_PLAIN_NAME = re.compile(r"[\w./-]+")
_BESIDE_LETTERS = frozenset("_-./")


def is_valid_name(name: str, allow_hyphen: bool = True) -> bool:
    """Tell whether links, joints, transmissions and robots may have this name.

    Letters and digits of any script with the marks that belong to them, and `_ - . /`, in any order. Space,
    control characters and all other punctuation are refused. ROS tools refuse more than URDF readers do (`.`, `/`, a
    leading digit); a check warns of that.
    """
    if not allow_hyphen and "-" in name:
        return False
    if name.isascii() and name.isidentifier():
        return True  # most names; the pattern below takes five times as long
    if _PLAIN_NAME.fullmatch(name):
        return True
    # `\w` leaves out combining marks, without which Hindi, Thai or a decomposed é cannot be written.
    return bool(name) and all(
        character.isalnum() or character in _BESIDE_LETTERS or unicodedata.category(character).startswith("M")
        for character in name
    )


@overload
def prefixed(prefix: str, name: str) -> str: ...
@overload
def prefixed(prefix: str, name: str | None) -> str | None: ...
def prefixed(prefix: str, name: str | None) -> str | None:
    """Return the name with the prefix before it; None and an empty name stay."""
    return f"{prefix}{name}" if name else name


def prefixed_topic(prefix: str, topic: str | None) -> str | None:
    """Return a relative topic with the prefix before it.

    An absolute topic (`/camera`) and a private one (`~/camera`) do not depend on where they are used and are kept.
    """
    return topic if topic and topic[0] in "/~" else prefixed(prefix, topic)


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
            f"{what} may contain only letters, digits and '_', '-', '.', '/', found '{name}'",
            target=target,
            value=name,
            field=("name",),
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


def unique_name(name: str, taken: Container[str]) -> str:
    """Return a name, or with the lowest number from 2 after it that makes it one that is not taken."""
    numbered = (f"{name}_{number}" for number in count(2))
    return next(one for one in chain([name], numbered) if one not in taken)
