"""The keys of the language that this version does not compile yet: a table that shrinks as the compiler grows."""

from __future__ import annotations

from collections.abc import Mapping

UNBUILT: Mapping[str, set[str]] = {
    "a module": {"srdf"},
}
"""The keys by the owner, which is the `title` of its schema."""
