"""One difference between two robots, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""What JSON can hold; numbers are in SI units."""


class Kind(StrEnum):
    """What happened to a thing on the way from the robot before to the one after."""

    ADDED = "added"
    REMOVED = "removed"
    RENAMED = "renamed"
    MOVED = "moved"
    CHANGED = "changed"


@dataclass(frozen=True)
class Difference:
    """What differs at one place.

    `path` is that of the language, with the names of the robot after (before, for what is gone), as `explain` takes
    it: `("joints", "elbow", "limits", "upper")`. `before` and `after` are whole and exact, None for what is not there;
    of what was renamed they are the names, of what was moved the links that it hangs on. `text` is for people: rounded,
    with units, and by how much.
    """

    kind: Kind
    path: tuple[str, ...]
    before: Plain
    after: Plain
    text: str
