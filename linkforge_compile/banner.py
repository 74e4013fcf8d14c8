"""The comment above every output: which spec it is compiled from, and that edits belong there."""

from __future__ import annotations

import re

_START, _END = "Compiled by linkforge from ", "; edit that file, not this one."

BANNER = re.compile(rf"{re.escape(_START)}(?P<spec>.+){re.escape(_END)}")
"""What a banner is known by; `spec` is the file name of the spec."""


def banner_of(spec: str) -> str:
    """Return the banner of what is compiled from the spec of this file name."""
    return f"{_START}{spec}{_END}"
