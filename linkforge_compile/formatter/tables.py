"""Keep the spaces that align columns on adjacent lines, such as those of a table of numbers."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

from yaml import tokens

from linkforge_compile.formatter.pieces import Piece


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
