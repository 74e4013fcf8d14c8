"""Split a YAML text into pieces, which stay as they are written, and the white space and comments between them."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import yaml
from yaml import tokens
from yaml.tokens import Token

from linkforge_compile.syntax.parser import Parser

LINE_BREAK = re.compile(r"\r\n|\r|\n")

_LAST_BREAK = re.compile(r"(?:\r\n|\r|\n)\Z")


class UnsafeError(Exception):
    """The text has something between its tokens that is neither white space nor a comment."""


class Comment(NamedTuple):
    """A comment, on a line of its own or after other text; lines and columns count from 0."""

    text: str
    line: int
    column: int
    is_own_line: bool


class Gap(NamedTuple):
    """What is between two pieces: comments, and None for each blank line.

    `spaces` is their number where the pieces are on one line and only spaces are between them, else None.
    """

    lines: tuple[Comment | None, ...]
    has_break: bool
    spaces: int | None


class Piece(NamedTuple):
    """A token that has text, with the gap before it; lines and columns count from 0.

    `closes` is how many lists and maps in block style end before it, `opens` has the tokens of those that begin with
    it. `is_key` is whether it begins a key without a question mark; `end_column` is that after its last character. The
    last piece of a text is its end.
    """

    token: Token
    text: str
    gap: Gap
    line: int
    column: int
    end_column: int
    is_key: bool
    closes: int
    opens: tuple[Token, ...]

    @property
    def has_breaks(self) -> bool:
        """Whether it continues on further lines."""
        return len(self.text) != self.end_column - self.column

    @property
    def is_block_scalar(self) -> bool:
        return isinstance(self.token, tokens.ScalarToken) and self.token.style in {"|", ">"}


def scan(text: str, parser: Parser) -> list[Token]:
    """Return the tokens of a text; yaml.YAMLError if it is not YAML."""
    return list(yaml.scan(text, Loader=parser))


def split(text: str, scanned: Iterable[Token]) -> Iterator[Piece]:
    """Yield the pieces of a text and its end; UnsafeError if there is other text between them."""
    starts = [0, *(found.end() for found in LINE_BREAK.finditer(text))]
    last, is_key, closes, opens = 0, False, 0, list[Token]()
    for token in scanned:
        begin, end = _ends(token, text)
        match token:
            case tokens.StreamStartToken():
                continue
            case tokens.BlockEndToken():
                closes += 1
                continue
            case tokens.BlockMappingStartToken() | tokens.BlockSequenceStartToken():
                opens.append(token)
                continue
            case tokens.KeyToken() if begin == end:
                is_key = True
                continue
            case tokens.StreamEndToken():
                begin = end = len(text)
        line, end_line = _line(starts, begin), _line(starts, max(begin, end - 1))
        columns = begin - starts[line], end - starts[end_line]
        gap = _gap(text, last, begin, starts)
        yield Piece(token, text[begin:end], gap, line, *columns, is_key, closes, tuple(opens))
        last, is_key, closes, opens = end, False, 0, []


def _line(starts: Sequence[int], index: int) -> int:
    return bisect_right(starts, index) - 1


def _ends(token: Token, text: str) -> tuple[int, int]:
    """Return the first index of a token and the index after it."""
    begin, end = token.start_mark.index, min(token.end_mark.index, len(text))
    if isinstance(token, tokens.ScalarToken) and token.style in {"|", ">"}:
        # Blank lines at the end may be content. The line break before the next piece belongs to the gap.
        last_break = _LAST_BREAK.search(text, begin, end)
        return begin, last_break.start() if last_break else end
    return begin, begin + len(text[begin:end].rstrip())


def _gap(text: str, begin: int, end: int, starts: Sequence[int]) -> Gap:
    """Return the gap between two indexes; `starts` are those of the lines."""
    between = text[begin:end]
    first, *others = LINE_BREAK.split(between)
    if not others and "#" not in first:
        if first.strip():
            raise UnsafeError
        return Gap((), has_break=False, spaces=len(first) if not first.strip(" ") else None)
    line = _line(starts, begin)
    lines = [_comment(first, line, begin - starts[line], is_own_line=begin == 0)]
    lines += [_comment(other, line + number, 0, is_own_line=True) for number, other in enumerate(others, start=1)]
    # The first is the end of the last piece's line and the last the indentation of the next piece.
    blank_start, blank_end = lines[0] is None, len(lines) > 1 and lines[-1] is None
    return Gap(tuple(lines[blank_start : len(lines) - blank_end]), has_break=True, spaces=None)


def _comment(part: str, line: int, column: int, *, is_own_line: bool) -> Comment | None:
    """Return the comment in a part of a line that begins at a column, None if it is blank."""
    text = part.strip()
    if not text:
        return None
    if not text.startswith("#"):
        raise UnsafeError
    return Comment(text, line, column + len(part) - len(part.lstrip()), is_own_line)


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
