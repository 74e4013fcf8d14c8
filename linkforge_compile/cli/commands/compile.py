"""`linkforge compile`: a spec to URDF and SRDF, on standard output or into files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli.exits import FAULTY_SPEC, OK
from linkforge_compile.cli.one_spec import compile_spec, one_spec
from linkforge_compile.cli.options import add_spec_options, split_assignments
from linkforge_compile.cli.targets import Targets, add_target_options, targets_of
from linkforge_compile.cli.telling import add_telling_options, say, tell

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Sequence

    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.pipeline import Compilation

_EXAMPLES = """\
examples:
  linkforge compile arm.robot.yaml                      URDF to standard output
  linkforge compile arm.robot.yaml -o build/            build/arm.urdf, and build/arm.srdf if it has `semantic`
  linkforge compile arm.robot.yaml -o arm.urdf          one file
  linkforge compile arm.robot.yaml -p reach=0.7m        with a parameter; reach:=0.7m is the same
  linkforge compile arm.robot.yaml --gazebo classic     with sensors as Gazebo Classic reads them
  linkforge compile arm.robot.yaml --variant sim        with the values of one of its variants
  linkforge compile arm.robot.yaml -o build/ --source-map   and what wrote each line, in build/arm.urdf.map.json
  linkforge compile arm.robot.yaml -o urdf/ --check     write nothing; fail where urdf/arm.urdf is not up to date
  linkforge compile - < arm.robot.yaml                  from standard input
"""


class Output(NamedTuple):
    """A text and where it goes; None is standard output."""

    path: Path | None
    text: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge compile [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="SPEC", nargs="+", help="the spec, NAME.robot.yaml; - for standard input")
    add_target_options(parser)
    parser.add_argument(
        "--source-map",
        action="store_true",
        help="write FILE.map.json beside each file, for `linkforge where FILE:LINE` to tell what wrote the line",
    )
    parser.add_argument(
        "--check", action="store_true", help="write nothing, and fail where a file is not what the spec compiles to"
    )
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    specs, assignments = split_assignments(arguments.words)
    spec = one_spec(specs)
    targets = targets_of(spec, arguments.outputs, arguments.format)
    if arguments.source_map:
        targets.require_files("--source-map", "writes its map beside the output")
    if arguments.check:
        targets.require_files("--check", "compares with files")
    compilation = compile_spec(spec, assignments, arguments, targets.folder)
    outputs = None if compilation.robot is None else _outputs(compilation.robot, spec, targets, arguments)
    stale = _stale(outputs, spec) if arguments.check and outputs else ()
    if tell((*_report(compilation, outputs), *stale), arguments) or outputs is None:
        return FAULTY_SPEC
    for output in outputs:
        _put(output, arguments)
    return OK


def _report(compilation: Compilation, outputs: Sequence[Output] | None) -> tuple[Diagnostic, ...]:
    """Return what is to be told of a spec, with the part that it lacks where an SRDF is asked for in vain."""
    robot = compilation.robot
    if robot is None or outputs is not None:
        return compilation.diagnostics
    from linkforge_compile.diagnostics.codes.backends import NO_SEMANTIC_PART

    missed = NO_SEMANTIC_PART.at(robot.source, "name", robot=robot.name)
    return tuple(sorted((*compilation.diagnostics, missed), key=lambda diagnostic: diagnostic.order))


def _outputs(robot: Robot, spec: str, targets: Targets, arguments: argparse.Namespace) -> tuple[Output, ...] | None:
    """Return what goes where, all of it rendered before any is written; None where an SRDF is asked for in vain."""
    if not robot.says_semantic or robot.semantic.is_empty:
        if targets.is_srdf_asked_for and "srdf" in targets.paths:
            return None
        targets = targets.without_srdf()
    banner = None if spec == "-" else f"Compiled by linkforge from {Path(spec).name}; edit that file, not this one."
    options: dict[str, dict[str, str]] = {"urdf": {"gazebo": arguments.gazebo}, "srdf": {}}
    if arguments.source_map:
        return tuple(_with_maps(robot, banner, targets, options))
    from linkforge_compile.backends import BACKENDS

    return tuple(
        Output(path, BACKENDS[format_](robot, banner=banner, **options[format_]))
        for format_, path in targets.paths.items()
    )


def _with_maps(
    robot: Robot, banner: str | None, targets: Targets, options: dict[str, dict[str, str]]
) -> Iterator[Output]:
    from linkforge_compile.backends.map_file import ENDING, map_text
    from linkforge_compile.backends.source_map import WITH_MAP

    for format_, path in targets.paths.items():
        assert path is not None, "a map lies beside a file"
        mapped = WITH_MAP[format_](robot, banner=banner, **options[format_])
        yield Output(path, mapped.text)
        yield Output(path.with_name(path.name + ENDING), map_text(mapped, path.name, path.parent))


def _stale(outputs: Sequence[Output], spec: str) -> Iterator[Diagnostic]:
    from linkforge_compile.cli.uptodate import difference

    for path, text in outputs:
        assert path is not None, "only files are compared"
        if found := difference(path, text, spec):
            yield found


def _put(output: Output, arguments: argparse.Namespace) -> None:
    from linkforge_compile.cli.output import write_if_changed, write_to_stdout

    if output.path is None:
        write_to_stdout(output.text)
    elif not arguments.check and write_if_changed(output.path, output.text):
        say(f"wrote {output.path}", arguments)
    else:
        say(f"{output.path} is up to date", arguments)
