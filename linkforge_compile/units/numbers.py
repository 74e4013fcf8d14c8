"""Numbers as text: the only place where a float is formatted."""

from __future__ import annotations

import re
from functools import lru_cache
from operator import index

_IN_FULL = re.compile(r"-?(?:0|[1-9][0-9]*)\.[0-9]+")


def number_text(value: float) -> str:
    """Return the shortest decimal text that reads back to the same double.

    Whole numbers have no ".0", zero has no sign and exponents no padding: 4.0 is "4", -0.0 is "0", 1e-07 is "1e-7".
    Integers keep every digit. NumPy numbers are formatted as the float or integer that they hold.
    """
    if not isinstance(value, float):
        try:
            return str(index(value))
        except TypeError:  # not an integer; hasattr(__index__) would not tell, every array has it
            value = float(value)
    return double_text(value)


def is_in_full(text: str) -> bool:
    """Whether a text is a decimal number with a point and no exponent, as in `1.0` and `0.50`."""
    return _IN_FULL.fullmatch(text) is not None


@lru_cache(maxsize=4096)
def double_text(value: float) -> str:
    """Return what `number_text` does, for a value that is a float."""
    if value == 0:
        return "0"
    digits, marker, exponent = float.__repr__(value).partition("e")
    if not marker:
        return digits.removesuffix(".0")
    return f"{digits}e{int(exponent)}"
