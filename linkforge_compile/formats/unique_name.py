"""Names that formats invent, for elements whose names must be unique."""

from __future__ import annotations

from collections.abc import Container
from itertools import chain, count


def unique_name(name: str, taken: Container[str]) -> str:
    """Return a name, or with the lowest number from 2 after it that makes it one that is not taken."""
    numbered = (f"{name}_{number}" for number in count(2))
    return next(one for one in chain([name], numbered) if one not in taken)
