"""Run recursive code in a thread of its own, with the whole recursion limit available."""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread
from typing import TypeVar

T = TypeVar("T")


def on_fresh_stack(work: Callable[[], T]) -> T:
    """Run `work` in a new thread; return its result or raise its error.

    Otherwise a deeply nested spec would compile or not depending on the depth of the caller's stack.
    """
    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:  # raised again in the caller's thread
            errors.append(error)

    # A daemon thread, so that an interrupted process does not wait for it.
    thread = Thread(target=run, daemon=True)
    thread.start()
    thread.join()
    if errors:
        raise errors[0]
    return results[0]
