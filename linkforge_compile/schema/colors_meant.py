"""Colors as style sheets and people write them."""

from __future__ import annotations

import re


def color_meant(text: str) -> str | None:
    """Return a color by its name, or in hexadecimal digits, as it is written here; None for any other text."""
    return _COLORS.get(text.lower()) or _of_hex_digits(text)


def _of_hex_digits(text: str) -> str | None:
    found = re.fullmatch(r"(?:#|0x)((?:[0-9a-fA-F]{2}){3,4})", text)
    return None if found is None else f"[{', '.join(f'{part / 255:.3g}' for part in bytes.fromhex(found[1]))}]"


_COLORS = {
    "black": "[0, 0, 0]",
    "blue": "[0, 0, 1]",
    "brown": "[0.6, 0.3, 0.1]",
    "cyan": "[0, 1, 1]",
    "gray": "[0.5, 0.5, 0.5]",
    "green": "[0, 1, 0]",
    "grey": "[0.5, 0.5, 0.5]",
    "magenta": "[1, 0, 1]",
    "orange": "[1, 0.5, 0]",
    "pink": "[1, 0.75, 0.8]",
    "purple": "[0.5, 0, 0.5]",
    "red": "[1, 0, 0]",
    "silver": "[0.75, 0.75, 0.75]",
    "white": "[1, 1, 1]",
    "yellow": "[1, 1, 0]",
}
"""Red, green and blue of what people call by its name."""
