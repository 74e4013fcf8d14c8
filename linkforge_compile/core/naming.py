"""Which names are valid, and how a prefix is put before them."""

from __future__ import annotations

import re
import unicodedata
from typing import overload

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
