"""Sample positions of the joints in blocks, in several processes, and give each pair of links its reason."""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from itertools import islice
from multiprocessing import get_context
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.collisions.pairs import Pair, Reason, adjacent_pairs

if TYPE_CHECKING:
    from linkforge_compile.collisions.collider import Collider
    from linkforge_compile.collisions.scene import Scene

BLOCK = 50
"""Samples of a block, each with a generator of its own, so that the number of processes changes no result."""

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
    found = {pair: Finding(Reason.ADJACENT) for pair in pairs if pair in adjacent}
    others = [pair for pair in pairs if pair not in adjacent]
    collider = Collider(scene, others)
    by_default = collider.colliding(collider.default_positions())
    blocks = list(_blocks(settings.samples))
    begin = monotonic()
    shares = _shares(collider, others, blocks[:COUNTED_BLOCKS], settings.seed, progress)
    seconds = (monotonic() - begin) / COUNTED_BLOCKS * len(blocks)
    found |= {pair: Finding(Reason.DEFAULT, shares[pair]) for pair in by_default}
    always = (pair for pair, share in shares.items() if share >= ALWAYS_SHARE and pair not in by_default)
    found |= {pair: Finding(Reason.ALWAYS, shares[pair]) for pair in always}
    free = [pair for pair in others if not shares[pair] and pair not in by_default]
    rest = blocks[COUNTED_BLOCKS:] if free else []
    if settings.jobs > 1 and seconds > WORTH_PROCESSES and rest:
        searched = _find_in_processes(scene, free, rest, settings)
    else:
        searched = ((block, _find(collider, free, block, settings.seed)) for block in rest)
    colliding: set[Pair] = set()
    done = sum(block.samples for block in blocks[:COUNTED_BLOCKS])
    for block, seen in searched:
        colliding |= seen
        done += block.samples
        progress(done)
    return found | {pair: Finding(Reason.NEVER, 0.0) for pair in free if pair not in colliding}


class Block(NamedTuple):
    """The number of a block and of its samples."""

    number: int
    samples: int


def _blocks(samples: int) -> Iterator[Block]:
    for number, start in enumerate(range(0, samples, BLOCK)):
        yield Block(number, min(BLOCK, samples - start))


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


def _find(collider: Collider, pairs: Collection[Pair], block: Block, seed: int) -> set[Pair]:
    """Return the pairs that collide in a sample of a block; each is checked until it does."""
    import numpy as np

    collider.select(frozenset(pairs))
    generator = np.random.default_rng((seed, block.number))
    seen: set[Pair] = set()
    for _ in range(block.samples):
        colliding = collider.colliding(collider.random_positions(generator))
        collider.drop(colliding)
        seen |= colliding
    return seen


def _find_in_processes(
    scene: Scene, pairs: Sequence[Pair], blocks: Sequence[Block], settings: SamplingSettings
) -> Iterator[tuple[Block, set[Pair]]]:
    waiting = iter(blocks)
    # A new process, and not a fork: Pinocchio's threads would not be in the fork.
    pool = ProcessPoolExecutor(settings.jobs, get_context("spawn"), _Worker.start, (scene, pairs, settings.seed))
    try:
        running = {pool.submit(_Worker.find, block): block for block in islice(waiting, 2 * settings.jobs)}
        while running:
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                yield running.pop(future), future.result()
                running |= {pool.submit(_Worker.find, block): block for block in islice(waiting, 1)}
    finally:
        pool.shutdown(cancel_futures=True)


class _Worker:
    """The collider of a process, made once for all of its blocks."""

    collider: Collider
    pairs: Sequence[Pair]
    seed: int

    @classmethod
    def start(cls, scene: Scene, pairs: Sequence[Pair], seed: int) -> None:
        from linkforge_compile.collisions.collider import Collider

        # Ctrl-C goes to all processes of a terminal; the first one ends the others.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        cls.collider, cls.pairs, cls.seed = Collider(scene, pairs), pairs, seed

    @classmethod
    def find(cls, block: Block) -> set[Pair]:
        return _find(cls.collider, cls.pairs, block, cls.seed)
