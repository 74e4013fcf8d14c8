"""Numbers that YAML reads as text: with decimal commas, underscores, spaces, or several in a row."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence

from linkforge_compile.schema.json_schema import Schema, branches
from linkforge_compile.schema.shapes import is_number, is_text
from linkforge_compile.syntax.nodes import YamlNode, YamlScalar
from linkforge_compile.units import parse_quantity

_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(\s*[^\d\s,]\S*|)")
_UNDERSCORES = re.compile(r"(?<=[0-9a-fA-F])_+(?=[0-9a-fA-F])")
"""Skipped between digits by YAML 1.1 and Python, but not by YAML 1.2."""
_GROUPED = re.compile(r"([+-]?\d{1,3}(?:(?:\s\d{3})+|(?:,\d{3}){2,}))(?!\d)(.*)")
"""A number whose thousands are separated by spaces or by several commas, and the text after it."""
_THOUSANDS_COMMA = re.compile(r"([+-]?[1-9]\d{0,2}),(\d{3})(\s*[^\d\s,]\S*|)")
"""A number whose only comma may separate thousands."""
_MINUS_SIGNS = ("\u2212", "\u2013", "\u2014")
"""What word processors write for the hyphen before a number."""
_LEADING_ZERO = re.compile(r"0\d+")
MOST_ITEMS = 100
"""The longest list that a hint writes anew."""
_LONGEST_ROW = 2000
"""The longest text, in characters, in which several numbers are looked for."""
_ANY_LENGTH = range(2, sys.maxsize)


def corrected_number(text: str) -> str | None:
    """Return a number, with its unit if it has one, as the language writes it; None for any other text."""
    if text[:1] in _MINUS_SIGNS:
        text = f"-{text[1:]}"
        return text if is_number(text) or parse_quantity(text) else corrected_number(text)
    if comma := _DECIMAL_COMMA.fullmatch(text):
        return f"{comma[1]}.{comma[2]}{comma[3]}"
    joined = _UNDERSCORES.sub("", text)
    if grouped := _GROUPED.fullmatch(joined):
        joined = re.sub(r"[\s,]", "", grouped[1]) + grouped[2]
    return joined if joined != text and (is_number(joined) or parse_quantity(joined)) else None


def numbers_with_comma(text: str) -> tuple[str, ...]:
    """Return what a number with a comma may be, the decimal one first; () for any other text."""
    corrected, thousands = corrected_number(text), _THOUSANDS_COMMA.fullmatch(text)
    return tuple(each for each in (corrected, "".join(thousands.groups()) if thousands else None) if each)


def number_hint(text: str, unit: str | None) -> str:
    """Return what to write for a number, both readings of `1,500`; "" for any other text.

    `unit` is the SI unit of the field: a number of another dimension gets no hint; None for any dimension.
    """
    corrected = corrected_number(text)
    quantity = parse_quantity(corrected) if corrected else None
    if corrected is None or (unit and quantity and quantity.dimension.si_unit != unit):
        return ""
    if thousands := _THOUSANDS_COMMA.fullmatch(text):
        return f"'{corrected}', or '{''.join(thousands.groups())}' if the comma separates thousands"
    return f"'{corrected}'"


def numbers_in_row(text: str, lengths: Sequence[range] = (_ANY_LENGTH,)) -> Sequence[str]:
    """Return the numbers of a text that has several, separated by spaces or commas; () for other text.

    `lengths` are the allowed counts. Commas between spaces are decimal commas if the count is then right.
    """
    if len(text) > _LONGEST_ROW or _DECIMAL_COMMA.fullmatch(text):
        return ()
    spaced = [word.strip(",") for word in text.split()]
    rows = (_numbers(words) for words in (spaced, re.split(r"[\s,]+", text.strip())))
    return next((row for row in rows if len(row) > 1 and any(len(row) in length for length in lengths)), ())


def list_lengths(schema: Schema) -> list[range]:
    """Return the allowed lengths of the lists that a schema accepts."""
    lists = (branch for branch in branches(schema) if "items" in branch)
    bounds = [(each.get("minItems", 2), each.get("maxItems", MOST_ITEMS)) for each in lists]
    return [range(least, most + 1) for least, most in bounds if isinstance(least, int) and isinstance(most, int)]


def _numbers(words: Sequence[str]) -> Sequence[str]:
    """Return words as numbers, a unit after a number as part of it; () if one word is neither."""
    numbers: list[str] = []
    for word in words:
        if (is_number(word) and not _LEADING_ZERO.fullmatch(word)) or parse_quantity(word):
            numbers.append(word)
        elif numbers and is_number(numbers[-1]) and parse_quantity(f"{numbers[-1]} {word}"):
            numbers[-1] += f" {word}"
        elif corrected := corrected_number(word):
            numbers.append(corrected)
        else:
            return ()
    return numbers


def is_row(node: YamlNode) -> bool:
    """Whether a node is text of several numbers."""
    return isinstance(node, YamlScalar) and is_text(node) and bool(numbers_in_row(node.text))
