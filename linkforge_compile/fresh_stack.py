"""Run recursive work in a thread of its own, so that what it can do does not depend on its caller's stack."""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread
from typing import TypeVar

T = TypeVar("T")


def on_fresh_stack(work: Callable[[], T]) -> T:
    """Return what the work returns, or raise what it raises, with all of Python's recursion limit to itself.

    A spec that nests as deep as the language allows would otherwise compile from one caller and not from another.
    """
    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:  # the caller's, who waits
            errors.append(error)

    # A daemon: an interrupted process does not wait for it.
    thread = Thread(target=run, daemon=True)
    thread.start()
    thread.join()
    if errors:
        raise errors[0]
    return results[0]
