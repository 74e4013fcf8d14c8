"""Pause the garbage collector while a robot is compiled, joined or rendered."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def gc_paused() -> Iterator[None]:
    """Pause the garbage collector: a robot holds no reference cycles, and looking for them is a third of a compile.

    The collector is one for all threads: of two compiles at once, the first that ends resumes it.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
