"""Sample positions of the joints, and give each pair of links its reason."""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from multiprocessing import get_context
from multiprocessing.connection import wait
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.collisions.scene import Pair, Reason, adjacent_pairs

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import SpawnProcess

    from linkforge_compile.collisions.collider import Collider
    from linkforge_compile.collisions.scene import Scene


BLOCK = 50
"""Samples of a block, each with a generator of its own, so that the number of processes changes no result."""


class Block(NamedTuple):
    """The number of a block and of its samples."""

    number: int
    samples: int


Found: TypeAlias = tuple[Block, set[Pair]]
"""A block, and the pairs that collide in one of its samples."""


class Search(NamedTuple):
    """Which pairs to search in the blocks from `first_block` on, and the seed of their samples."""

    pairs: Sequence[Pair]
    samples: int
    seed: int
    first_block: int


def blocks_of(samples: int) -> Iterator[Block]:
    """Yield the blocks of some samples."""
    for number, start in enumerate(range(0, samples, BLOCK)):
        yield Block(number, min(BLOCK, samples - start))


def find_in_blocks(collider: Collider, search: Search, *, step: int = 1) -> Iterator[Found]:
    """Yield the first block, and each one after `step` others, with its pairs."""
    for block in islice(blocks_of(search.samples), search.first_block, None, step):
        yield block, _find(collider, search.pairs, block, search.seed)


def find_in_processes(scene: Scene, search: Search, jobs: int) -> Iterator[Found]:
    """Yield the blocks with their pairs, in the order in which some processes have searched them.

    Raises:
        RuntimeError: A process has failed.

    """
    # A new process, and not a fork: Pinocchio's threads would not be in the fork.
    context = get_context("spawn")
    workers: dict[Connection, SpawnProcess] = {}
    try:
        with _interrupts_held():
            for number in range(jobs):
                results, end = context.Pipe(duplex=False)
                share = search._replace(first_block=search.first_block + number)
                worker = context.Process(target=_send_found, args=(end, scene, share, jobs), daemon=True)
                worker.start()
                end.close()  # so that the worker's is the only one, and closes with it
                workers[results] = worker
        while workers:
            ready = wait(workers)
            for results in [one for one in workers if one in ready]:
                try:
                    found = results.recv()
                except EOFError:
                    _require_success(workers.pop(results))
                else:
                    yield found
    finally:
        for worker in workers.values():
            worker.kill()
        for worker in workers.values():
            worker.join()


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Hold back a Ctrl-C until processes are started, which inherit that they get none.

    It goes to all processes of a terminal, and this one ends the others.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # its start, which is otherwise that of the first process, stops the holding
    arrived: list[int] = []
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    # A thread of a library may get the signal, whose handler then runs in this one all the same.
    handler = signal.signal(signal.SIGINT, lambda number, _: arrived.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    if arrived:
        raise KeyboardInterrupt


def _send_found(end: Connection, scene: Scene, search: Search, step: int) -> None:
    """Search blocks in a process of its own, and send what is found for as long as the first process exists."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # on Windows nothing is inherited
    from linkforge_compile.collisions.collider import Collider

    try:
        for found in find_in_blocks(Collider(scene, search.pairs), search, step=step):
            end.send(found)
    except BrokenPipeError:
        return


def _require_success(worker: SpawnProcess) -> None:
    worker.join()
    if worker.exitcode:
        raise RuntimeError(f"a process that samples positions ended with exit code {worker.exitcode}")


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
