"""`linkforge collisions`: the pairs of links that need no check, by sampling, or those that collide in a state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    add_spec_options,
    compile_spec,
    require_one_spec,
    settings_of,
    split_assignments,
    usable_processors,
    whole_number,
)
from linkforge_compile.cli.poses import states_of
from linkforge_compile.cli.reports import add_report_options, print_line, print_status, report
from linkforge_compile.cli.specs import FoundSpecs, SpecReport, count, find_parts, find_specs_of
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.analysis import Settings
    from linkforge_compile.collisions.matrix import Matrix
    from linkforge_compile.collisions.poses import Collision
    from linkforge_compile.collisions.sampling import SamplingSettings
    from linkforge_compile.collisions.scene import Names
    from linkforge_compile.core.models.robot import Robot

MAX_SHOWN = 20
"""The most pairs that `--check` lists."""

DEFAULT_SAMPLES = 10_000

MAX_SAMPLES = 100_000_000
"""More samples would take days."""

MAX_SEED = 2**64 - 1

MAX_JOBS = 256
"""Each process has a copy of the robot in memory."""

_EXAMPLES = """\
The reasons are those of the MoveIt Setup Assistant: Adjacent, Default (in collision in the default pose), Always and
Never. Pairs with other reasons, such as User, are not changed. The pairs inside a module that lists its own are not
sampled. It requires Pinocchio and coal: pip install 'linkforge-compile[collisions]'.

examples:
  linkforge collisions arm.robot.yaml                    print the section `disabled_collisions`
  linkforge collisions arm.robot.yaml --samples 100000   with more samples, for pairs that rarely collide
  linkforge collisions arm.robot.yaml --write            write it to arm.robot.yaml, and keep its comments
  linkforge collisions arm.robot.yaml --check            in CI: exit code 1 if --write would change anything
  linkforge collisions robots/ --check                   each spec in a folder that has pairs, modules first
  linkforge collisions cell.robot.yaml --all             sample the pairs inside modules as well
  linkforge collisions arm.robot.yaml --pose arm/home    the links that collide in state `home` of group `arm`;
                                                         exit code 1 if planners check such a pair
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge collisions [options] SPEC ... [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words", metavar="SPEC", nargs="+", help="specs, NAME.robot.yaml, or folders; - for standard input"
    )
    for option, least, most, about in (
        ("--samples", 1, MAX_SAMPLES, f"the number of random positions (default: {DEFAULT_SAMPLES})"),
        ("--seed", 0, MAX_SEED, "the seed of the positions (default: 0)"),
        ("--jobs", 1, MAX_JOBS, "the number of processes (default: one per processor)"),
    ):
        parser.add_argument(option, metavar="N", type=whole_number(least, most), help=about)
    parser.add_argument("--all", action="store_true", help="sample the pairs inside modules that have pairs as well")
    output = parser.add_mutually_exclusive_group()
    output.add_argument("--write", action="store_true", help="change the section in the spec instead of printing it")
    output.add_argument("--check", action="store_true", help="write nothing; fail if --write would change anything")
    output.add_argument("--json", action="store_true", help="print JSON, with the pairs that need a check")
    parser.add_argument(
        "--pose",
        metavar="GROUP/STATE",
        dest="poses",
        action="append",
        default=[],
        help="print the links that collide in a state of a group, or in STATE of every group that has it, without "
        "sampling; repeat it for others",
    )
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    found = find_specs_of(words, arguments)
    if not words or "" in words:
        raise UsageError("takes specs or folders, found none; is a variable of the shell empty?")
    if len(words) > 1 and "-" in words:
        raise UsageError("takes several specs as files, not on standard input")
    _require_libraries()
    if arguments.poses:
        return _check_poses(require_one_spec(words), assignments, arguments)
    code = FAULTY_SPEC if report(found.faults, arguments) else OK
    is_one = len(words) == 1 and not found.in_folders and not found.faults
    specs = found.specs if is_one else _in_order(found, assignments, arguments)
    results: dict[str, Matrix] = {}
    for spec in specs:
        label = "" if is_one else f"{spec}: "
        compilation = compile_spec(spec, assignments, arguments)
        robot = None if report(compilation.diagnostics, arguments) else compilation.robot
        matrix = _find_matrix(robot, arguments) if robot else None
        if robot is None or matrix is None:
            code = FAULTY_SPEC
            continue
        print_status(f"{label}{_summary(matrix)}", arguments)
        if arguments.write or arguments.check:
            code = max(code, _write(robot, matrix, spec, settings_of(assignments, arguments), arguments))
        else:
            results[spec] = matrix
    if results:
        _print(results, arguments, is_one=is_one)
    return code


def _in_order(found: FoundSpecs, assignments: list[str], arguments: argparse.Namespace) -> list[str]:
    """Return the specs, each after the modules that it uses; those found in folders only if they declare pairs."""
    from linkforge_compile.collisions.matrix import own_pairs
    from linkforge_compile.diagnostics.codes.schema import MISSING_NAME

    compilations = {spec: compile_spec(spec, assignments, arguments) for spec in found.specs}
    reports = {spec: SpecReport(one.diagnostics, one.files) for spec, one in compilations.items()}
    left_out = find_parts(reports, (MISSING_NAME,)) | {
        spec for spec in found.in_folders if (robot := compilations[spec].robot) and not own_pairs(robot)
    }
    if found.specs and left_out.issuperset(found.specs):
        raise UsageError("no spec below has pairs in `disabled_collisions`; name the specs that need it")
    # A spec is made from the files of its modules, and its own.
    return sorted(set(found.specs) - left_out, key=lambda spec: (len(set(compilations[spec].files)), spec))


