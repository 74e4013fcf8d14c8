"""Limits on the size of a compile, and the budget that all files of a compile share."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from linkforge_compile.diagnostics import BeyondLimitError, Code, Where
from linkforge_compile.diagnostics.codes.modules import BEYOND_LIMIT

MAX_FILE_BYTES = 16 * 1024 * 1024
"""The largest spec, data file or XML file that is read."""

MAX_NESTED_ELEMENTS = 100
"""How deep elements may be nested in an XML document, or in raw XML in a spec."""

FACTOR_VARIABLE = "LINKFORGE_LIMITS"
"""The environment variable by whose value all limits are multiplied; a spec cannot set it."""


@dataclass(frozen=True)
class _Limit:
    """What is counted, the largest amount, and advice for a spec that exceeds it."""

    counted: str
    most: int
    way_out: str


class Limit(Enum):
    """What all files of one compile may use together.

    A compile that exceeds a limit is stopped within ten seconds and 512 MB; a robot of ten thousand links stays
    within all limits.
    """

    CHARACTERS_READ = _Limit(
        "characters in its files", 32 * 1024**2, "remove files that it does not need, or compile parts of it separately"
    )
    VALUES = _Limit(
        "values and tags of raw XML, with every alias, 'for' and use of a module written out",
        500_000,
        "repeat less, or compile parts of it separately",
    )
    ENTRIES = _Limit(
        "links, joints, other entries and modules, each counted again for every module around it",
        30_000,
        "repeat less, nest modules less deeply, or compile parts of it separately",
    )
    PAIRS = _Limit(
        "pairs of links whose collisions are disabled or enabled, counted as entries are",
        100_000,
        "list whole links in 'no_default_collision_links', or compile parts of it separately",
    )
    ROUNDS = _Limit("iterations of 'for'", 50_000, "repeat less, or compile parts of it separately")
    CHARACTERS_MADE = _Limit(
        "characters that expressions, 'for' and modules write", 16_000_000, "write shorter strings, or fewer of them"
    )
    STEPS = _Limit(
        "steps of expressions and patterns, where each item of a list that is looked through is one",
        3_000_000,
        "compute what is used often once, in 'variables'",
    )
    IGNORED_CODES = _Limit(
        "codes in `linkforge: ignore` comments",
        20_000,
        "fix what is reported, or hide it with '--ignore'",
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
        "use shorter strings, or render fewer templates at once",
    )

    # The key of a dict that every computed value looks up: Enum.__hash__ is a Python function, object's is not.
    __hash__ = object.__hash__

    @property
    def counted(self) -> str:
        return self.value.counted

    @property
    def most(self) -> int:
        return self.value.most


def parse_factor(text: str) -> int | None:
    """Return the value of LINKFORGE_LIMITS; None for anything but a whole number from 1 to 999,999,999."""
    return int(text) or None if text.isascii() and text.isdigit() and len(text) < 10 else None


class Budget:
    """The rest of each limit that a compile may still use."""

    def __init__(self, times: int = 1, *, code: Code = BEYOND_LIMIT, within: Budget | None = None) -> None:
        """Allow `times` the limits; report `code` for what exceeds them.

        Spending also counts in the budget `within` which this one is.
        """
        self._code, self.within = code, within
        self.times = times * (parse_factor(os.environ.get(FACTOR_VARIABLE, "")) or 1)
        self._left = {limit: limit.most * self.times for limit in Limit}

    def left(self, limit: Limit) -> int:
        """Return the rest of a limit, here and in the outer budget; below 0 once it is exceeded."""
        own = self._left[limit]
        return own if self.within is None else min(own, self.within.left(limit))

    @property
    def left_of_all(self) -> dict[Limit, int]:
        """The rest of every limit, without regard to the outer budget."""
        return dict(self._left)

    def allows(self, amounts: Mapping[Limit, int]) -> bool:
        """Whether so much of some limits may still be spent."""
        return all(self.left(limit) >= amount for limit, amount in amounts.items())

    @property
    def is_spent(self) -> bool:
        """Whether any limit is exceeded."""
        return min(self._left.values()) < 0

    def spend(self, limit: Limit, amount: int, where: Where) -> None:
        """Subtract what is used at a place; raise BeyondLimitError where that exceeds the limit."""
        left = self._left[limit]
        if self.within is not None:
            # A refused amount costs the outer budget what was left here and one more, however large it is.
            self.within.spend(limit, min(amount, left + 1), where)
        self._left[limit] = left - amount
        if amount > left:
            raise self.beyond(limit, where)

    def beyond(self, limit: Limit, where: Where) -> BeyondLimitError:
        """Return the error to raise at the place that exceeds a limit."""
        most = f"{limit.most * self.times:,}"
        return BeyondLimitError(self._code.at(where, most=most, counted=limit.counted, way_out=limit.value.way_out))
