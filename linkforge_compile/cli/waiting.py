"""A word to who waits: a vendor's xacro may compute for a minute."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from linkforge_compile.cli.telling import say

if TYPE_CHECKING:
    import argparse

PATIENCE = 3.0
"""Seconds after which who waits at a terminal is told for what."""


@contextmanager
def told_when_long(file: str, arguments: argparse.Namespace) -> Iterator[None]:
    """Tell at a terminal what is under way, if it is still under way after some seconds."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield
        return
    from threading import Timer

    timer = Timer(PATIENCE, say, (f"still reading {file}; Ctrl-C ends it", arguments))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
