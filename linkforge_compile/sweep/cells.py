"""Values as texts: those of Python and Parquet, and the cells of a line by the rules of CSV, with their places."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.source import SourceFile, Span
from linkforge_compile.units import number_text


class Cell(NamedTuple):
    """A text and its place."""

    text: str
    span: Span


def value_text(value: object) -> str:
    """Return a value as `-p` has it: numbers without loss, lists and maps in the flow style of YAML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple | Mapping):
        return json.dumps(value, ensure_ascii=False)
    return number_text(value) if isinstance(value, int | float) else str(value)


def cells_of(row: Sequence[str], written: str, file: SourceFile, line: int, column: int) -> list[Cell]:
    """Return the cells that a CSV reader found in `written`, which begins at a line and column of the file.

    The place of a cell is exact in text without quotes; otherwise it is the whole text.
    """
    is_plain, cells = ",".join(row) == written, []
    for item in row:
        width = len(item if is_plain else written)
        cells.append(Cell(item.strip(), Span(file, line, column, line, column + width)))
        column += width + 1 if is_plain else 0
    return cells
