"""Keep the spaces that align columns on adjacent lines, such as those of a table of numbers."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

from linkforge_compile.formatter.pieces import Piece


def spaces_before(pieces: Sequence[Piece], normal: Sequence[int]) -> list[int]:
    """Return how many spaces are before each piece: the normal ones, or more where they make a column.

    The pieces of a column begin, or end, below one another on adjacent lines, after the same kind of token, at least
    one of them after the normal spaces.
    """
    columns = defaultdict[tuple[object, ...], dict[int, int]](dict)
    for number, (before, piece) in enumerate(pairwise(pieces), start=1):
        if piece.gap.spaces is not None and not piece.has_breaks:
            columns["begin", piece.column, type(before.token)][piece.line] = number
            columns["end", piece.end_column, type(before.token)][piece.line] = number
    spaces = list(normal)
    for column in columns.values():
        for run in _runs(list(column)):
            written = {column[line]: pieces[column[line]].gap.spaces or 0 for line in run}
            if any(count == normal[number] for number, count in written.items()):
                for number, count in written.items():
                    spaces[number] = max(normal[number], count)
    return spaces


def _runs(lines: Sequence[int]) -> Iterator[list[int]]:
    """Yield the runs of adjacent lines."""
    run = list(lines[:1])
    for above, below in pairwise(lines):
        if below != above + 1:
            yield run
            run = []
        run.append(below)
    yield run
