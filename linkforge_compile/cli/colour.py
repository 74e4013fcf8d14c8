"""Decides whether output is colored."""

from __future__ import annotations

import os
from typing import TextIO

WHEN = ("auto", "always", "never")
"""The values of `--color`."""


def is_coloured(stream: TextIO | None, when: str = "auto") -> bool:
    """Whether to color output to a stream, None if it is closed.

    In order of precedence: `--color` (`when`), NO_COLOR (no-color.org), FORCE_COLOR and CLICOLOR_FORCE, which builds
    set if their log shows colors, and whether the stream is a terminal. An empty variable, or a forcing one that is
    `0`, counts as unset.
    """
    if when != "auto":
        return when == "always"
    environment = os.environ
    if environment.get("NO_COLOR"):
        return False
    if any(environment.get(name, "0") not in {"", "0"} for name in ("FORCE_COLOR", "CLICOLOR_FORCE")):
        return True
    return stream is not None and stream.isatty() and environment.get("TERM") != "dumb"
