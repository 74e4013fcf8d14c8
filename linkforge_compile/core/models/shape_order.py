"""The order of a link's visuals and collisions in a document, and how MuJoCo colors the shapes by it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, chain, zip_longest
from typing import TypeVar

Color = TypeVar("Color")

VISUAL, COLLISION = "visual", "collision"
KINDS = (VISUAL, COLLISION)

PAIRS = "pairs"
"""The word for alternating kinds, beginning with the kind of the first shape; shapes without a partner come last."""


def grouped(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds with all of the first one before the others, which is the default order."""
    return tuple(sorted(kinds, key=lambda kind: kind != kinds[0]))


def in_pairs(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds in the order that PAIRS means."""
    first = [kind for kind in kinds if kind == kinds[0]]
    others = [kind for kind in kinds if kind != kinds[0]]
    return tuple(kind for kind in chain.from_iterable(zip_longest(first, others)) if kind)


def shortest_setting(kinds: Sequence[str]) -> str | Sequence[str] | None:
    """Return the `shape_order` to write for these kinds: PAIRS or a list; None for the default order."""
    if tuple(kinds) == grouped(kinds):
        return None
    return PAIRS if tuple(kinds) == in_pairs(kinds) else kinds


def shown_colors(own: Iterable[Color | None]) -> Iterator[Color | None]:
    """Yield the color in which MuJoCo shows each shape of a link, given the shapes' own colors in document order.

    A shape without a color, such as any collision, has that of the shape before it; None before the first color.
    """
    return accumulate(own, lambda before, color: before if color is None else color)
