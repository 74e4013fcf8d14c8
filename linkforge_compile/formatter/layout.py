"""Lay out the pieces of a YAML text: indentation by two spaces, one space between them, comments where they are."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from yaml import tokens

from linkforge_compile.formatter.pieces import (
    INDENT,
    Comment,
    Indents,
    Piece,
    block_scalar_lines,
    folded_lines,
    keeps_blank_lines,
)


def spaces_before(pieces: Sequence[Piece], normal: Sequence[int]) -> list[int]:
    """Return how many spaces are before each piece: the normal ones, or more where they make a column.

    The pieces of a column are on adjacent lines, at least one of them after the normal spaces.
    """
    columns = defaultdict[tuple[object, ...], dict[int, int]](dict)
    for number, (before, piece) in enumerate(pairwise(pieces), start=1):
        if piece.gap.spaces is not None and not piece.has_breaks:
            for column in _columns(before, piece):
                columns[column][piece.line] = number
    spaces = list(normal)
    for numbers in columns.values():
        for run in _runs(list(numbers)):
            written = {numbers[line]: pieces[numbers[line]].gap.spaces or 0 for line in run}
            if any(count == normal[number] for number, count in written.items()):
                for number, count in written.items():
                    spaces[number] = max(normal[number], count)
    return spaces


def _columns(before: Piece, piece: Piece) -> Iterator[tuple[object, ...]]:
    """Yield the columns that a piece may be in; pieces of a column have the same one."""
    if isinstance(before.token, (tokens.ValueToken, tokens.FlowEntryToken)):
        yield "begin", type(before.token), piece.column
        yield "end", type(before.token), piece.end_column
    # Numbers with and without a sign.
    if isinstance(before.token, tokens.FlowSequenceStartToken) and isinstance(piece.token, tokens.ScalarToken):
        yield "end", before.column, piece.end_column


def _runs(lines: Sequence[int]) -> Iterator[list[int]]:
    """Yield the runs of adjacent lines."""
    run = list(lines[:1])
    for above, below in pairwise(lines):
        if below != above + 1:
            yield run
            run = []
        run.append(below)
    yield run


_BEFORE_COMMENT = 2
"""The fewest spaces between other text and a comment."""

_COMMENT_COLUMN = 5
"""With as many spaces before it, a comment is in a column with those of other lines."""

_OPENING = (tokens.FlowSequenceStartToken, tokens.FlowMappingStartToken)
_CLOSING = (tokens.FlowSequenceEndToken, tokens.FlowMappingEndToken)
_DOCUMENT = (tokens.DocumentStartToken, tokens.DocumentEndToken, tokens.DirectiveToken)
_BLOCK_INDICATORS = (tokens.BlockEntryToken, tokens.KeyToken, tokens.ValueToken)


def lay_out(pieces: Sequence[Piece]) -> str:
    """Return the text of the pieces with their comments; its lines end with LF."""
    layout = _Layout(pieces)
    for number in range(len(pieces) - 1):
        layout.add(number)
    return layout.end()


def _normal_spaces(before: Piece, piece: Piece) -> int:
    """Return how many spaces are between two pieces on one line."""
    first, second = before.token, piece.token
    if isinstance(first, _OPENING):
        return 0
    # `velocity:}` is no YAML for libyaml, and an alias or tag would go on with `:`.
    ends_value = isinstance(first, (tokens.ScalarToken, *_CLOSING))
    if isinstance(second, tokens.ValueToken):
        return 0 if ends_value else 1
    if isinstance(second, (tokens.FlowEntryToken, *_CLOSING)):
        return 0 if ends_value or isinstance(first, (tokens.AliasToken, tokens.FlowEntryToken)) else 1
    return 1


class _Level(NamedTuple):
    """A list or map in block style: the columns of its entries before and after, and the level around it.

    `is_indentless` is whether it is a list whose dashes are at the column of its key.
    """

    old: int
    new: int
    outer: _Level | None
    is_map: bool
    is_indentless: bool = False


class _Bracket(NamedTuple):
    """An open list or map in brackets: the columns of its items and of its closing bracket on lines of their own."""

    items: int
    closing: int


class _Layout:
    """Adds pieces to a text in their order."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self._pieces = pieces
        self._spaces = spaces_before(pieces, [0, *(_normal_spaces(*pair) for pair in pairwise(pieces))])
        self._after_text = {
            (comment.line, comment.column)
            for piece in pieces
            for comment in piece.gap.lines
            if comment and not comment.is_own_line
        }
        self._lines: list[str] = []
        self._level: _Level | None = None
        self._brackets: list[_Bracket] = []
        self._shift = 0  # by how many columns the beginning of the line moves
        self._comments: dict[tuple[int, int], int] = {}  # the new columns of comments by their old places

    def end(self) -> str:
        """Add what follows the last piece but the end, and return the text."""
        number = len(self._pieces) - 1
        last, end = self._pieces[number - 1], self._pieces[number]
        self._add_comments(number, self._level, 0)
        if not keeps_blank_lines(last) or end.gap.lines:
            while self._lines and not self._lines[-1]:
                self._lines.pop()
        # A last line break more would change a block scalar that lacks it.
        is_cut = last.is_block_scalar and not end.gap.has_break
        return "\n".join(self._lines) + ("" if is_cut or not self._lines else "\n")

    def add(self, number: int) -> None:
        """Add a piece and the gap before it."""
        piece, before = self._pieces[number], self._level
        self._leave_levels(piece)
        is_first = piece.gap.has_break or number == 0
        if is_first:
            column = self._first_column(number)
            self._add_comments(number, before, column)
            self._shift = column - piece.column
            self._lines.append(" " * column)
        else:
            self._lines[-1] += " " * self._spaces[number]
            column = len(self._lines[-1])
        self._enter(number, column)
        first, *others = self._text_of(piece, column)
        self._lines[-1] += first
        self._lines += others

    def _leave_levels(self, piece: Piece) -> None:
        """Leave the lists and maps in block style that end before a piece."""
        for _ in range(piece.closes):
            while self._level and self._level.is_indentless:
                self._level = self._level.outer
            self._level = self._level.outer if self._level else None
        is_of_map = piece.is_key or isinstance(piece.token, (tokens.KeyToken, tokens.ValueToken))
        if self._level and self._level.is_indentless and is_of_map and not piece.opens and not self._brackets:
            self._level = self._level.outer

    @property
    def _below(self) -> int:
        """The column of what is below the entries of the level."""
        return self._level.new + INDENT if self._level else 0

    def _begins_indentless(self, piece: Piece) -> bool:
        is_dash = isinstance(piece.token, tokens.BlockEntryToken) and not piece.opens
        return is_dash and self._level is not None and self._level.is_map

    def _first_column(self, number: int) -> int:
        """Return the column of a piece that is the first on its line."""
        piece = self._pieces[number]
        if self._brackets:
            if isinstance(piece.token, _CLOSING):
                return self._brackets[-1].closing
            is_value = isinstance(self._pieces[number - 1].token, tokens.ValueToken)
            return self._brackets[-1].items + (INDENT if is_value else 0)
        if isinstance(piece.token, _DOCUMENT):
            return 0
        is_entry = piece.is_key or isinstance(piece.token, _BLOCK_INDICATORS)
        if self._level and is_entry and not piece.opens and not self._begins_indentless(piece):
            return self._level.new
        return self._below

    def _enter(self, number: int, column: int) -> None:
        """Enter the lists and maps that begin with a piece, and leave the brackets that it closes."""
        piece = self._pieces[number]
        if self._begins_indentless(piece):
            self._level = _Level(piece.column, column, self._level, is_map=False, is_indentless=True)
        for token in piece.opens:
            is_map = isinstance(token, tokens.BlockMappingStartToken)
            self._level = _Level(token.start_mark.column, column, self._level, is_map)
        if isinstance(piece.token, _CLOSING):
            self._brackets.pop()
        elif isinstance(piece.token, _OPENING):
            self._brackets.append(self._bracket(column, ends_line=self._pieces[number + 1].gap.has_break))

    def _bracket(self, column: int, *, ends_line: bool) -> _Bracket:
        """Return the columns of the lines inside a bracket at a column, which may be the last piece of its line."""
        if not ends_line:
            return _Bracket(column + 1, column)
        line = self._lines[-1]
        beginning = len(line) - len(line.lstrip(" "))
        # YAML requires more indentation than that of the block around them; parsers exempt only the last bracket.
        least = self._below if self._brackets else self._below - INDENT
        base = max(beginning, least, 0)
        return _Bracket(base + INDENT, base)

    def _text_of(self, piece: Piece, column: int) -> list[str]:
        """Return the lines of a piece, the first without its indentation."""
        if not piece.has_breaks:
            return [piece.text]
        if piece.is_block_scalar:
            around = Indents(max(0, self._level.old), self._level.new) if self._level else Indents(0, 0)
            return block_scalar_lines(piece, around)
        return folded_lines(piece, column, self._shift, self._below)

    def _add_comments(self, number: int, before: _Level | None, column: int) -> None:
        """Add the comments before a piece, which moves to a column; `before` is the level after the last piece.

        Of several blank lines one stays, and none at the beginning.
        """
        for comment in self._pieces[number].gap.lines:
            if comment is None:
                if self._lines and self._lines[-1]:
                    self._lines.append("")
                continue
            if comment.is_own_line:
                new = self._column_of_line(comment, number, before, column)
                self._lines.append(" " * new + comment.text)
            else:
                new = self._column_after_text(comment, self._pieces[number - 1])
                self._lines[-1] = self._lines[-1].ljust(new) + comment.text
            self._comments[comment.line, comment.column] = new

    def _column_after_text(self, comment: Comment, piece: Piece) -> int:
        """Return the column of a comment after a piece: the same one, if it may be aligned with others."""
        end, spaces = len(self._lines[-1]), comment.column - piece.end_column
        is_aligned = any((comment.line + step, comment.column) in self._after_text for step in (-1, 1))
        if is_aligned or spaces >= _COMMENT_COLUMN:
            return max(comment.column, end + _BEFORE_COMMENT)
        return end + max(spaces, _BEFORE_COMMENT)

    def _column_of_line(self, comment: Comment, number: int, before: _Level | None, column: int) -> int:
        """Return the column of a comment on a line of its own: that of what it is aligned with."""
        if (above := (comment.line - 1, comment.column)) in self._comments:
            return self._comments[above]
        if self._brackets:
            return self._brackets[-1].items
        if comment.column == self._pieces[number].column:
            return column
        level = before
        while level and level.old > comment.column:
            level = level.outer
        if level is None or level.old == comment.column:
            return level.new if level else 0
        last = self._pieces[number - 1]
        if isinstance(last.token, _BLOCK_INDICATORS) and level is before:
            return level.new + INDENT
        # More indented, it would be part of a block scalar.
        return level.new if last.is_block_scalar else level.new + comment.column - level.old
