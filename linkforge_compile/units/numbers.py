"""Numbers as text: the one place where a float is spelled."""

from __future__ import annotations

import re
from collections.abc import Callable
from operator import index

_IN_FULL = re.compile(r"-?(?:0|[1-9][0-9]*)\.[0-9]+")


def number_text(value: float) -> str:
    """Return the shortest decimal text that reads back to the same double.

    Whole numbers carry no ".0", zero no sign, and exponents no padding: 4.0 is "4", -0.0 is "0", 1e-07 is "1e-7".
    Python's repr is the shortest by digits (David Gay's algorithm); integers keep every digit. Numbers of NumPy are
    written as the double, or the integer, that they are.
    """
    if not isinstance(value, float):
        try:
            return str(index(value))
        except TypeError:  # it is no whole number; that it has an `__index__` says nothing: every array has one
            value = float(value)
    return double_text(value)


def is_in_full(text: str) -> bool:
    """Whether a text is a number that is written out with a point, as in `1.0` and `0.50`."""
    return _IN_FULL.fullmatch(text) is not None


class _Texts(dict[float, str]):
    """The texts of doubles that were asked for: a robot says the same numbers again and again."""

    def __missing__(self, value: float) -> str:
        if len(self) >= _MOST_REMEMBERED:
            self.clear()
        text = self[value] = _spelled(value)
        return text


_MOST_REMEMBERED = 4096

double_text: Callable[[float], str] = _Texts().__getitem__
"""Returns what `number_text` does, of what is known to be a float."""


def _spelled(value: float) -> str:
    if value == 0:
        return "0"
    digits, marker, exponent = float.__repr__(value).partition("e")
    if not marker:
        return digits.removesuffix(".0")
    return f"{digits}e{int(exponent)}"
