"""Suggest the valid name that is most like a misspelled one."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import islice

_MOST_COMPARED = 500
_LONGEST = 200
"""Characters of a name that is still compared."""

_LEAST_LIKENESS = 0.7

_MOST_APART = 2
"""How many letters a misspelling adds, leaves out or changes."""

_STEPS_OF_A_NAME = 100_000
_STEPS_OF_A_COMPILE = 4_000_000
"""A step looks at one letter or name and needs some tenths of a microsecond."""

_STEPS_OF_A_COUNT = 10
"""What counting the letters of a name costs, in addition to one step a letter."""


class _Steps:
    """The steps that a compile may still spend on suggestions."""

    def __init__(self) -> None:
        self.left = _STEPS_OF_A_COMPILE


_SHARED: ContextVar[_Steps | None] = ContextVar("_SHARED", default=None)


@contextmanager
def suggestion_budget() -> Iterator[None]:
    """Let all suggestions within share the steps of one compile; without steps left, there are no more."""
    token = _SHARED.set(_Steps())
    try:
        yield
    finally:
        _SHARED.reset(token)


def nearest(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate most like `name`; None if none is, or if no steps are left."""
    steps = _SHARED.get() or _Steps()
    if not 0 < len(name) <= _LONGEST or steps.left <= 0:
        return None
    pool = dict.fromkeys(candidates)
    steps.left -= len(pool)
    if len(pool) > _MOST_COMPARED:
        # A misspelling mostly keeps the length and the first letter.
        like = (one for one in pool if abs(len(one) - len(name)) < 3 and one[:1].casefold() == name[:1].casefold())
        pool = dict.fromkeys(islice(like, _MOST_COMPARED))
    near = [candidate for candidate in pool if len(candidate) <= _LONGEST]
    folded = {candidate.casefold(): candidate for candidate in reversed(near)}
    if name.casefold() in folded:
        return folded[name.casefold()]
    return _most_like(name, near, steps) or _with_letters_swapped(name, near) or _without_prefix(name, near)


def _most_like(name: str, candidates: Iterable[str], steps: _Steps) -> str | None:
    """Return the best of difflib's `get_close_matches`, without the comparisons that cannot change it.

    The ratio of two names is at most that of their letters in any order, which is cheap to count; the candidates are
    compared in the order of that bound.
    """
    counts = Counter(name)
    possible = []
    for other in candidates:
        most = 2.0 * min(len(name), len(other)) / (len(name) + len(other))
        if most >= _LEAST_LIKENESS:
            steps.left -= _STEPS_OF_A_COUNT + len(counts)
            common = sum(min(count, other.count(letter)) for letter, count in counts.items())
            possible.append((2.0 * common / (len(name) + len(other)), other))
    best = (_LEAST_LIKENESS, "")
    if max(possible, default=best) < best:
        return None
    # difflib costs 3 ms to import and most runs never need it.
    from difflib import SequenceMatcher

    matcher = SequenceMatcher(b=name)
    left = min(steps.left, _STEPS_OF_A_NAME)
    for most_and_other in sorted(possible, reverse=True):
        if most_and_other <= best or left <= 0:
            break
        other = most_and_other[1]
        matcher.set_seq1(other)
        best = max(best, (matcher.ratio(), other))
        left -= len(name) * len(other)
        steps.left -= len(name) * len(other)
    return best[1] or None


def _with_letters_swapped(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that differs by two swapped neighbours, which in short names is a low ratio."""
    swapped = {f"{name[:at]}{name[at + 1]}{name[at]}{name[at + 2 :]}" for at in range(len(name) - 1)}
    return next((other for other in candidates if other in swapped), None) if len(name) > 2 else None


def _without_prefix(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that differs by a prefix of one of the two, the one with the shortest prefix."""
    same = [other for other in candidates if other.endswith(f"_{name}") or name.endswith(f"_{other}")]
    return min(same, key=lambda other: abs(len(other) - len(name))) if same else None


def suggested(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate most like `name` and not equal to it; None if there is none."""
    candidate = nearest(name, candidates)
    return candidate if candidate != name else None


def is_other_case(name: str, candidates: Iterable[str]) -> bool:
    """Whether exactly one of the candidates has the same letters in another case."""
    return sum(other.casefold() == name.casefold() for other in {*candidates}) == 1


def is_misspelling(name: str, intended: str) -> bool:
    """Whether two names are at most two letters apart, and no word of either with a digit differs.

    `ur5_descripton` may be a misspelling of `ur5_description`; `ur5e_description` is the name of another robot.
    """
    from difflib import SequenceMatcher

    one, other = name.casefold(), intended.casefold()
    if _models_in(one) != _models_in(other):
        return False
    changes = SequenceMatcher(None, one, other, autojunk=False).get_opcodes()
    return sum(max(i2 - i1, j2 - j1) for tag, i1, i2, j1, j2 in changes if tag != "equal") <= _MOST_APART


def _models_in(name: str) -> list[str]:
    """Return the words of a name that have digits, as those of models have."""
    return [word for word in re.split(r"[_\W]+", name) if any(map(str.isdecimal, word))]


def did_you_mean(name: str, candidates: Iterable[str]) -> str:
    """Return such as "; did you mean 'forearm'?"; "" if no candidate is like the name."""
    candidate = suggested(name, candidates)
    return f"; did you mean '{candidate}'?" if candidate else ""
