"""The name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

_MOST_COMPARED = 500


def nearest(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate most like `name`, None where none is like it."""
    # difflib costs 3 ms to import and most runs never need it.
    from difflib import get_close_matches

    pool = dict.fromkeys(candidates)
    if len(pool) > _MOST_COMPARED:
        # Each comparison takes some microseconds; a misspelling mostly keeps the length and the first letter.
        like = (one for one in pool if abs(len(one) - len(name)) < 3 and one[:1].casefold() == name[:1].casefold())
        pool = dict.fromkeys(islice(like, _MOST_COMPARED))
    if not name or not pool:
        return None
    folded = {candidate.casefold(): candidate for candidate in reversed(pool)}
    if name.casefold() in folded:
        return folded[name.casefold()]
    matches = get_close_matches(name, list(pool), n=1, cutoff=0.7)
    return matches[0] if matches else _with_letters_swapped(name, pool) or _without_prefix(name, pool)


def _with_letters_swapped(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that is `name` but for two neighbours: in short names that makes all the difference."""
    swapped = {f"{name[:at]}{name[at + 1]}{name[at]}{name[at + 2 :]}" for at in range(len(name) - 1)}
    return next((other for other in candidates if other in swapped), None) if len(name) > 2 else None


def _without_prefix(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that is `name` but for a prefix that one of them has, the one with the shortest."""
    same = [other for other in candidates if other.endswith(f"_{name}") or name.endswith(f"_{other}")]
    return min(same, key=lambda other: abs(len(other) - len(name))) if same else None


def did_you_mean(name: str, candidates: Iterable[str]) -> str:
    """Return "; did you mean 'forearm'?", or nothing where no candidate is near."""
    meant = nearest(name, candidates)
    return f"; did you mean '{meant}'?" if meant is not None and meant != name else ""
