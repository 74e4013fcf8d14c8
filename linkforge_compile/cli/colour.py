"""Whether what is printed is coloured."""

from __future__ import annotations

import os
from typing import TextIO

WHEN = ("auto", "always", "never")
"""The values of `--color`."""


def is_coloured(stream: TextIO | None, when: str = "auto") -> bool:
    """Whether to colour what goes to the stream, None for one that is closed.

    `--color` decides, then NO_COLOR (no-color.org), then FORCE_COLOR and CLICOLOR_FORCE, which a build sets whose log
    shows colours though it is no terminal; a variable that is empty says nothing, and `0` forces nothing.
    """
    if when != "auto":
        return when == "always"
    environment = os.environ
    if environment.get("NO_COLOR"):
        return False
    if any(environment.get(name, "0") not in {"", "0"} for name in ("FORCE_COLOR", "CLICOLOR_FORCE")):
        return True
    return stream is not None and stream.isatty() and environment.get("TERM") != "dumb"
