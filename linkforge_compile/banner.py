"""The comment at the top of every output, which names its spec."""

from __future__ import annotations

import re

_START, _END = "Compiled by linkforge from ", "; edit that file, not this one."

BANNER = re.compile(rf"{re.escape(_START)}(?P<spec>.+){re.escape(_END)}")
"""Matches a banner; the group `spec` is the file name of the spec."""


def banner_of(spec: str) -> str:
    """Return the banner of an output compiled from the spec with this file name."""
    return f"{_START}{spec}{_END}"
