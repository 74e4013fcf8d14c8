"""`linkforge compile`: a spec to URDF and SRDF, on standard output or into files."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.one_spec import compile_spec, one_spec
from linkforge_compile.cli.options import add_spec_options, split_assignments
from linkforge_compile.cli.telling import add_telling_options, say, tell

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Iterator

    from linkforge_compile.core import Robot

FORMATS = ("urdf", "srdf")
_FILE_ENDINGS = (".urdf", ".srdf", ".xml")

_EXAMPLES = """\
examples:
  linkforge compile arm.robot.yaml                      URDF to standard output
  linkforge compile arm.robot.yaml -o build/            build/arm.urdf, and build/arm.srdf if it has `semantic`
  linkforge compile arm.robot.yaml -o arm.urdf          one file
  linkforge compile arm.robot.yaml -p reach=0.7m        with a parameter; reach:=0.7m is the same
  linkforge compile arm.robot.yaml --gazebo classic     with sensors as Gazebo Classic reads them
  linkforge compile arm.robot.yaml --variant sim        with the values of one of its variants
  linkforge compile arm.robot.yaml -o build/ --source-map   and what wrote each line, in build/arm.urdf.map.json
  linkforge compile - < arm.robot.yaml                  from standard input
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge compile [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="SPEC", nargs="+", help="the spec, NAME.robot.yaml; - for standard input")
    parser.add_argument(
        "-o",
        "--output",
        metavar="PATH",
        help="a folder for NAME.urdf and NAME.srdf, or one file that ends in .urdf, .srdf or .xml",
    )
    parser.add_argument("--format", choices=FORMATS, help="only this one (standard output: urdf unless said)")
    parser.add_argument(
        "--source-map",
        action="store_true",
        help="write FILE.map.json beside each file, for `linkforge where FILE:LINE` to tell what wrote the line",
    )
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    specs, assignments = split_assignments(arguments.words)
    spec = one_spec(specs)
    targets = _targets(spec, arguments.output, arguments.format)
    if arguments.source_map:
        _require_files(targets.values())
    urdf = targets.get("urdf")
    compilation = compile_spec(spec, assignments, arguments, urdf.parent if urdf else None)
    if tell(compilation.diagnostics, arguments) or compilation.robot is None:
        return FAULTY_SPEC
    return _write(compilation.robot, spec, targets, arguments)


def _targets(spec: str, output: str | None, chosen: str | None) -> dict[str, Path | None]:
    """Return where each format goes; None is standard output."""
    if output is None:
        return {chosen or "urdf": None}
    path = Path(output)
    if _is_file(output, path):
        other = "srdf" if chosen == "urdf" else "urdf"
        if chosen and path.suffix == f".{other}":
            raise UsageError(f"--format {chosen} does not go into '{output}'")
        return {chosen or ("srdf" if path.suffix == ".srdf" else "urdf"): path}
    name = "robot" if spec == "-" else Path(spec).name.removesuffix(".yaml").removesuffix(".yml").removesuffix(".robot")
    return {format_: path / f"{name}.{format_}" for format_ in FORMATS if chosen in (None, format_)}


def _is_file(output: str, path: Path) -> bool:
    """Whether `-o` names a file: one with one of the endings, a device or a pipe; all else are folders.

    An ending that is neither is refused: `-o arm.robot.yaml` would else replace the spec, or make a folder of it.
    """
    if output.endswith(("/", "\\")) or path.is_dir():
        return False
    if path.suffix and path.suffix not in _FILE_ENDINGS:
        raise UsageError(
            f"-o takes a folder, or a file that ends in .urdf, .srdf or .xml; found '{output}'"
            f" (for a folder of that name, write '{output}/')"
        )
    return bool(path.suffix) or (path.exists() and not path.is_file())


def _require_files(targets: Iterable[Path | None]) -> None:
    """Refuse a map of what is no file, for want of a place beside it."""
    for path in targets:
        if path is None or (path.exists() and not path.is_file()):
            raise UsageError("--source-map writes its map beside the output, so it takes -o with a folder or a file")


def _write(robot: Robot, spec: str, targets: dict[str, Path | None], arguments: argparse.Namespace) -> int:
    if not robot.says_semantic or robot.semantic.is_empty:
        if "urdf" not in targets:
            print(f"{spec}: error: the robot has no `semantic` part, so there is no SRDF to write", file=sys.stderr)
            return FAULTY_SPEC
        targets = {"urdf": targets["urdf"]}
    banner = None if spec == "-" else f"Compiled by linkforge from {Path(spec).name}; edit that file, not this one."
    for path, text in _texts(robot, banner, targets, arguments):
        _put(path, text, arguments)
    return OK


def _texts(
    robot: Robot, banner: str | None, targets: dict[str, Path | None], arguments: argparse.Namespace
) -> list[tuple[Path | None, str]]:
    """Return what goes where, all of it rendered before any of it is written."""
    options: dict[str, dict[str, str]] = {"urdf": {"gazebo": arguments.gazebo}, "srdf": {}}
    if arguments.source_map:
        return list(_with_maps(robot, banner, targets, options))
    from linkforge_compile.backends import BACKENDS

    return [(path, BACKENDS[format_](robot, banner=banner, **options[format_])) for format_, path in targets.items()]


def _with_maps(
    robot: Robot, banner: str | None, targets: dict[str, Path | None], options: dict[str, dict[str, str]]
) -> Iterator[tuple[Path, str]]:
    from linkforge_compile.backends.map_file import ENDING, map_text
    from linkforge_compile.backends.source_map import WITH_MAP

    for format_, path in targets.items():
        assert path is not None, "a map lies beside a file"
        mapped = WITH_MAP[format_](robot, banner=banner, **options[format_])
        yield path, mapped.text
        yield path.with_name(path.name + ENDING), map_text(mapped, path.name, path.parent)


def _put(path: Path | None, text: str, arguments: argparse.Namespace) -> None:
    from linkforge_compile.cli.output import write_if_changed, write_to_stdout

    if path is None:
        write_to_stdout(text)
    elif write_if_changed(path, text):
        say(f"wrote {path}", arguments)
    else:
        say(f"{path} is up to date", arguments)
