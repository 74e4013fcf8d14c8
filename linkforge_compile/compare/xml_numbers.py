"""Numbers that stand in XML as texts, which spell them in many ways."""

from __future__ import annotations

import math
import re
from decimal import Decimal

from linkforge_compile.compare.measures import is_near

_NUMBER = re.compile(r"[+-]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?")
"""A number as XML has it. One that begins with a zero is not meant as one: 007 is another name than 7."""


def say_the_same(before: str, after: str, tolerance: float) -> bool:
    """Whether two texts in XML are the same numbers: `0.20 1e-3` is another spelling of `0.2 0.001`.

    Two whole numbers are so only if they are equal: they may count or name something, and have more digits than a
    double. Others may differ by the tolerance, as a share.
    """
    were, are = before.split(), after.split()
    if not 0 < len(were) == len(are):
        return False
    return all(_is_same(*pair, tolerance) for pair in zip(were, are, strict=True))


def number_in(text: str) -> float | None:
    """Return the number that a text in XML is; None for another text, and for one that no double holds."""
    number = float(text) if _NUMBER.fullmatch(text.strip()) else math.inf
    return number if math.isfinite(number) else None


def _is_same(before: str, after: str, tolerance: float) -> bool:
    if not (_NUMBER.fullmatch(before) and _NUMBER.fullmatch(after)):
        return False
    was, now = Decimal(before), Decimal(after)
    if was == now or (_is_whole(was) and _is_whole(now)):
        return was == now
    return is_near(float(was), float(now), tolerance)


def _is_whole(number: Decimal) -> bool:
    return number == number.to_integral_value()