def _check_poses(spec: str, assignments: list[str], arguments: argparse.Namespace) -> int:
    """Print what collides in the states that the options name; FAULTY_SPEC if planners check such a pair."""
    are_given = {name: getattr(arguments, name) is not None for name in ("samples", "seed", "jobs")}
    are_given |= {name: getattr(arguments, name) for name in ("all", "write", "check")}
    if other := next((name for name, is_given in are_given.items() if is_given), None):
        raise UsageError(f"--pose takes no samples and writes nothing, so --{other} is not allowed with it")
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.collisions.poses import find_collisions
    from linkforge_compile.diagnostics import Diagnostics
    from linkforge_compile.diagnostics.grouping import group_alike

    compilation = compile_spec(spec, assignments, arguments)
    if compilation.robot is None:
        report(compilation.diagnostics, arguments)
        return FAULTY_SPEC
    states, sink = states_of(compilation.robot, arguments.poses, "GROUP/STATE"), Diagnostics()
    found = find_collisions(compilation.robot, states.values(), sink)
    if report((*compilation.diagnostics, *group_alike(sink.sorted())), arguments):
        return FAULTY_SPEC
    by_pose = dict(zip(states, found, strict=True))
    if arguments.json:
        documents = [{"state": pose, "collisions": list(map(_collision_json, of))} for pose, of in by_pose.items()]
        write_to_stdout(json_text(documents))
    else:
        lines = (line for pose, collisions in by_pose.items() for line in _collision_lines(pose, collisions))
        write_to_stdout("".join(f"{line}\n" for line in lines))
    are_free = all(one.disabled is not None for collisions in found for one in collisions)
    return OK if are_free else FAULTY_SPEC


def _collision_lines(pose: str, collisions: Sequence[Collision]) -> Iterator[str]:
    disabled = sum(one.disabled is not None for one in collisions)
    checked = count(len(collisions) - disabled, "pair")
    yield f"{pose}: {checked} in collision" + (f", and {disabled} disabled" if disabled else "")
    for (one, other), depth, reason in collisions:
        deep = "" if depth is None else f" {depth * 1000:.3g} mm"
        yield f"  {one} {other}{deep}" + ("" if reason is None else f" (disabled: {reason or 'no reason'})")


def _collision_json(one: Collision) -> dict[str, object]:
    """Return a collision as JSON, with the depth in metres; `disabled` is null for a pair that planners check."""
    return {"link1": one.links[0], "link2": one.links[1], "depth": one.depth, "disabled": one.disabled}


def _print(results: Mapping[str, Matrix], arguments: argparse.Namespace, *, is_one: bool) -> None:
    """Print the matrix of one spec, or those of several with their specs."""
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.collisions.rewrite import section_text

    if arguments.json:
        documents = [{**({} if is_one else {"spec": spec}), **_json(one, arguments)} for spec, one in results.items()]
        write_to_stdout(json_text(documents[0] if is_one else documents))
        return
    headings = {spec: "" if is_one else f"# {on_one_line(spec)}\n" for spec in results}
    write_to_stdout("".join(f"{headings[spec]}{section_text(one.disabled)}" for spec, one in results.items()))


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
    is_written = write_if_changed(file.path, text)
    try:
        _require_result(spec, settings, matrix)
    except BaseException:
        write_if_changed(file.path, file.text)
        raise
    print_status(f"wrote {file.shown}" if is_written else f"{file.shown} is as before", arguments)
    return OK


def _require_result(spec: str, settings: Settings, matrix: Matrix) -> None:
    """Refuse a spec that does not declare the pairs of the matrix, with all that it includes."""
    from linkforge_compile.collisions.matrix import own_pairs
    from linkforge_compile.pipeline import compile_path

    robot = compile_path(spec, settings).robot
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
    from linkforge_compile.diagnostics import Diagnostics
    from linkforge_compile.diagnostics.grouping import group_alike

    sink = Diagnostics()
    settings = _sampling_settings(arguments)
    bar = ProgressBar(settings.samples, "samples", arguments)
    try:
        matrix = find_matrix(robot, settings, bar.show, sink, is_all=arguments.all)
    finally:
        bar.close()
    report(group_alike(sink.sorted()), arguments)
    return matrix


def _sampling_settings(arguments: argparse.Namespace) -> SamplingSettings:
    from linkforge_compile.collisions.sampling import SamplingSettings

    jobs = arguments.jobs or min(usable_processors(), MAX_JOBS)
    return SamplingSettings(arguments.samples or DEFAULT_SAMPLES, arguments.seed or 0, jobs)


def _require_libraries() -> None:
    from importlib.util import find_spec

    if missing := [name for name in ("pinocchio", "coal", "numpy", "trimesh", "collada") if find_spec(name) is None]:
        what = f"needs Pinocchio, coal and trimesh, and there is no Python package {' and '.join(missing)}"
        raise UsageError(f"{what}; run: pip install 'linkforge-compile[collisions]'")


def _summary(matrix: Matrix) -> str:
    counts = Counter(reason or "no reason" for reason in matrix.disabled.values())
    parts = ", ".join(f"{count} {reason}" for reason, count in sorted(counts.items()))
    return f"{len(matrix.disabled)} pairs need no check ({parts or 'none'}), {len(matrix.checked)} do"


def _json(matrix: Matrix, arguments: argparse.Namespace) -> dict[str, object]:
    settings = _sampling_settings(arguments)
    return {
        "samples": settings.samples,
        "seed": settings.seed,
        "disabled": [{"link1": one, "link2": other, "reason": why} for (one, other), why in matrix.disabled.items()],
        "checked": [{"link1": one, "link2": other} for one, other in matrix.checked],
    }
