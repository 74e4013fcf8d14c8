"""Sample positions of the joints in blocks, in several processes, and give each pair of links its reason."""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
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
    others = [pair for pair in pairs if pair not in adjacent]
    collider = Collider(scene, others)
    blocks = _blocks(settings.samples)
    counted = list(islice(blocks, COUNTED_BLOCKS))
    done = sum(block.samples for block in counted)
    begin = monotonic()
    shares = _shares(collider, others, counted, settings.seed, progress)
    seconds = (monotonic() - begin) / done * (settings.samples - done)
    found = {pair: Finding(Reason.ADJACENT) for pair in pairs if pair in adjacent} | _often(collider, shares)
    free = [pair for pair, share in shares.items() if not share and pair not in found]
    searched: Iterable[tuple[Block, set[Pair]]] = ()
    if free and settings.jobs > 1 and seconds > WORTH_PROCESSES:
        searched = _find_in_processes(scene, free, blocks, settings)
    elif free:
        searched = ((block, _find(collider, free, block, settings.seed)) for block in blocks)
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
    scene: Scene, pairs: Sequence[Pair], blocks: Iterator[Block], settings: SamplingSettings
) -> Iterator[tuple[Block, set[Pair]]]:
    # A new process, and not a fork: Pinocchio's threads would not be in the fork.
    pool = ProcessPoolExecutor(settings.jobs, get_context("spawn"), _Worker.start, (scene, pairs, settings.seed))
    try:
        running = {pool.submit(_Worker.find, block): block for block in islice(blocks, 2 * settings.jobs)}
        while running:
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                yield running.pop(future), future.result()
                running |= {pool.submit(_Worker.find, block): block for block in islice(blocks, 1)}
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
