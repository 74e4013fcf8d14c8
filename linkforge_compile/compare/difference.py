"""One difference between two robots."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""A value that JSON can hold; numbers are in SI units."""


class Kind(StrEnum):
    """How a part or value of the robot before differs in the robot after."""

    ADDED = "added"
    REMOVED = "removed"
    RENAMED = "renamed"
    MOVED = "moved"
    CHANGED = "changed"


@dataclass(frozen=True)
class Difference:
    """A difference at one place.

    `path` is the path that `explain` accepts, such as `("joints", "elbow", "limits", "upper")`, with the names of the
    robot after, or of the robot before for what was removed. `before` and `after` are the exact values, None where
    there is none; they are names for a renamed part, and parent links for a moved one. `text` describes the
    difference: rounded, with units and the amount of the change.
    """

    kind: Kind
    path: tuple[str, ...]
    before: Plain
    after: Plain
    text: str
