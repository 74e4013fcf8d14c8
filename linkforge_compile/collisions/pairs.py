"""Pairs of links: which are adjacent, and for which a sample can tell whether they collide."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from enum import StrEnum
from itertools import combinations
from typing import TypeAlias

from linkforge_compile.collisions.scene import Scene

Pair: TypeAlias = tuple[int, int]
"""The places of two bodies in their scene, in ascending order."""

Names: TypeAlias = tuple[str, str]
"""The links of a pair; the first one is that under which the pair is written."""


class Reason(StrEnum):
    """Why a pair of links needs no check, as MoveIt's Setup Assistant writes it."""

    ADJACENT = "Adjacent"
    """A joint connects them, or joints and links without collisions."""
    DEFAULT = "Default"
    """They collide in the default pose."""
    ALWAYS = "Always"
    """They collide in nearly all samples."""
    NEVER = "Never"
    """They collide in no sample."""


def comparable_pairs(scene: Scene) -> Iterator[Pair]:
    """Yield the pairs of bodies with shapes that no planar or floating joint separates."""
    with_shapes = [place for place, body in enumerate(scene) if body.shapes]
    for pair in combinations(with_shapes, 2):
        if scene[pair[0]].island == scene[pair[1]].island:
            yield pair


def adjacent_pairs(scene: Scene) -> set[Pair]:
    """Return the pairs between which there are only joints and bodies without shapes."""
    # Bodies around one group of connected bodies without shapes are adjacent to each other.
    group_of: dict[int, int] = {}
    around: defaultdict[int, set[int]] = defaultdict(set)
    adjacent: set[Pair] = set()
    for place, body in enumerate(scene):
        parent = None if place == body.island else body.parent
        if body.shapes:
            if parent in group_of:
                around[group_of[parent]].add(place)
            elif parent is not None:
                adjacent.add((parent, place))
        else:
            group_of[place] = group_of.get(parent, place) if parent is not None else place
            if parent is not None and parent not in group_of:
                around[place].add(parent)
    for neighbors in around.values():
        adjacent.update(combinations(sorted(neighbors), 2))
    return adjacent
