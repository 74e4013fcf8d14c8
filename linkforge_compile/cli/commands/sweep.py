"""`linkforge sweep`: compiles one spec with many values, on all processors or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, INTERRUPTED, OK, WRONG_USAGE, UsageError
from linkforge_compile.cli.options import (
    add_format_options,
    add_spec_and_values,
    add_spec_options,
    format_options_of,
    packages_of,
    refuse_options_of_other_formats,
    require_one_spec,
    split_assignments,
    whole_number,
)
from linkforge_compile.cli.reports import add_report_options, print_line, print_status, report
from linkforge_compile.cli.targets import name_of

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.sweep.place import Place
    from linkforge_compile.sweep.plan import Choice, Plan
    from linkforge_compile.sweep.session import Group, Summary
    from linkforge_compile.sweep.work import Request

MAX_JOBS = 1024

FEW = 100
"""Sweeps of fewer robots are done before the processes of Dask have started."""

MOST_GROUPS = 20
"""How many messages the summary shows."""

_EXAMPLES = """\
Each combination of the values of --set makes a robot, in OUT/robots/000123/, and a row of OUT/table.parquet with its
parameters, mass, centre of mass, inertia, reach, degrees of freedom, diagnostics and digest. A robot with errors has
only a row, with its diagnostics; the sweep continues, and the exit code is 1. docs/sweep.md describes the table and
clusters.
It needs the extra `sweep`: pip install 'linkforge-compile[sweep]'.

examples:
  linkforge sweep arm.robot.yaml --set reach=0.4m:1m:20 -o out/      20 values, both ends included
  linkforge sweep arm.robot.yaml --set reach=0.4m:1m:20 --set fingers=2,3,5 -o out/     60 robots
  linkforge sweep arm.robot.yaml --set reach=0.4m:1m:20 --variant sim --variant real -o out/
  linkforge sweep arm.robot.yaml --set reach=0.2m:1m:50 --set base=0.1m:0.5m:50 --where '$(reach > 2 * base)' -o out/
  linkforge sweep arm.robot.yaml --sample 10000 --seed 1 -o out/     random values within each parameter's own limits
  linkforge sweep arm.robot.yaml --sample 1000 --set reach=0.4m:1m -o out/     and of reach between these
  linkforge sweep arm.robot.yaml --values points.csv -o out/         a row of a CSV or Parquet file for each robot
  linkforge sweep arm.robot.yaml --set reach=0.4m:1m:20 -o out/ --resume       continue where it was interrupted
  linkforge sweep arm.robot.yaml --sample 100000 -o out/ --pack tar  an archive for each chunk of robots
  linkforge sweep arm.robot.yaml --sample 100000 -o out/ --scheduler tls://head:8786 --tls-ca ca.pem \\
      --tls-cert me.pem --tls-key me.key
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge sweep [options] SPEC [NAME:=VALUE ...] -o FOLDER"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser, "the spec, NAME.robot.yaml, a file")
    parser.add_argument("-o", "--output", metavar="FOLDER", required=True, help="where robots, table and manifest go")
    _add_choice_options(parser)
    _add_output_options(parser)
    _add_place_options(parser)
    add_spec_options(parser, variants_help="repeat it for others, which become an axis of the sweep")
    add_format_options(parser)
    add_report_options(parser)


def _add_choice_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("values")
    group.add_argument(
        "--set",
        metavar="NAME=VALUES",
        dest="sets",
        action="append",
        default=[],
        help="vary a parameter: START:STOP:COUNT, or VALUE,VALUE,…; --set are combined. With --sample also LO:HI",
    )
    group.add_argument("--sample", metavar="N", type=whole_number(1), help="draw N random points instead of a grid")
    group.add_argument("--seed", metavar="S", type=_seed, help="the seed of --sample, a whole number (default: 0)")
    group.add_argument(
        "--values", metavar="FILE", type=Path, help="a CSV or Parquet file: columns are parameters, rows are points"
    )
    group.add_argument(
        "--where", metavar="EXPR", help="compile only points that fulfil an expression, such as '$(reach > 2 * base)'"
    )
    group.add_argument("--max-points", metavar="N", type=whole_number(1), help="allow more than 1,000,000 points")


