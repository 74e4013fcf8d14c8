"""How much one compile may take: one table of limits, and the counter that all its files share."""

from __future__ import annotations

import os
from dataclasses import dataclass
from enum import Enum

from linkforge_compile.diagnostics import BeyondLimitError, Code, Where
from linkforge_compile.diagnostics.codes.bounds import BEYOND_LIMIT

MAX_FILE_BYTES = 16 * 1024 * 1024
"""How large one text may be that is read, a spec, data or XML."""

MAX_NESTED_ELEMENTS = 100
"""How deep the elements of a document of XML, or of raw XML in a spec, may be nested."""

FACTOR_VARIABLE = "LINKFORGE_LIMITS"
"""The environment variable that allows so many times as much: the user's word, which no spec can say."""


@dataclass(frozen=True)
class _Limit:
    """What is counted, how much of it there may be, and how to need less."""

    counted: str
    most: int
    way_out: str


class Limit(Enum):
    """What all files of one compile together may take.

    Chosen so that what reaches one of them is told within ten seconds and 512 MB, and so that a robot of ten
    thousand links stays within all of them.
    """

    CHARACTERS_READ = _Limit(
        "characters in its files", 32 * 1024**2, "leave out files that it does not need, or compile parts of it apart"
    )
    VALUES = _Limit(
        "values and tags of raw XML, with every alias, 'for' and use of a module written out",
        500_000,
        "repeat less, or compile parts of it apart",
    )
    ENTRIES = _Limit(
        "links, joints, other entries and modules, each counted again for every module around it",
        30_000,
        "repeat less, nest modules less deeply, or compile parts of it apart",
    )
    PAIRS = _Limit(
        "pairs of links whose collisions are disabled or enabled, counted as entries are",
        100_000,
        "list whole links in 'no_default_collision_links', or compile parts of it apart",
    )
    ROUNDS = _Limit("rounds of 'for'", 50_000, "repeat less, or compile parts of it apart")
    CHARACTERS_MADE = _Limit(
        "characters that expressions, 'for' and modules write", 16_000_000, "make shorter texts, or fewer of them"
    )
    STEPS = _Limit(
        "steps of expressions and patterns, where each item of a list that is looked through is one",
        3_000_000,
        "compute what is used often once, in 'variables'",
    )
    IGNORED_CODES = _Limit(
        "codes in comments that ask not to be told of them",
        20_000,
        "mend what is told, or leave it out with '--ignore'",
    )
    MESH_BYTES = _Limit(
        "bytes in the meshes that an inertia is computed from",
        256 * 1024**2,
        "give links their 'inertia', or simpler collision meshes",
    )
    TEMPLATE_STEPS = _Limit(
        "steps of templates, where a round of 'for' or an item of a list is one, and a call or an include ten",
        1_000_000,
        "repeat less, or render fewer templates at once",
    )
    TEMPLATE_CHARACTERS = _Limit(
        "characters that templates handle, in filters and calls as in the documents that they write",
        32 * 1024**2,
        "handle shorter texts, or render fewer templates at once",
    )

    # Counted by as often as anything is computed: that of Enum is written in Python.
    __hash__ = object.__hash__

    @property
    def counted(self) -> str:
        return self.value.counted

    @property
    def most(self) -> int:
        return self.value.most


def factor_of(said: str) -> int | None:
    """Return how many times all limits are allowed; None for what is no whole number from 1 to 999,999,999."""
    return int(said) or None if said.isascii() and said.isdigit() and len(said) < 10 else None


class Budget:
    """What one compile may still take."""

    def __init__(self, times: int = 1, *, code: Code = BEYOND_LIMIT, within: Budget | None = None) -> None:
        """`times` the limits are allowed; `code` is told of what is more.

        What is taken counts in the budget that this one is `within` as well.
        """
        self._code, self.within = code, within
        self.times = times * (factor_of(os.environ.get(FACTOR_VARIABLE, "")) or 1)
        self._left = {limit: limit.most * self.times for limit in Limit}

    def left(self, limit: Limit) -> int:
        """Return how much is left of one limit, here and in what this is within; below 0 where it is passed."""
        own = self._left[limit]
        return own if self.within is None else min(own, self.within.left(limit))

    @property
    def is_spent(self) -> bool:
        """Whether one of the limits is passed."""
        return min(self._left.values()) < 0

    def spend(self, limit: Limit, amount: int, where: Where) -> None:
        """Count what is taken at a place; raise BeyondLimitError where that is more than there may be."""
        left = self._left[limit]
        if self.within is not None:
            # Refused for whatever amount, a compile takes all that it may have, and the one that is too much.
            self.within.spend(limit, min(amount, left + 1), where)
        self._left[limit] = left - amount
        if amount > left:
            raise self.beyond(limit, where)

    def beyond(self, limit: Limit, where: Where) -> BeyondLimitError:
        """Return what to raise at the place that passes a limit."""
        most = f"{limit.most * self.times:,}"
        return BeyondLimitError(self._code.at(where, most=most, counted=limit.counted, way_out=limit.value.way_out))
