"""Room on the stack: what is walked by recursion gives the same wherever it is called from."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import TypeVar

T = TypeVar("T")

_DEEP = 100
"""How many callers may wait on the stack before work that walks trees by recursion gets a stack of its own."""


def with_room(work: Callable[[], T]) -> T:
    """Return what the work returns, or raise what it raises; in a thread of its own where the caller is deep."""
    caller: FrameType | None = sys._getframe()
    depth = 0
    while caller and depth < _DEEP:
        caller, depth = caller.f_back, depth + 1
    return work() if caller is None else _in_a_thread(work)


def _in_a_thread(work: Callable[[], T]) -> T:
    import threading

    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:  # it is the caller's, who waits
            errors.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    if errors:
        raise errors[0]
    return results[0]
