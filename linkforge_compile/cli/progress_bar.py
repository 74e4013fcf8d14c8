"""Shows how far a long computation is, on standard error."""

from __future__ import annotations

import sys
from time import monotonic
from typing import TYPE_CHECKING

from linkforge_compile.cli.reports import PROGRESS_INTERVAL, print_status, write_to_stderr

if TYPE_CHECKING:
    import argparse

WIDTH = 30
"""Characters of the bar."""

_REDRAWN = 0.1
"""Time until the bar on a terminal is drawn again [s]."""


class ProgressBar:
    """A bar on a terminal, and a line every PROGRESS_INTERVAL elsewhere; nothing with `--quiet`."""

    def __init__(self, total: int, unit: str, arguments: argparse.Namespace) -> None:
        self._total, self._unit, self._arguments = total, unit, arguments
        self._is_bar = sys.stderr is not None and sys.stderr.isatty() and not arguments.quiet
        self._begin = self._last = monotonic()
        self._is_drawn = False
        self.before = 0
        """How many units were done before the bar began, which count for nothing in the time that is left."""

    def show(self, done: int, note: str = "") -> None:
        """Show that so many units are done, with a note, if the last time was long enough ago."""
        now = monotonic()
        if now - self._last < (_REDRAWN if self._is_bar else PROGRESS_INTERVAL):
            return
        self._last = now
        new = done - self.before
        left = (now - self._begin) / new * (self._total - done) if new else 0.0
        text = f"{done:,} of {self._total:,} {self._unit}, {left:.0f} s left{f', {note}' if note else ''}"
        if self._is_bar:
            filled = WIDTH * done // self._total
            write_to_stderr(f"\r[{'#' * filled}{' ' * (WIDTH - filled)}] {text}\033[K")
            self._is_drawn = True
        else:
            print_status(text, self._arguments)

    def close(self) -> None:
        """Remove the bar from the terminal."""
        if self._is_drawn:
            write_to_stderr("\r\033[K")
