"""Numbers that YAML reads as text, or as two: with a comma, spaces or underscores among their digits, or in a row."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from itertools import pairwise

from linkforge_compile.schema.json_types import Schema, branches
from linkforge_compile.schema.words import is_number, shown
from linkforge_compile.syntax.nodes import YamlList, YamlNode, YamlScalar
from linkforge_compile.units import parse_quantity

_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(\s*[^\d\s,]\S*|)")
_UNDERSCORES = re.compile(r"(?<=[0-9a-fA-F])_+(?=[0-9a-fA-F])")
"""What YAML 1.1 and Python read over between digits, and YAML 1.2 does not."""
_GROUPED = re.compile(r"([+-]?\d{1,3}(?:(?:\s\d{3})+|(?:,\d{3}){2,}))(?!\d)(.*)")
"""A number whose thousands are parted by spaces, or by several commas, and what stands behind it."""
_THOUSANDS_COMMA = re.compile(r"([+-]?[1-9]\d{0,2}),(\d{3})(\s*[^\d\s,]\S*|)")
"""A number whose comma may part thousands."""
_MINUS_SIGNS = ("\u2212", "\u2013", "\u2014")
"""What word processors make of a hyphen before a number."""
_ZEROS_FIRST = re.compile(r"0\d+")
_MOST_ITEMS = 100
"""A list that is longer is not written anew in a message."""
_LONGEST_ROW = 2000
"""A text of so many characters is no row that somebody wrote; a hostile one is not read word by word."""
_ANY_LENGTH = range(2, sys.maxsize)


def number_meant(text: str) -> str | None:
    """Return a number, with its unit if it has one, as it is written here; None for any other text."""
    if text[:1] in _MINUS_SIGNS:
        text = f"-{text[1:]}"
        return text if is_number(text) or parse_quantity(text) else number_meant(text)
    if comma := _DECIMAL_COMMA.fullmatch(text):
        return f"{comma[1]}.{comma[2]}{comma[3]}"
    joined = _UNDERSCORES.sub("", text)
    if grouped := _GROUPED.fullmatch(joined):
        joined = re.sub(r"[\s,]", "", grouped[1]) + grouped[2]
    return joined if joined != text and (is_number(joined) or parse_quantity(joined)) else None


def number_to_write(text: str, unit: str | None) -> str:
    """Return what to write for a number in words, both readings of `1,500`; "" for any other text.

    `unit` is the SI unit of what is asked for: a number of another dimension was not meant; None for any.
    """
    meant = number_meant(text)
    quantity = parse_quantity(meant) if meant else None
    if meant is None or (unit and quantity and quantity.dimension.si_unit != unit):
        return ""
    thousands = _THOUSANDS_COMMA.fullmatch(text)
    return f"'{meant}', or '{''.join(thousands.groups())}' if the comma parts thousands" if thousands else f"'{meant}'"


def row_meant(text: str, lengths: Sequence[range] = (_ANY_LENGTH,)) -> Sequence[str]:
    """Return the numbers of a text that has as many as fit, with spaces or commas between them; () for other text.

    Where spaces part them, the commas within are decimal ones, unless too few remain.
    """
    if len(text) > _LONGEST_ROW or _DECIMAL_COMMA.fullmatch(text):
        return ()
    spaced = [word.strip(",") for word in text.split()]
    rows = (_numbers(words) for words in (spaced, re.split(r"[\s,]+", text.strip())))
    return next((row for row in rows if len(row) > 1 and any(len(row) in length for length in lengths)), ())


def lengths_of_lists(schema: Schema) -> list[range]:
    """Return how many items the lists have that a schema takes; none where it takes no list."""
    lists = (branch for branch in branches(schema) if "items" in branch)
    bounds = [(each.get("minItems", 2), each.get("maxItems", _MOST_ITEMS)) for each in lists]
    return [range(least, most + 1) for least, most in bounds if isinstance(least, int) and isinstance(most, int)]


def _numbers(words: Sequence[str]) -> Sequence[str]:
    """Return the numbers that words are, some of which may be units behind them; () where one is neither."""
    numbers: list[str] = []
    for word in words:
        if (is_number(word) and not _ZEROS_FIRST.fullmatch(word)) or parse_quantity(word):
            numbers.append(word)
        elif numbers and is_number(numbers[-1]) and parse_quantity(f"{numbers[-1]} {word}"):
            numbers[-1] += f" {word}"
        elif meant := number_meant(word):
            numbers.append(meant)
        else:
            return ()
    return numbers


def is_row(node: YamlNode) -> bool:
    """Whether it is text of several numbers with spaces or commas between them, but no decimal comma."""
    return isinstance(node, YamlScalar) and isinstance(node.value, str) and bool(row_meant(node.text))


def row_of_items(node: YamlList, lengths: Sequence[range]) -> Sequence[str]:
    """Return the numbers of a list, some items of which are several, or a part of one before a decimal comma."""
    if len(node) > _MOST_ITEMS:
        return ()
    parts = [f"{',' if _is_stuck(before, item) else ', '}{shown(item)}" for before, item in pairwise(node)]
    return row_meant("".join((*map(shown, node.items[:1]), *parts)), lengths)


def _is_stuck(before: YamlNode, item: YamlNode) -> bool:
    """Whether nothing but a comma is between two items."""
    return before.span.end == (item.span.line, item.span.column - 1)


def with_points(node: YamlList) -> list[str]:
    """Return the items of a list, two as one where they were meant so: `1,5 mm`, without a space behind the comma."""
    items: list[str] = []
    before: YamlNode | None = None
    for item in node:
        is_stuck = before is not None and _is_stuck(before, item)
        if is_stuck and re.fullmatch(r"[+-]?\d+", items[-1]) and number_meant(f"{items[-1]},{shown(item)}"):
            items[-1] = f"{items[-1]}.{shown(item)}"
        else:
            items.append(shown(item))
        before = item
    return items
