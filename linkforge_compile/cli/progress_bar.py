"""Shows how far a long computation is, on standard error."""

from __future__ import annotations

import argparse
import sys
from time import monotonic

from linkforge_compile.cli.reports import PROGRESS_INTERVAL, print_status, write_to_stderr

WIDTH = 30
"""Characters of the bar."""

STEADY = 2.0
"""Time from the first result until a rate is known [s]."""

_REDRAWN = 0.1
"""Time until the bar on a terminal is drawn again [s]."""


class ProgressBar:
    """A bar on a terminal, and a line every PROGRESS_INTERVAL elsewhere; nothing with `--quiet`."""

    def __init__(self, total: int, unit: str, arguments: argparse.Namespace) -> None:
        self._total, self._unit, self._arguments = total, unit, arguments
        self._is_bar = sys.stderr is not None and sys.stderr.isatty() and not arguments.quiet
        self._last = monotonic()
        self._is_drawn = False
        self._before: int | None = None
        self._first: tuple[float, int] | None = None

    def show(self, done: int, note: str = "") -> None:
        """Show that so many units are done, with a note, if the last time was long enough ago.

        The first call has the number of units that are done already, which a terminal shows at once: the first result
        may need processes that start. The rate counts from that result.
        """
        now = monotonic()
        if self._before is None:
            self._before = done
            self._last = float("-inf") if self._is_bar else self._last
        elif self._first is None and done > self._before:
            self._first = now, done
        if now - self._last < (_REDRAWN if self._is_bar else PROGRESS_INTERVAL):
            return
        self._last = now
        left = self._seconds_left(now, done)
        words = f"{done:,} of {self._total:,} {self._unit}", "" if left is None else f"{left:.0f} s left", note
        text = ", ".join(filter(None, words))
        if self._is_bar:
            filled = WIDTH * done // self._total
            write_to_stderr(f"\r[{'#' * filled}{' ' * (WIDTH - filled)}] {text}\033[K")
            self._is_drawn = True
        else:
            print_status(text, self._arguments)

    def _seconds_left(self, now: float, done: int) -> float | None:
        """Return how long the rest takes at the rate since the first result, without what had to start before it."""
        begin, base = self._first or (now, done)
        return None if now - begin < STEADY or done == base else (now - begin) / (done - base) * (self._total - done)

    def close(self) -> None:
        """Remove the bar from the terminal."""
        if self._is_drawn:
            write_to_stderr("\r\033[K")
