"""Numbers that YAML reads as text, or as two: with a comma, spaces or underscores among their digits, or in a row."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkforge_compile.schema.words import is_number, shown
from linkforge_compile.syntax.nodes import YamlList, YamlNode, YamlScalar
from linkforge_compile.units import parse_quantity

_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(\s*[^\d\s,]\S*|)")
_UNDERSCORES = re.compile(r"(?<=[0-9a-fA-F])_+(?=[0-9a-fA-F])")
"""What YAML 1.1 and Python read over between digits, and YAML 1.2 does not."""
_GROUPED = re.compile(r"([+-]?\d{1,3}(?:\s\d{3})+)(?!\d)(.*)")
"""A number whose thousands are parted by spaces, and what stands behind it."""
_MINUS_SIGNS = ("\u2212", "\u2013", "\u2014")
"""What word processors make of a hyphen before a number."""
_ZEROS_FIRST = re.compile(r"0\d+")


def number_meant(text: str) -> str | None:
    """Return a number, with its unit if it has one, as it is written here; None for any other text."""
    if text[:1] in _MINUS_SIGNS:
        text = f"-{text[1:]}"
        return text if is_number(text) or parse_quantity(text) else number_meant(text)
    if comma := _DECIMAL_COMMA.fullmatch(text):
        return f"{comma[1]}.{comma[2]}{comma[3]}"
    joined = _UNDERSCORES.sub("", text)
    if grouped := _GROUPED.fullmatch(joined):
        joined = re.sub(r"\s", "", grouped[1]) + grouped[2]
    return joined if joined != text and (is_number(joined) or parse_quantity(joined)) else None


def numbers_of_row(node: YamlScalar) -> Sequence[str]:
    """Return the numbers of a text that has several, with spaces or commas between them; () for any other text."""
    if not isinstance(node.value, str) or _DECIMAL_COMMA.fullmatch(node.text):
        return ()
    numbers: list[str] = []
    for word in re.split(r"[\s,]+", node.text.strip()):
        if (is_number(word) and not _ZEROS_FIRST.fullmatch(word)) or parse_quantity(word):
            numbers.append(word)
        elif numbers and is_number(numbers[-1]) and parse_quantity(f"{numbers[-1]} {word}"):
            numbers[-1] += f" {word}"
        else:
            return ()
    return numbers


def is_row(node: YamlNode) -> bool:
    """Whether it is text of several numbers with spaces or commas between them, but no decimal comma."""
    return isinstance(node, YamlScalar) and len(numbers_of_row(node)) > 1


def with_points(node: YamlList) -> list[str]:
    """Return the items of a list, two as one where they were meant so: `1,5 mm`, without a space behind the comma."""
    items: list[str] = []
    before: YamlNode | None = None
    for item in node:
        is_stuck = before is not None and before.span.end == (item.span.line, item.span.column - 1)
        if is_stuck and re.fullmatch(r"[+-]?\d+", items[-1]) and number_meant(f"{items[-1]},{shown(item)}"):
            items[-1] = f"{items[-1]}.{shown(item)}"
        else:
            items.append(shown(item))
        before = item
    return items
