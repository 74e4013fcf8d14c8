"""Colors as style sheets and other formats write them, as the lists that a spec has."""

from __future__ import annotations

import re

_HEX = re.compile(r"(?:#|0x)((?:[0-9a-fA-F]{2}){3,4})|#([0-9a-fA-F]{3,4})")

_NAMES = {
    "black": "[0, 0, 0]",
    "blue": "[0, 0, 1]",
    "gray": "[0.5, 0.5, 0.5]",
    "green": "[0, 1, 0]",
    "grey": "[0.5, 0.5, 0.5]",
    "orange": "[1, 0.5, 0]",
    "red": "[1, 0, 0]",
    "white": "[1, 1, 1]",
    "yellow": "[1, 1, 0]",
}


def color_as_list(text: str) -> str | None:
    """Return a color's name, `#ff8000`, `0xff8000` or `#f80` as a list: "[1, 0.502, 0]"; None for other text."""
    digits = _HEX.fullmatch(text)
    if digits is None:
        return _NAMES.get(text.lower())
    pairs = digits[1] or "".join(digit * 2 for digit in digits[2])
    return f"[{', '.join(map(byte_as_component, bytes.fromhex(pairs)))}]"


def byte_as_component(byte: int) -> str:
    """Return a component of a color from 0 to 255 as one from 0 to 1."""
    return f"{byte / 255:.3g}"
