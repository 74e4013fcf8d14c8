"""The folder of a sweep: robots, the table, and the manifest by which an interrupted sweep goes on.

A chunk is there once its part of the table is, which is written last and in one step. The finished table replaces the
parts.
"""

from __future__ import annotations

import io
import json
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from linkforge_compile.atomic_file import write_atomically
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.sweep.arrow import arrow, parquet
from linkforge_compile.sweep.cells import value_text
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.manifest import differences, with_files
from linkforge_compile.sweep.rows import COUNTS, FIGURES, TEXTS, Cell, Row
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.sweep.work import Made
from linkforge_compile.units import Dimension

TABLE, MANIFEST, ROBOTS, PARTS = "table.parquet", "sweep.json", "robots", ".parts"

PACKINGS = ("folders", "tar", "zip", "none")
"""How robots are written: a folder each, an archive a chunk, or not at all."""

_ROWS = 5_000
"""How many rows of the table are in memory at once."""


class Chunk(NamedTuple):
    """The points from `begin` up to, and without, `end`."""

    begin: int
    end: int


def chunks_of(count: int, size: int) -> Iterator[Chunk]:
    """Yield ranges of `size` points that cover `count`."""
    return (Chunk(begin, min(begin + size, count)) for begin in range(0, count, size))


class Store:
    """The folder of one sweep."""

    def __init__(self, folder: Path, packing: str, columns: Mapping[str, Parameter], *, has_variants: bool) -> None:
        self.folder, self._packing = folder, packing
        self._schema = schema_of(columns, has_variants=has_variants)
        self._manifest: Mapping[str, Any] = {}

    def begin(self, manifest: Mapping[str, object], words: Wording, *, resume: bool) -> frozenset[Chunk]:
        """Write the manifest, or compare it with that of the sweep to resume; return the chunks that are done.

        SweepError if the folder has a sweep that is not to be resumed, or another one than this.
        """
        file = self.folder / MANIFEST
        if self.folder.exists() and not self.folder.is_dir():
            raise SweepError(f"'{self.folder}' is a file; choose a folder for the robots and the table")
        if file.exists() and not (resume or self._has_robots):
            file.unlink()  # of a sweep that ended before its first chunk, such as one whose scheduler was not there
        if file.exists():
            if not resume:
                ways = f"continue it with {words.resuming}, remove the folder, or choose another one"
                raise SweepError(f"'{self.folder}' has a sweep; {ways}")
            self._manifest = json.loads(file.read_text("utf-8"))
            if found := differences(self._manifest, manifest, words):
                lines = "\n  ".join(
                    (f"'{self.folder}' has another sweep, so {words.resuming} cannot continue it:", *found)
                )
                raise SweepError(lines)
        elif self.folder.is_dir() and any(one.name != PARTS for one in self.folder.iterdir()):
            raise SweepError(f"'{self.folder}' has files that no sweep wrote; choose an empty or a new folder")
        self.folder.mkdir(parents=True, exist_ok=True)
        self._write_manifest(manifest)
        if self.is_finished:
            return frozenset()
        (self.folder / PARTS).mkdir(exist_ok=True)
        return frozenset(Chunk(*map(int, path.stem.split("-"))) for path in (self.folder / PARTS).glob("*.parquet"))

    def update(self, manifest: Mapping[str, object]) -> None:
        """Write the manifest if it has files that the one in the folder lacks."""
        self._require_own()
        self._write_manifest(manifest)

    def _write_manifest(self, manifest: Mapping[str, object]) -> None:
        united = with_files(manifest, self._manifest)
        if united != self._manifest:
            text = json.dumps(united, ensure_ascii=False, indent=2) + "\n"
            write_atomically(self.folder / MANIFEST, text.encode())
            self._manifest = united

    def _require_own(self) -> None:
        """Refuse to write beside another sweep, which was begun in the folder after this one."""
        file = self.folder / MANIFEST
        if not file.exists() or json.loads(file.read_text("utf-8")) != self._manifest:
            raise SweepError(f"'{self.folder}' was removed, or another sweep writes to it now; choose another folder")

    @property
    def _has_robots(self) -> bool:
        return self.is_finished or (self.folder / ROBOTS).exists() or any((self.folder / PARTS).glob("*.parquet"))

    @property
    def is_finished(self) -> bool:
        """Whether the table is there, which is written last."""
        return (self.folder / TABLE).exists()

    def add(self, chunk: Chunk, made: Sequence[Made]) -> None:
        """Write the robots of a chunk, then its part of the table."""
        self._require_own()
        if self._packing == "folders":
            for one in made:
                self._write_folder(one)
        elif self._packing != "none":
            self._write_archive(chunk, made)
        sink = io.BytesIO()
        parquet().write_table(self._table([one.row for one in made]), sink)
        write_atomically(self.folder / PARTS / f"{chunk.begin:09}-{chunk.end:09}.parquet", sink.getvalue())

    def _write_folder(self, one: Made) -> None:
        if not one.files:
            return
        target = self.folder / ROBOTS / f"{one.point.index:06}"
        fresh = target.with_name(f".{target.name}.new")
        shutil.rmtree(fresh, ignore_errors=True)
        for name, text in one.files.items():
            place = fresh / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(text.encode("utf-8", "backslashreplace"))
        shutil.rmtree(target, ignore_errors=True)  # of a chunk that was interrupted
        fresh.replace(target)

    def _write_archive(self, chunk: Chunk, made: Sequence[Made]) -> None:
        """Write the robots of a chunk into one archive, whose bytes depend on nothing else."""
        named = {f"{one.point.index:06}/{name}": text for one in made for name, text in one.files.items()}
        contents = {name: text.encode("utf-8", "backslashreplace") for name, text in named.items()}
        sink = io.BytesIO()
        (_fill_tar if self._packing == "tar" else _fill_zip)(sink, contents)
        name = f"{chunk.begin:06}-{chunk.end - 1:06}.{self._packing}"
        (self.folder / ROBOTS).mkdir(exist_ok=True)
        write_atomically(self.folder / ROBOTS / name, sink.getvalue())

    def _table(self, rows: Sequence[Row]) -> Any:
        """Return rows as a table; columns of the user's function have the types that fit their values."""
        pa = arrow()
        known = set(self._schema.names)
        names = dict.fromkeys(name for row in rows for name in row if name not in known)
        table = pa.Table.from_pylist([{**row} for row in rows], schema=self._schema)
        for name in names:
            table = table.append_column(name, pa.array(_of_one_type([row.get(name) for row in rows])))
        return table

    def finish(self) -> None:
        """Join the parts to the table, a few rows at a time, and remove them."""
        self._require_own()
        pa, pq = arrow(), parquet()
        parts = sorted((self.folder / PARTS).glob("*.parquet"))
        schema = self._schema
        for part in parts:  # one at a time: those of a thousand parts take megabytes
            schema = _united(schema, pq.read_schema(part))
        temporary = self.folder / f".{TABLE}.new"
        with pq.ParquetWriter(temporary, schema) as writer:
            waiting: list[Any] = []
            for part in parts:
                waiting.append(_as_schema(pq.read_table(part), schema))
                if sum(map(len, waiting)) >= _ROWS:
                    joined = pa.concat_tables(waiting)
                    writer.write_table(joined.slice(0, _ROWS), row_group_size=_ROWS)
                    waiting = [joined.slice(_ROWS)]
            rest = pa.concat_tables(waiting) if waiting else schema.empty_table()
            if len(rest) or not parts:
                writer.write_table(rest)
        with temporary.open("rb+") as written:
            os.fsync(written.fileno())  # the parts are removed below
        temporary.replace(self.folder / TABLE)
        shutil.rmtree(self.folder / PARTS)

    def table(self) -> Any:
        """Return the finished table."""
        return parquet().read_table(self.folder / TABLE)

    def batches(self, columns: Sequence[str]) -> Iterator[list[Row]]:
        """Yield rows with some columns of the finished table."""
        with parquet().ParquetFile(self.folder / TABLE) as file:
            for batch in file.iter_batches(batch_size=_ROWS, columns=list(columns)):
                yield batch.to_pylist()


