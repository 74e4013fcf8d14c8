"""Indent the further lines of texts over several lines, whose values stay the same."""

from __future__ import annotations

import re
from typing import NamedTuple

from yaml import tokens

from linkforge_compile.formatter.pieces import LINE_BREAK, Piece

INDENT = 2
"""The spaces of a level."""

_HEADER = re.compile(r"[|>](?:[+-]?(?P<indent>\d))?")
_KEEPS = re.compile(r"[|>]\d?\+")


class Indents(NamedTuple):
    """The indentation of the list or map in block style around a text, before and after; at the top it is 0."""

    old: int
    new: int


def keeps_blank_lines(piece: Piece) -> bool:
    """Whether a piece is a block scalar whose value has the blank lines at its end."""
    return piece.is_block_scalar and _KEEPS.match(piece.text) is not None


def block_scalar_lines(piece: Piece, around: Indents) -> list[str]:
    """Return the lines of a text that begins with `|` or `>`, indented by one level more than what is around it."""
    header, *content = LINE_BREAK.split(piece.text)
    found = _HEADER.match(header)
    if found and found["indent"]:
        old, new = (indent + int(found["indent"]) for indent in around)
    else:
        old, new = _indent_of(content), around.new + INDENT
    lines = [" " * new + line[old:] if line.strip(" ") or len(line) > old else "" for line in content]
    if not keeps_blank_lines(piece):
        while lines[-2:] == ["", ""]:
            lines.pop()
    return [header.rstrip(), *lines]


def _indent_of(content: list[str]) -> int:
    """Return the indentation of the first line that is not blank; of lines that all are, that of the longest."""
    indents = (len(line) - len(line.lstrip(" ")) for line in content if line.strip(" "))
    return next(indents, max(map(len, content), default=0))


def folded_lines(piece: Piece, column: int, line_shift: int, least: int) -> list[str]:
    """Return the lines of a text with or without quotes, whose white space at line breaks is not part of its value.

    The lines move with what they are aligned with: the text, which moves to `column`, or else the beginning of its
    line, which moves by `line_shift`. They begin at the column `least` or after it.
    """
    first, *others = LINE_BREAK.split(piece.text)
    lines = [_without_blanks_at_end(first, piece)]
    for line in others:
        text = line.lstrip()
        old = len(line) - len(text)
        shift = column - piece.column if old >= piece.column else line_shift
        lines.append(" " * max(old + shift, least) + _without_blanks_at_end(text, piece) if text else "")
    return lines


def _without_blanks_at_end(line: str, piece: Piece) -> str:
    text = line.rstrip()
    # In double quotes, an escaped blank is part of the value.
    is_escaped = isinstance(piece.token, tokens.ScalarToken) and piece.token.style == '"' and text.endswith("\\")
    return line if is_escaped else text
