"""Read a table of values, a CSV or Parquet file, whose columns are parameters and whose rows are points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import SET_TWICE, UNKNOWN_PARAMETER
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import UnreadableError, text_of
from linkforge_compile.sweep.axes import VARIANT, Axis
from linkforge_compile.sweep.declared import Declared, untyped, value_of
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.units import number_text

_MAX_FAULTS = 20
"""How many wrong values of a table are reported; the rest are likely of the same kind."""


class _Cell(NamedTuple):
    text: str
    span: Span


def read_values(path: Path, declared: Declared, sink: Diagnostics) -> tuple[Axis, Mapping[str, Parameter]]:
    """Return the rows of a table as one axis, and the parameters of its columns.

    The column `variant` selects variants, unless a parameter has that name. Values are texts as in `-p`, or the
    numbers of a Parquet file in SI units. Unknown columns and wrong values are reported at their line.
    """
    rows = _parquet_rows(path) if path.suffix == ".parquet" else _csv_rows(path)
    header = next(rows, [])
    if not header:
        raise SweepError(f"--values {path}: the file has no columns")
    names = [_name_of(cell, declared, sink) for cell in header]
    for at, cell in enumerate(header):
        if cell.text in [one.text for one in header[:at]]:
            sink.report(SET_TWICE.at(cell.span, name=cell.text, notes=()))
    body = [row for row in rows if row]
    if short := next((row for row in body if len(row) != len(header)), None):
        raise SweepError(f"{short[0].span}: expected {len(header)} values, as the first line has, found {len(short)}")
    if not body:
        raise SweepError(f"--values {path}: the table has no rows")
    parameters: dict[str, Parameter] = {}
    for at, name in enumerate(names):
        if name in declared.parameters:
            column = [row[at] for row in body]
            texts = [cell.text for cell in column]
            parameters[name] = declared.parameters[name] or untyped(name, texts, header[at].span)
            _check(column, parameters[name], sink)
        elif name == VARIANT:
            _check_variants([row[at] for row in body], declared)
    return Axis(tuple(names), [tuple(cell.text for cell in row) for row in body]), parameters


def _check(column: list[_Cell], parameter: Parameter, sink: Diagnostics) -> None:
    faults = 0
    for cell in column:
        faults += value_of(cell.text, cell.span, parameter, sink) is None
        if faults >= _MAX_FAULTS:
            return


def _check_variants(column: list[_Cell], declared: Declared) -> None:
    for cell in column:
        if unknown := [one for one in cell.text.split("+") if one not in declared.variants]:
            raise SweepError(f"{cell.span}: there is no variant '{unknown[0]}'")


def _name_of(cell: _Cell, declared: Declared, sink: Diagnostics) -> str:
    if cell.text == "variant" and cell.text not in declared.parameters and declared.variants:
        return VARIANT
    if cell.text not in declared.parameters:
        sink.report(UNKNOWN_PARAMETER.at(cell.span, name=cell.text, near=declared.parameters, notes=()))
    return cell.text


def _csv_rows(path: Path) -> Iterator[list[_Cell]]:
    """Yield the cells of each line; the place of a cell is exact for lines without quotes, else its line."""
    import csv

    try:
        text = text_of(path.read_bytes())
    except OSError as error:
        raise SweepError(f"--values {path}: {error.strerror}") from error
    except UnreadableError as error:
        raise SweepError(f"--values {path} cannot be read: {error}") from error
    file, lines = SourceFile(str(path), text, path), text.splitlines()
    reader = csv.reader(lines)
    line = 1
    for row in reader:
        written, column, cells = lines[line - 1], 1, []
        is_plain = ",".join(row) == written
        for item in row:
            width = len(item) if is_plain else len(written)
            cells.append(_Cell(item.strip(), Span(file, line, column, line, column + width)))
            column += width + 1 if is_plain else 0
        yield cells
        line = reader.line_num + 1


def _parquet_rows(path: Path) -> Iterator[list[_Cell]]:
    """Yield the cells of each row; line 1 is the names of the columns, as in a CSV."""
    from linkforge_compile.sweep.arrow import parquet

    try:
        table = parquet().read_table(path)
    except (OSError, ValueError) as error:  # pyarrow's errors are ValueErrors
        raise SweepError(f"--values {path}: {error}") from error
    columns = [column.to_pylist() for column in table.columns]
    shown = [table.column_names, *([_text(value) for value in row] for row in zip(*columns, strict=True))]
    file = SourceFile(str(path), "\n".join(",".join(row) for row in shown), path)
    for line, row in enumerate(shown, 1):
        column, cells = 1, []
        for item in row:
            cells.append(_Cell(item, Span(file, line, column, line, column + len(item))))
            column += len(item) + 1
        yield cells


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return number_text(value) if isinstance(value, int | float) else "" if value is None else str(value)
