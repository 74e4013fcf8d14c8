"""Write several names or words one after the other in a message."""

from __future__ import annotations

from collections.abc import Sequence

MOST_LISTED = 8
"""How many names a message lists."""


def alternatives(words: Sequence[str], last: str = "or") -> str:
    """Return "a", "a or b", "a, b or c"."""
    return f"{', '.join(words[:-1])} {last} {words[-1]}" if len(words) > 1 else words[0]


def listed(names: Sequence[str], last: str) -> str:
    """Return names in quotes as messages list them, of many the first few."""
    rest = len(names) - MOST_LISTED
    shown = [*(f"'{name}'" for name in names[:MOST_LISTED]), *([f"{rest} more"] if rest > 0 else [])]
    return alternatives(shown, last)
