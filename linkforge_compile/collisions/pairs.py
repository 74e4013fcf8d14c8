"""Pairs of links: which are adjacent, which a sample can tell apart, and which a module declares by itself."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from enum import StrEnum
from itertools import combinations
from typing import TypeAlias

from linkforge_compile.collisions.scene import Scene
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair

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


def is_own(pair: CollisionPair) -> bool:
    """Whether a pair is declared in the compiled file or its includes, and not by a module."""
    return pair.source is None or not pair.source.modules


class KnownModules:
    """The modules of a robot that declare pairs."""

    def __init__(self, robot: Robot) -> None:
        known = {pair.source.modules for pair in robot.semantic.disabled_collisions if pair.source and not is_own(pair)}
        self._modules: dict[str, set[tuple[str, ...]]] = {}
        for link in robot.links:
            own = link.source.modules if link.source else ()
            self._modules[link.name] = {module for module in known if own[: len(module)] == module}

    def hold(self, one: str, other: str) -> bool:
        """Whether two links are in one module that declares pairs, or in modules that it uses."""
        return bool(self._modules[one] & self._modules[other])
