"""Read a table of values, a CSV or Parquet file, whose columns are parameters and whose rows are points."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import SET_TWICE, UNKNOWN_PARAMETER
from linkforge_compile.expand.arguments import names_in_variant
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import UnreadableError, text_of
from linkforge_compile.sweep.axes import VARIANT, Axis
from linkforge_compile.sweep.cells import Cell, cells_of, value_text
from linkforge_compile.sweep.declared import Declared, untyped, value_of
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.rows import reserved_columns
from linkforge_compile.sweep.wording import Wording

_MAX_FAULTS = 20
"""How many wrong values of a table are reported; the rest are likely of the same kind."""


def read_values(
    path: Path, declared: Declared, sink: Diagnostics, words: Wording
) -> tuple[Axis, Mapping[str, Parameter]]:
    """Return the rows of a table as one axis, and the parameters of its columns.

    The column `variant` selects variants, unless a parameter has that name. Values are texts as in `-p`, or the
    numbers of a Parquet file in SI units; an empty cell leaves the default. Of the table of a sweep, only the columns
    of parameters and variants count. Unknown columns and wrong values are reported at their line.
    """
    option = words.option("values")
    header, rows = _header(path, option)
    is_own = reserved_columns() - {"variant"} <= {cell.text for cell in header}
    known = {*declared.parameters, *(["variant"] if declared.variants else [])}
    chosen = [at for at, cell in enumerate(header) if not is_own or cell.text in known]
    if not chosen:
        raise SweepError(f"{option} {path}: the table of a sweep, whose parameters are not those of this spec")
    names = tuple(_name_of(header[at], declared, sink) for at in chosen)
    for number, at in enumerate(chosen):
        if header[at].text in [header[one].text for one in chosen[:number]]:
            sink.report(SET_TWICE.at(header[at].span, name=header[at].text, notes=()))
    body = _body(path, option, header, rows, sink)
    parameters: dict[str, Parameter] = {}
    for at, name in zip(chosen, names, strict=True):
        column = [row[at] for row in body if row[at].text]
        if name in declared.parameters:
            texts = [cell.text for cell in column]
            parameters[name] = declared.parameters[name] or untyped(name, texts, header[at].span)
            _check(column, parameters[name], sink)
        elif name == VARIANT:
            _check_variants(column, declared)
    return Axis(names, [tuple(row[at].text for at in chosen) for row in body]), parameters


def _header(path: Path, option: str) -> tuple[list[Cell], Iterator[list[Cell]]]:
    """Return the names of the columns, and the rows below; SweepError for a file that is not such a table."""
    if str(path) == "-" or path.is_fifo():
        raise SweepError(f"{option} takes a file, not standard input or a pipe: it is read several times")
    rows = _parquet_rows(path, option) if path.suffix == ".parquet" else _csv_rows(path, option)
    header = next(rows, [])
    if not header:
        raise SweepError(f"{option} {path}: the file has no columns")
    if len(header) == 1 and (found := next((one for one in (";", "\t") if one in header[0].text), None)):
        shown = "tabs" if found == "\t" else f"'{found}'"
        raise SweepError(f"{option} {path}: the columns are separated by {shown}; write commas, and decimal points")
    return header, rows


def _body(
    path: Path, option: str, header: list[Cell], rows: Iterator[list[Cell]], sink: Diagnostics
) -> list[list[Cell]]:
    """Return the rows of a table; SweepError, with what is wrong with the header, for rows that are not of one."""
    body = [row for row in rows if row]
    if short := next((row for row in body if len(row) != len(header)), None):
        expected = f"{len(header)} value{'' if len(header) == 1 else 's'}"
        text = f"{short[0].span}: expected {expected}, as the first line has, found {len(short)}"
        raise SweepError(text, sink.sorted())
    if not body:
        raise SweepError(
            f"{option} {path}: the table has no rows; the first line has names, the others values", sink.sorted()
        )
    return body


def _check(column: list[Cell], parameter: Parameter, sink: Diagnostics) -> None:
    faults = 0
    for cell in column:
        faults += value_of(cell.text, cell.span, parameter, sink) is None
        if faults >= _MAX_FAULTS:
            return


def _check_variants(column: list[Cell], declared: Declared) -> None:
    for cell in column:
        for name in names_in_variant(cell.text, declared.variants):
            if name not in declared.variants:
                raise SweepError(f"{cell.span}: there is no variant '{name}'")


def _name_of(cell: Cell, declared: Declared, sink: Diagnostics) -> str:
    if cell.text == "variant" and cell.text not in declared.parameters and declared.variants:
        return VARIANT
    if cell.text not in declared.parameters:
        sink.report(UNKNOWN_PARAMETER.at(cell.span, name=cell.text, near=declared.parameters, notes=()))
    return cell.text


def _csv_rows(path: Path, option: str) -> Iterator[list[Cell]]:
    """Yield the cells of each row; a mark of the byte order, which spreadsheets write, is none of the first cell."""
    try:
        text = text_of(path.read_bytes()).removeprefix("\ufeff")
    except OSError as error:
        raise SweepError(f"{option} {path}: {error.strerror}") from error
    except UnreadableError as error:
        raise SweepError(
            f"{option} {path} cannot be read: {error}; the name of a Parquet file ends in .parquet"
        ) from error
    file, lines = SourceFile(str(path), text, path), list(io.StringIO(text, newline=""))
    reader, line = csv.reader(lines, strict=True), 1
    try:
        for row in reader:
            yield cells_of(row, lines[line - 1].rstrip("\r\n"), file, line, 1)
            line = reader.line_num + 1
    except csv.Error as error:
        raise SweepError(f"{path}:{reader.line_num}: cannot be read as CSV: {error}") from error


def _parquet_rows(path: Path, option: str) -> Iterator[list[Cell]]:
    """Yield the cells of each row; line 1 is the names of the columns, as in a CSV."""
    from linkforge_compile.sweep.arrow import parquet

    try:
        table = parquet().read_table(path)
    except FileNotFoundError as error:
        raise SweepError(f"{option} {path}: No such file or directory") from error
    except (OSError, ValueError) as error:  # pyarrow's errors are ValueErrors
        raise SweepError(f"{option} {path} cannot be read as Parquet: {error}") from error
    columns = [column.to_pylist() for column in table.columns]
    shown = [
        table.column_names,
        *(["" if value is None else value_text(value) for value in row] for row in zip(*columns, strict=True)),
    ]
    file = SourceFile(str(path), "\n".join(",".join(row) for row in shown), path)
    for line, row in enumerate(shown, 1):
        yield cells_of(row, ",".join(row), file, line, 1)
