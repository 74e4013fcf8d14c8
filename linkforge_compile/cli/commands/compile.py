"""`linkforge compile`: a spec to URDF and SRDF, on standard output or into files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.cli.build import Order, compile_order, deliver
from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.one_spec import one_spec
from linkforge_compile.cli.options import add_spec_and_values, add_spec_options, split_assignments
from linkforge_compile.cli.targets import add_target_options, targets_of
from linkforge_compile.cli.telling import add_telling_options

if TYPE_CHECKING:
    import argparse

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
  linkforge compile arm.robot.yaml -o arm.urdf --depfile arm.urdf.d     and what it was made from, for Make and Ninja
  linkforge compile - < arm.robot.yaml                  from standard input
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge compile [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_build_arguments(parser)
    parser.add_argument(
        "--check", action="store_true", help="write nothing, and fail where a file is not what the spec compiles to"
    )


def add_build_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what is said of each compile, be it the only one or one of many."""
    add_spec_and_values(parser)
    add_target_options(parser)
    parser.add_argument(
        "--source-map",
        action="store_true",
        help="write FILE.map.json beside each file, for `linkforge where FILE:LINE` to tell what wrote the line",
    )
    parser.add_argument(
        "--depfile",
        metavar="FILE",
        help="write what the output was made from, as a rule of Make, for a build to read; - for standard output",
    )
    parser.add_argument(
        "--installed-in",
        metavar="FOLDER",
        help="where the URDF will lie beside what it names, that of -o unless said: meshes are looked for from there",
    )
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    ordered = order(arguments)
    return deliver(ordered, compile_order(ordered, arguments), arguments)


def order(arguments: argparse.Namespace) -> Order:
    """Return what the words and options ask for; UsageError for what cannot be meant."""
    specs, assignments = split_assignments(arguments.words)
    spec = one_spec(specs)
    targets = targets_of(spec, arguments.outputs, arguments.format)
    if arguments.source_map:
        targets.require_files("--source-map", "writes its map beside the output")
    if arguments.check:
        targets.require_files("--check", "compares with files")
    if arguments.depfile is not None:
        targets.require_files("--depfile", "tells what files are made from")
        if arguments.check:
            raise UsageError("--check writes nothing, so there is no --depfile with it")
    return Order(spec, assignments, targets)