def schema_of(columns: Mapping[str, Parameter], *, has_variants: bool) -> Any:
    """Return the schema of the table without the columns of a user's function.

    The metadata of a column has its unit, `unit`, if it has one.
    """
    pa = arrow()
    types = {"number": pa.float64(), "integer": pa.int64(), "boolean": pa.bool_()}

    def field(name: str, type_: Any, unit: str = "") -> Any:
        return pa.field(name, type_, metadata={"unit": unit} if unit else None)

    fields = [pa.field("index", pa.int64(), nullable=False)]
    fields += [field("variant", pa.string())] if has_variants else []
    for name, parameter in columns.items():
        is_quantity = parameter.type.name in list(Dimension)
        unit = Dimension(parameter.type.name).si_unit if is_quantity else ""
        kind = pa.float64() if is_quantity else types.get(parameter.type.name, pa.string())
        fields.append(field(name, kind, unit))
    fields += [field(name, pa.float64(), unit) for name, unit in FIGURES.items()]
    fields += [field(name, pa.int64()) for name in COUNTS]
    fields += [field(name, pa.string()) for name in TEXTS]
    return pa.schema(fields)


def _of_one_type(values: Sequence[Cell]) -> Sequence[Cell]:
    """Return values that a column can hold: strings if they are of several kinds."""
    kinds = {float if isinstance(one, int | float) and not isinstance(one, bool) else type(one) for one in values}
    kinds.discard(type(None))
    if len(kinds) > 1:
        return [None if one is None else value_text(one) for one in values]
    is_mixed = kinds == {float} and any(isinstance(one, float) for one in values)
    return [None if one is None else float(str(one)) for one in values] if is_mixed else values


def _united(schema: Any, other: Any) -> Any:
    """Return a schema for the rows of both; a column of several kinds has strings."""
    pa = arrow()
    try:
        return pa.unify_schemas([schema, other], promote_options="permissive")
    except pa.ArrowTypeError:
        if len(other) > 1:
            for field in other:
                schema = _united(schema, pa.schema([field]))
            return schema
        return schema.set(schema.get_field_index(other[0].name), other[0].with_type(pa.string()))


def _as_schema(table: Any, schema: Any) -> Any:
    pa = arrow()
    columns = [
        table[field.name].cast(field.type) if field.name in table.column_names else pa.nulls(len(table), field.type)
        for field in schema
    ]
    return pa.Table.from_arrays(columns, schema=schema)


def _fill_tar(sink: io.BytesIO, contents: Mapping[str, bytes]) -> None:
    import tarfile

    with tarfile.open(fileobj=sink, mode="w") as archive:
        for name, content in contents.items():
            about = tarfile.TarInfo(name)
            about.size = len(content)
            archive.addfile(about, io.BytesIO(content))


def _fill_zip(sink: io.BytesIO, contents: Mapping[str, bytes]) -> None:
    import zipfile

    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in contents.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