def _add_output_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("output")
    group.add_argument(
        "--format", metavar="FORMAT", dest="formats", action="append", default=[],
        help="the format to write; repeat it for others (default: URDF, and SRDF for a spec with `semantic`)",
    )  # fmt: skip
    packing = group.add_mutually_exclusive_group()
    packing.add_argument(
        "--pack", choices=("tar", "zip"), help="an archive for each chunk instead of a folder for each robot"
    )
    packing.add_argument("--table-only", action="store_true", help="write the table, and no robots")
    group.add_argument(
        "--chunk",
        metavar="N",
        type=whole_number(1),
        help="robots that are compiled and written together (default: a 32nd of all, at most 100)",
    )
    group.add_argument("--resume", action="store_true", help="continue an interrupted sweep in the same folder")


def _add_place_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("processes")
    group.add_argument(
        "--jobs",
        metavar="N",
        type=whole_number(1, MAX_JOBS),
        help=f"the number of processes; 1 needs no Dask (default: one per processor, 1 for fewer than {FEW} robots)",
    )
    group.add_argument(
        "--scheduler", metavar="ADDRESS", help="the scheduler of a Dask cluster, such as tls://head:8786"
    )
    for name, about in (("ca", "the authority's certificate"), ("cert", "your certificate"), ("key", "your key")):
        group.add_argument(f"--tls-{name}", metavar="FILE", help=f"{about}, for a scheduler with TLS")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.sweep import SweepError

    try:
        return _run(arguments)
    except SweepError as error:
        if error.diagnostics:
            report(error.diagnostics, arguments)
        for line in f"linkforge sweep: {error.message}".splitlines():
            print_line(line)
        return WRONG_USAGE


def _run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.progress_bar import ProgressBar
    from linkforge_compile.sweep.plan import plan_of
    from linkforge_compile.sweep.session import execute
    from linkforge_compile.sweep.store import Store

    folder = _folder_of(arguments)
    with _points_bar(arguments) as checked:
        plan = plan_of(_request_of(arguments), _choice_of(arguments), checked)
    packing = "none" if arguments.table_only else arguments.pack or "folders"
    store = Store(folder, packing, plan.request.columns, has_variants=plan.has_variants)
    place = _place_of(plan, arguments)
    first_note = iter(() if place.is_here else ("waiting for processes to start",))
    bar, begin = ProgressBar(plan.size, "robot" if plan.size == 1 else "robots", arguments), monotonic()

    def progress(done: int, failed: int) -> None:
        bar.show(done, next(first_note, "") or (f"{failed:,} with errors" if failed else ""))

    try:
        summary = execute(plan, store, place, packing, resume=arguments.resume, progress=progress)
    except KeyboardInterrupt:
        bar.close()
        print_line(f"linkforge sweep: interrupted; the same command with --resume continues in '{folder}'")
        return INTERRUPTED
    finally:
        bar.close()
    _print_summary(plan, summary, monotonic() - begin, arguments)
    return FAULTY_SPEC if summary.failed else OK


def _folder_of(arguments: argparse.Namespace) -> Path:
    if arguments.output == "":
        raise UsageError("-o takes a folder, found '': is a variable of the shell empty?")
    if arguments.output == "-":
        raise UsageError("-o takes a folder, not standard output; write ./- for a folder of that name")
    return Path(arguments.output)


@contextmanager
def _points_bar(arguments: argparse.Namespace) -> Iterator[Callable[[int, int], None]]:
    """Show how many points --where has decided on."""
    from linkforge_compile.cli.progress_bar import ProgressBar

    bars: list[ProgressBar] = []

    def checked(done: int, of: int) -> None:
        if not bars:
            bars.append(ProgressBar(of, "points", arguments))
            bars[0].show(0)
        bars[0].show(done)

    try:
        yield checked
    finally:
        for bar in bars:
            bar.close()


