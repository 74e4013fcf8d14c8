"""Search blocks of samples for collisions, in this process or in several, which end with this one."""

from __future__ import annotations

import signal
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from multiprocessing import get_context
from multiprocessing.connection import wait
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.collisions.pairs import Pair

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
