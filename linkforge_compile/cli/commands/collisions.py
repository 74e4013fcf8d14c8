"""`linkforge collisions`: the pairs of links that need no check for collisions, found by sampling."""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    add_spec_and_values,
    add_spec_options,
    compile_spec,
    require_one_spec,
    settings_of,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, print_line, print_status, report

if TYPE_CHECKING:
    from linkforge_compile.collisions.matrix import Matrix
    from linkforge_compile.collisions.pairs import Names
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.pipeline import Settings

MAX_SHOWN = 20
"""The most pairs that `--check` lists."""

_EXAMPLES = """\
The reasons are those of MoveIt's Setup Assistant: Adjacent, Default (in collision in the default pose), Always and
Never. Pairs with other reasons, such as User, stay. A module that has pairs of its own is not sampled inside. It needs
Pinocchio and coal: pip install 'linkforge-compile[collisions]'.

examples:
  linkforge collisions arm.robot.yaml                    print the section `disabled_collisions`
  linkforge collisions arm.robot.yaml --samples 100000   of more samples, for pairs that seldom collide
  linkforge collisions arm.robot.yaml --write            put it into arm.robot.yaml, and keep its comments
  linkforge collisions arm.robot.yaml --check            in CI: exit code 1 if --write would change anything
  linkforge collisions cell.robot.yaml --all             sample the pairs inside modules as well
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge collisions [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    parser.add_argument(
        "--samples", metavar="N", type=_count, default=10_000, help="how many random positions (default: 10000)"
    )
    parser.add_argument("--seed", metavar="N", type=_seed, default=0, help="the seed of the positions (default: 0)")
    parser.add_argument(
        "--jobs", metavar="N", type=_count, default=_processors(), help="how many processes (default: one a processor)"
    )
    parser.add_argument("--all", action="store_true", help="sample the pairs inside modules that have pairs as well")
    output = parser.add_mutually_exclusive_group()
    output.add_argument("--write", action="store_true", help="change the section in the spec instead of printing it")
    output.add_argument("--check", action="store_true", help="write nothing; fail if --write would change anything")
    output.add_argument("--json", action="store_true", help="print JSON, with the pairs that need a check")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    specs, assignments = split_assignments(arguments.words)
    spec = require_one_spec(specs)
    _require_libraries()
    compilation = compile_spec(spec, assignments, arguments)
    if report(compilation.diagnostics, arguments) or compilation.robot is None:
        return FAULTY_SPEC
    matrix = _find_matrix(compilation.robot, arguments)
    if matrix is None:
        return FAULTY_SPEC
    print_status(_summary(matrix), arguments)
    if arguments.write or arguments.check:
        return _write(compilation.robot, matrix, spec, settings_of(assignments, arguments), arguments)
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.collisions.section import section_text

    write_to_stdout(_json_text(matrix, arguments) if arguments.json else section_text(matrix.disabled))
    return OK


def _write(robot: Robot, matrix: Matrix, spec: str, settings: Settings, arguments: argparse.Namespace) -> int:
    """Put the pairs into the file that declares them, or compare them with it; return the exit code."""
    from linkforge_compile.cli.output import write_if_changed
    from linkforge_compile.collisions.matrix import own_pairs
    from linkforge_compile.collisions.rewrite import CannotRewriteError, file_to_rewrite, rewrite

    declared = own_pairs(robot)
    if declared == matrix.disabled:
        print_status("the pairs are up to date", arguments)
        return OK
    if arguments.check:
        for line in _differences(declared, matrix.disabled):
            print_line(line)
        print_line(f"the pairs are out of date; run 'linkforge collisions {spec} --write'")
        return FAULTY_SPEC
    try:
        file = file_to_rewrite(robot)
        text = rewrite(file, robot, matrix.disabled)
    except CannotRewriteError as error:
        raise UsageError(f"--write: {error}; change it by hand, to what the command prints without --write") from error
    assert file.path
    if file.path.read_bytes() != file.text.encode():
        raise UsageError(f"'{file.shown}' has changed meanwhile, or is not in UTF-8")
    if spec == file.name:
        _require_result(text, Path(spec), settings, matrix)
    print_status(
        f"wrote {file.shown}" if write_if_changed(file.path, text) else f"{file.shown} is as before", arguments
    )
    return OK


def _require_result(text: str, spec: Path, settings: Settings, matrix: Matrix) -> None:
    """Refuse a text that does not declare the pairs of the matrix."""
    from linkforge_compile.collisions.matrix import own_pairs
    from linkforge_compile.pipeline import compile_source

    robot = compile_source(text, str(spec), spec.parent, settings).robot
    if robot is None or own_pairs(robot) != matrix.disabled:
        raise UsageError("--write: the section cannot be changed here; paste what the command prints without --write")


def _differences(declared: Mapping[Names, str | None], wanted: Mapping[Names, str | None]) -> Iterator[str]:
    """Yield a line for each of the first pairs that is declared and not wanted, or wanted and not declared."""
    gone = [("-", pair, reason) for pair, reason in declared.items() if wanted.get(pair, "") != reason]
    new = [("+", pair, reason) for pair, reason in wanted.items() if declared.get(pair, "") != reason]
    for sign, pair, reason in (*gone, *new)[:MAX_SHOWN]:
        yield f"{sign} {pair[0]} {pair[1]} {reason or ''}".rstrip()
    if (more := len(gone) + len(new) - MAX_SHOWN) > 0:
        yield f"and {more:,} more"


def _find_matrix(robot: Robot, arguments: argparse.Namespace) -> Matrix | None:
    """Return the matrix of a robot; None if that has errors, which are printed."""
    from linkforge_compile.cli.progress_bar import ProgressBar
    from linkforge_compile.collisions.matrix import find_matrix
    from linkforge_compile.collisions.sampling import SamplingSettings
    from linkforge_compile.diagnostics import Diagnostics
    from linkforge_compile.diagnostics.grouping import group_alike

    sink = Diagnostics()
    settings = SamplingSettings(arguments.samples, arguments.seed, arguments.jobs)
    bar = ProgressBar(arguments.samples, "samples", arguments)
    try:
        matrix = find_matrix(robot, settings, bar.show, sink, is_all=arguments.all)
    finally:
        bar.close()
    report(group_alike(sink.sorted()), arguments)
    return matrix


def _require_libraries() -> None:
    from importlib.util import find_spec

    if missing := [name for name in ("pinocchio", "coal", "numpy") if find_spec(name) is None]:
        what = f"needs Pinocchio and coal, and there is no Python package {' and '.join(missing)}"
        raise UsageError(f"{what}; run: pip install 'linkforge-compile[collisions]'")


def _summary(matrix: Matrix) -> str:
    counts = Counter(reason or "no reason" for reason in matrix.disabled.values())
    parts = ", ".join(f"{count} {reason}" for reason, count in sorted(counts.items()))
    return f"{len(matrix.disabled)} pairs need no check ({parts or 'none'}), {len(matrix.checked)} do"


def _json_text(matrix: Matrix, arguments: argparse.Namespace) -> str:
    import json

    document = {
        "samples": arguments.samples,
        "seed": arguments.seed,
        "disabled": [{"link1": one, "link2": other, "reason": why} for (one, other), why in matrix.disabled.items()],
        "checked": [{"link1": one, "link2": other} for one, other in matrix.checked],
    }
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def _count(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"takes a whole number above 0, found '{text}'")
    return int(text)


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"takes a whole number from 0 on, found '{text}'")
    return int(text)


def _processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
