"""`linkforge tree`: prints the kinematic tree of a robot."""

from __future__ import annotations

import argparse
import sys
from shutil import get_terminal_size

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import (
    add_spec_and_values,
    add_spec_options,
    compile_spec,
    require_one_spec,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, is_colored, report

_EXAMPLES = """\
Each link has the joint above it, with its name, type and axis, and the range of its position (angles in degrees,
lengths in metres) or the joint that it follows; and the mass of the link. SPEC can also be a URDF or a xacro.

examples:
  linkforge tree arm.robot.yaml
  linkforge tree arm.robot.yaml --links           only the names of the links
  linkforge tree cell.robot.yaml --depth 3        the first levels, and the number of links below
  linkforge tree arm.urdf.xacro model:=x5         a xacro with its arguments
  linkforge tree arm.robot.yaml --json            for tools; numbers are in SI units
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge tree [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--links", action="store_true", help="only the names of the links")
    form.add_argument("--json", action="store_true", help="as JSON, for tools")
    parser.add_argument("--depth", metavar="N", type=_depth, help="only links with at most N joints above them")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    specs, assignments = split_assignments(arguments.words)
    compilation = compile_spec(require_one_spec(specs), assignments, arguments)
    if report(compilation.diagnostics, arguments) or compilation.robot is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.overview.tree import cut_below, tree_document, tree_rows
    from linkforge_compile.overview.tree_text import WIDTH, lines_for, render_links, render_tree

    rows = tree_rows(compilation.robot)
    if arguments.depth is not None:
        rows = cut_below(rows, arguments.depth)
    if arguments.json:
        write_to_stdout(json_text(tree_document(compilation.robot, rows)))
        return OK
    drawn, colored = lines_for(sys.stdout.encoding), is_colored(sys.stdout, arguments.color)
    if arguments.links:
        lines = render_links(rows, drawn, is_colored=colored)
    else:
        width = get_terminal_size().columns if sys.stdout.isatty() else WIDTH
        lines = render_tree(rows, drawn, is_colored=colored, width=width)
    write_to_stdout("".join(f"{line}\n" for line in lines))
    return OK


def _depth(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) < 10):
        raise argparse.ArgumentTypeError(f"takes a whole number from 0, found '{text}'")
    return int(text)
