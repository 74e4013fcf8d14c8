"""In what order the visuals and collisions of a link stand in its document, and how MuJoCo colors them by it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, chain, zip_longest
from typing import TypeVar

Color = TypeVar("Color")

VISUAL, COLLISION = "visual", "collision"
KINDS = (VISUAL, COLLISION)

PAIRS = "pairs"
"""The word for one of each kind in turn, beginning with the kind that stands first; what is left of one comes last."""


def apart(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds of these shapes with all of the first one before the others: what goes without saying."""
    return tuple(sorted(kinds, key=lambda kind: kind != kinds[0]))


def in_pairs(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds of these shapes as PAIRS has them."""
    first = [kind for kind in kinds if kind == kinds[0]]
    others = [kind for kind in kinds if kind != kinds[0]]
    return tuple(kind for kind in chain.from_iterable(zip_longest(first, others)) if kind)


def as_said(kinds: Sequence[str]) -> str | Sequence[str] | None:
    """Return what says this order beside the kind that stands first: PAIRS or a list; None for nothing."""
    if tuple(kinds) == apart(kinds):
        return None
    return PAIRS if tuple(kinds) == in_pairs(kinds) else kinds


def shown_colors(own: Iterable[Color | None]) -> Iterator[Color | None]:
    """Yield the color in which MuJoCo shows each shape of a link, given the one that each says, in their order.

    Who says none, as all collisions do, has that of the shape before it; None before the first color.
    """
    return accumulate(own, lambda before, said: before if said is None else said)
