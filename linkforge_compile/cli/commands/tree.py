"""`linkforge tree`: prints the kinematic tree of a robot."""

from __future__ import annotations

import argparse
import sys
from shutil import get_terminal_size

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import add_spec_and_values, add_spec_options, whole_number
from linkforge_compile.cli.reports import add_report_options, is_colored
from linkforge_compile.cli.specs import compile_one

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
    parser.add_argument(
        "--depth", metavar="N", type=whole_number(0), help="only links with at most N joints above them"
    )
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    one = compile_one(arguments)
    if one is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.overview.tree import cut_below, tree_document, tree_rows
    from linkforge_compile.overview.tree_text import WIDTH, lines_for, render_links, render_tree

    rows = tree_rows(one.robot)
    if arguments.depth is not None:
        rows = cut_below(rows, arguments.depth)
    if arguments.json:
        write_to_stdout(json_text(tree_document(one.robot, rows)))
        return OK
    drawn, colored = lines_for(sys.stdout.encoding), is_colored(sys.stdout, arguments.color)
    if arguments.links:
        lines = render_links(rows, drawn, is_colored=colored)
    else:
        width = get_terminal_size().columns if sys.stdout.isatty() else WIDTH
        lines = render_tree(rows, drawn, is_colored=colored, width=width)
    write_to_stdout("".join(f"{line}\n" for line in lines))
    return OK
