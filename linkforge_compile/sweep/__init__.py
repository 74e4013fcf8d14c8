"""Compile one spec with many values: grids, lists, random samples and tables of values.

    from linkforge_compile.sweep import run

    def score(robot, values):
        return {"payload": 12.0 / values["reach"], "links": len(robot.links)}

    table = run("arm.robot.yaml", {"reach": "0.4m:1m:20", "fingers": [2, 3, 5]}, score)

`grid` has, by parameter, a text as in `--set`, or its values: numbers in SI units, or texts with units. With `sample`,
that many random points are drawn instead, and a text such as "0.4m:1m" is an interval.

The function gets a Robot and the values of its point by parameter: SI numbers, strings and booleans. It returns a
number, which becomes the column `result`, a mapping of columns to numbers, strings or booleans, or None. What it
raises is a diagnostic of that robot. With `jobs` above 1, processes of a Dask cluster on this machine compile, and
receive the function by cloudpickle; the script that calls `run` then needs `if __name__ == "__main__":`. With
`scheduler`, the workers of another cluster do; `security` has its files of TLS by the names of Dask's `Security`:
`tls_ca_file`, `tls_client_cert` and `tls_client_key`.

`output` is the folder for the robots, the table and the manifest; without it, only the table is made. `pack` is
`folders`, `tar`, `zip`, or `none` for the table alone. The other arguments are the options of `linkforge sweep`.

The table has a row for each robot, in the order of the points. docs/sweep.md describes its columns.

What flows: the options become a `Plan`, which is checked before anything is compiled: a `Request` (how to compile any
point, as plain values) and `Points` (each made from its index alone). Ranges of points are chunks. A chunk becomes a
list of `Made`: the files of each robot, and its row of the table. The store writes a chunk in one step, so that an
interrupted sweep goes on with the chunks that are missing, and in the end joins their rows to one table.

A worker needs no disk that it shares with the client. It receives a `Bundle`, the files that the compile of a point
reads by their SHA-256, lays them out below a folder of its own, and compiles there. If a diagnostic may be about a
file that it lacks, the client compiles that point itself, adds what it reads, and sends the chunk again; what the
client finds then counts.

What each module knows; it imports only those above it:

    errors       what is wrong with a sweep as a whole
    wording      how messages name options of the command, or arguments of `run`
    place        where robots are compiled
    arrow        pyarrow and distributed, which the extra `sweep` brings
    declared     a spec -> its parameters with types and constant limits
    cells        values as texts, and the cells of a line of CSV
    axes         `--set` -> axes of texts, and intervals
    points       axes, intervals -> the point of an index
    rows         a Robot and diagnostics -> a row of the table
    value_table  a CSV or Parquet file -> an axis
    condition    `--where` -> whether a point is compiled
    bundle       paths -> files by digest -> a tree of them on another machine
    manifest     two manifests -> how their sweeps differ
    work         a Request and points -> robots and rows
    store        chunks -> folders or archives, the table, the manifest
    connection   a place -> a client of Dask, with workers of the same versions
    scheduler    chunks -> Dask's workers -> what they made
    plan         the options -> all of the above decided
    session      a plan -> a finished sweep, and what went wrong in it

A process reads and validates a file once, however many points it compiles: load/spec_tree.py keeps faultless trees by
place and text. It expands and lowers a module once that no varied parameter reaches: see expand/module_cache.py.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from linkforge_compile.file_names import stem_of
from linkforge_compile.sweep.cells import value_text
from linkforge_compile.sweep.errors import MAX_POINTS, SweepError
from linkforge_compile.sweep.place import Place
from linkforge_compile.sweep.wording import Wording

if TYPE_CHECKING:
    from linkforge_compile.sweep.plan import Plan
    from linkforge_compile.sweep.work import Function, Request

__all__ = ["SweepError", "run"]


def run(
    spec: str | Path,
    grid: Mapping[str, object] | None = None,
    function: Function | None = None,
    *,
    sample: int | None = None,
    seed: int = 0,
    values: str | Path | None = None,
    where: str | None = None,
    parameters: Mapping[str, object] | None = None,
    variants: Iterable[str] = (),
    packages: Mapping[str, str | Path] | None = None,
    formats: Iterable[str] = (),
    options: Mapping[str, str] | None = None,
    output: str | Path | None = None,
    resume: bool = False,
    pack: str = "folders",
    chunk: int | None = None,
    jobs: int = 1,
    scheduler: str | None = None,
    security: Mapping[str, str | Path] | None = None,
    max_points: int = MAX_POINTS,
    allow_outside: bool = False,
) -> Any:
    """Compile a spec at every point of a grid, and return the `pyarrow.Table` of the robots.

    SweepError for what is wrong with the sweep as a whole; faults of single robots are in the table.
    """
    from linkforge_compile.sweep.plan import Choice, plan_of

    _check(pack, function, seed, jobs=jobs, sample=sample, chunk=chunk, max_points=max_points)
    names, table = tuple(variants), None if values is None else Path(values)
    request = _request_of(spec, parameters or {}, names, packages or {}, options or {})
    request = request._replace(formats=tuple(formats), allow_outside=allow_outside, function=function)
    words = Wording(is_python=True, has_folder=output is not None)
    choice = Choice(_set_texts(grid or {}), names, table, where, sample, seed, max_points, chunk, words)
    place = Place(jobs, scheduler, {name: str(path) for name, path in (security or {}).items()})
    packing = "none" if output is None else pack
    plan = plan_of(request._replace(has_files=packing != "none"), choice)
    return _table_of(plan, packing, output, place, resume=resume)


def _check(pack: str, function: Function | None, seed: object, **numbers: object) -> None:
    from linkforge_compile.sweep.store import PACKINGS

    if function is not None and not callable(function):
        raise SweepError(f"function takes a function of a robot and its values, found {function!r}")
    if pack not in PACKINGS:
        raise SweepError(f"pack takes {', '.join(PACKINGS[:-1])} or {PACKINGS[-1]}, found {pack!r}")
    if not isinstance(seed, int):
        raise SweepError(f"seed takes a whole number, found {seed!r}")
    for name, number in numbers.items():
        if number is not None and not (isinstance(number, int) and number > 0):
            raise SweepError(f"{name} takes a whole number from 1, found {number!r}")


def _request_of(
    spec: str | Path,
    parameters: Mapping[str, object],
    variants: tuple[str, ...],
    packages: Mapping[str, str | Path],
    options: Mapping[str, str],
) -> Request:
    from linkforge_compile.sweep.work import Request

    texts = tuple(f"{name}={value_text(value)}" for name, value in parameters.items())
    variant = variants[0] if len(variants) == 1 else None
    paths = {name: str(path) for name, path in packages.items()}
    return Request(str(spec), stem_of(spec), texts, variant, paths, {"gazebo": "gz", **options})


def _table_of(plan: Plan, packing: str, output: str | Path | None, place: Place, *, resume: bool) -> Any:
    """Run a plan in a folder, for None a temporary one, and return its table."""
    from linkforge_compile.sweep.session import execute
    from linkforge_compile.sweep.store import Store

    with TemporaryDirectory(prefix="linkforge-sweep-") as temporary:
        store = Store(
            Path(temporary if output is None else output), packing, plan.request.columns, has_variants=plan.has_variants
        )
        execute(plan, store, place, packing, resume=resume)
        return store.table()


def _set_texts(grid: Mapping[str, object]) -> tuple[str, ...]:
    """Return what a grid, or its pairs, varies as `--set` has it."""
    return tuple(_set_text(name, value) for name, value in dict(grid).items())


def _set_text(name: str, value: object) -> str:
    """Return values of a parameter as `--set` has them."""
    if value is None:
        return name
    if isinstance(value, str) or not isinstance(value, Iterable):
        return f"{name}={value_text(value)}"
    line = io.StringIO()
    csv.writer(line, lineterminator="").writerow(map(value_text, value))
    return f"{name}={line.getvalue()}"