def _request_of(arguments: argparse.Namespace) -> Request:
    from linkforge_compile import formats
    from linkforge_compile.cli.options import settings_of
    from linkforge_compile.sweep.work import Request

    words, assignments = split_assignments(arguments.words)
    spec = require_one_spec(words)
    if spec == "-" or Path(spec).is_fifo():
        raise UsageError("takes a spec as a file, not standard input or a pipe: it is read several times")
    for name in arguments.formats:
        try:
            formats.format_named(name)
        except ValueError as error:
            raise UsageError(f"--format: {error}") from error
    requested = tuple(dict.fromkeys(arguments.formats))
    refuse_options_of_other_formats(arguments, requested or ("urdf", "srdf"), "--format")
    settings_of(assignments, arguments)  # checks the options that all commands have
    return Request(
        spec,
        name_of(spec),
        (*arguments.parameters, *assignments),
        arguments.variants[0] if len(arguments.variants) == 1 else None,
        packages_of(arguments),
        format_options_of(arguments),
        requested,
        arguments.allow_outside,
        has_files=not arguments.table_only,
    )


def _choice_of(arguments: argparse.Namespace) -> Choice:
    from linkforge_compile.sweep.errors import MAX_POINTS
    from linkforge_compile.sweep.plan import Choice

    if arguments.seed is not None and arguments.sample is None:
        raise UsageError("--seed is for --sample; add --sample N, or leave it out")
    return Choice(
        tuple(arguments.sets),
        tuple(arguments.variants),
        arguments.values,
        arguments.where,
        arguments.sample,
        arguments.seed or 0,
        arguments.max_points or MAX_POINTS,
        arguments.chunk,
    )


def _place_of(plan: Plan, arguments: argparse.Namespace) -> Place:
    from linkforge_compile.sweep.connection import usable_processors
    from linkforge_compile.sweep.place import Place

    given = {
        "tls_ca_file": arguments.tls_ca,
        "tls_client_cert": arguments.tls_cert,
        "tls_client_key": arguments.tls_key,
    }
    security = {name: file for name, file in given.items() if file}
    if security and not arguments.scheduler:
        raise UsageError("--tls-ca, --tls-cert and --tls-key are for --scheduler; leave them out")
    if arguments.scheduler and arguments.jobs:
        raise UsageError("--jobs is for processes of this machine; those of --scheduler are started elsewhere")
    if arguments.scheduler or arguments.jobs or plan.size < FEW:
        return Place(arguments.jobs or 1, arguments.scheduler, security)
    return Place(min(usable_processors(plan.choice.words), MAX_JOBS))


def _print_summary(plan: Plan, summary: Summary, seconds: float, arguments: argparse.Namespace) -> None:
    """Print the messages of all robots by how often they occur, and what was done."""
    groups = [one for one in summary.groups if one.severity == "error" or not arguments.quiet]
    for group in groups[:MOST_GROUPS]:
        print_line(_group_line(group))
    if len(groups) > MOST_GROUPS:
        more = "more than " if summary.cut_off.intersection(one.severity for one in groups) else ""
        number = f"{more}{len(groups) - MOST_GROUPS:,}"
        print_line(f"and {number} other kinds of messages; the column `diagnostics` of the table has all")
    rate = f", {summary.compiled / seconds:.0f} a second" if summary.compiled > seconds > 1 else ""
    before = summary.robots - summary.compiled
    resumed = f", {before:,} of them before" if before else ""
    left_out = len(plan.points) - plan.size
    where = f" ({left_out:,} of {len(plan.points):,} points left out by --where)" if left_out else ""
    failed = f", {summary.failed:,} with errors" if summary.failed else ""
    number = f"{summary.robots:,} robot{'' if summary.robots == 1 else 's'}"
    print_status(f"{number} in {arguments.output}{where}{failed}{resumed}{rate}", arguments)


def _group_line(group: Group) -> str:
    robots = f"{group.robots:,} robot{'' if group.robots == 1 else 's'}"
    example = f"such as {group.first.index:06} ({' '.join(group.first.words)})"
    return f"{group.severity} in {robots}, {example}: {group.text}"


def _seed(text: str) -> int:
    from argparse import ArgumentTypeError

    try:
        return int(text)
    except ValueError as error:
        raise ArgumentTypeError(f"takes a whole number, found '{text}'") from error
