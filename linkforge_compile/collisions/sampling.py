"""Sample positions of the joints, and give each pair of links its reason."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import islice
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.collisions.blocks import Block, Found, Search, blocks_of, find_in_blocks, find_in_processes
from linkforge_compile.collisions.pairs import Pair, Reason, adjacent_pairs

if TYPE_CHECKING:
    from linkforge_compile.collisions.collider import Collider
    from linkforge_compile.collisions.scene import Scene

COUNTED_BLOCKS = 4
"""The first blocks count the samples in which each pair collides; later ones find those that never do."""

ALWAYS_SHARE = 0.95
"""Pairs that collide in this share of the counted samples are always in collision, as in MoveIt."""

WORTH_PROCESSES = 3.0
"""Starting processes takes about a second each, so less work is done in this one [s]."""

Progress: TypeAlias = Callable[[int], None]
"""Called with the number of samples that are done."""


class SamplingSettings(NamedTuple):
    """How many positions to sample, the seed of their generator, and how many processes to use."""

    samples: int = 10_000
    seed: int = 0
    jobs: int = 1


class Finding(NamedTuple):
    """Why a pair needs no check, and the share of the counted samples in which it collides; None if not sampled."""

    reason: Reason
    share: float | None = None


def find_reasons(
    scene: Scene, pairs: Collection[Pair], settings: SamplingSettings, progress: Progress
) -> dict[Pair, Finding]:
    """Return why pairs need no check; those that collide in some samples, but not in all, are not returned.

    As in MoveIt's Setup Assistant, the first of the reasons that holds is taken: adjacent, in collision in the
    default pose, always or never in collision.
    """
    from linkforge_compile.collisions.collider import Collider

    adjacent = adjacent_pairs(scene)
    others = [pair for pair in pairs if pair not in adjacent]
    collider = Collider(scene, others)
    counted = list(islice(blocks_of(settings.samples), COUNTED_BLOCKS))
    done = sum(block.samples for block in counted)
    begin = monotonic()
    shares = _shares(collider, others, counted, settings.seed, progress)
    seconds = (monotonic() - begin) / done * (settings.samples - done)
    found = {pair: Finding(Reason.ADJACENT) for pair in pairs if pair in adjacent} | _often(collider, shares)
    free = [pair for pair, share in shares.items() if not share and pair not in found]
    search = Search(free, settings.samples, settings.seed, COUNTED_BLOCKS)
    searched: Iterable[Found] = ()
    if free and settings.jobs > 1 and seconds > WORTH_PROCESSES:
        searched = find_in_processes(scene, search, settings.jobs)
    elif free:
        searched = find_in_blocks(collider, search)
    colliding: set[Pair] = set()
    for block, seen in searched:
        colliding |= seen
        done += block.samples
        progress(done)
    return found | {pair: Finding(Reason.NEVER, 0.0) for pair in free if pair not in colliding}


def _often(collider: Collider, shares: Mapping[Pair, float]) -> dict[Pair, Finding]:
    """Return the pairs that collide in the default pose or in nearly all samples."""
    collider.select(shares.keys())
    by_default = collider.colliding(collider.default_positions())
    found = {pair: Finding(Reason.ALWAYS, share) for pair, share in shares.items() if share >= ALWAYS_SHARE}
    return found | {pair: Finding(Reason.DEFAULT, shares[pair]) for pair in by_default}


def _shares(
    collider: Collider, pairs: Collection[Pair], blocks: Collection[Block], seed: int, progress: Progress
) -> dict[Pair, float]:
    """Return in which share of the samples of blocks each pair collides."""
    import numpy as np

    collider.select(frozenset(pairs))
    counts, done = Counter[Pair](), 0
    for block in blocks:
        generator = np.random.default_rng((seed, block.number))
        for _ in range(block.samples):
            counts.update(collider.colliding(collider.random_positions(generator)))
        done += block.samples
        progress(done)
    return {pair: counts[pair] / done for pair in pairs}
