"""Prints a message if work takes long, as a vendor's xacro may."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from linkforge_compile.cli.telling import say

if TYPE_CHECKING:
    import argparse

PATIENCE = 3.0
"""Time until the message is printed [s]."""


@contextmanager
def told_when_long(file: str, arguments: argparse.Namespace) -> Iterator[None]:
    """On a terminal, print which file is being read if the body takes longer than PATIENCE."""
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
