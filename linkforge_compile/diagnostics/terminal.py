"""Text for terminals: styles, how wide a text is, and columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from unicodedata import combining, east_asian_width

BOLD, DIM, CYAN, RESET = "\033[1m", "\033[2m", "\033[36m", "\033[0m"


def styled(text: str, style: str) -> str:
    """Return a text in a style, an ANSI sequence; as it is for "" or an empty text."""
    return f"{style}{text}{RESET}" if style and text else text


def width_of(text: str) -> int:
    """Return how many columns of a terminal a text fills: 2 for a wide character, 0 for a combining accent."""
    if text.isascii():
        return len(text)
    return sum(0 if combining(char) else 2 if east_asian_width(char) in "WF" else 1 for char in text)


def padded(text: str, width: int) -> str:
    """Return a text with spaces after it, so that it fills a width."""
    return text + " " * (width - width_of(text))


def align(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield rows of a table as lines, with the columns below each other."""
    widths = [max(map(width_of, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "  ".join(map(padded, row, widths)).rstrip()
