"""`linkforge graph`: draws the links and joints of a robot, with its modules as boxes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import add_spec_and_values, add_spec_options
from linkforge_compile.cli.reports import add_report_options
from linkforge_compile.cli.specs import compile_one

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.core.models.robot import Robot

FORMATS = ("svg", "dot", "mermaid")

_BY_ENDING = {"svg": "svg", "dot": "dot", "gv": "dot", "mmd": "mermaid", "mermaid": "mermaid"}

_EXAMPLES = """\
Links are nodes, joints are edges with their name and type, and modules are boxes around their links. SPEC can also be a
URDF or a xacro.

examples:
  linkforge graph cell.robot.yaml -o cell.svg             a picture for browsers and READMEs, light and dark
  linkforge graph cell.robot.yaml -o cell.dot             for Graphviz: dot -Tpdf cell.dot -o cell.pdf
  linkforge graph cell.robot.yaml -o cell.mmd             for Mermaid, which GitHub draws in Markdown
  linkforge graph arm.urdf --format dot | dot -Tsvg       to standard output
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge graph [options] SPEC [NAME:=VALUE ...] (-o FILE | --format FORMAT)"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="the file to write: .svg, .dot, .gv, .mmd or .mermaid")
    parser.add_argument("--format", choices=FORMATS, help="the format, regardless of the name of the file")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.targets import file_to_write

    form, output = _format_of(arguments), file_to_write(arguments.output)
    one = compile_one(arguments)
    if one is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import refuse_to_replace, write_document

    refuse_to_replace(one.files, [output])
    write_document(_render(one.robot, form), output, arguments)
    return OK


def _format_of(arguments: argparse.Namespace) -> str:
    """Return the format of `--format`, or that of the name of the file."""
    ending = (arguments.output or "").rpartition(".")[2].lower()
    form: str | None = arguments.format or _BY_ENDING.get(ending)
    if form is None:
        found = f", found '{arguments.output}'" if arguments.output else ""
        raise UsageError(f"takes -o with a file that ends in .svg, .dot or .mmd, or --format{found}")
    return form


def _render(robot: Robot, form: str) -> str:
    from linkforge_compile.overview.dot import render_dot
    from linkforge_compile.overview.graph import order_by_module
    from linkforge_compile.overview.mermaid import render_mermaid
    from linkforge_compile.overview.svg import render_svg
    from linkforge_compile.overview.tree import tree_rows

    render = {"svg": render_svg, "dot": render_dot, "mermaid": render_mermaid}[form]
    return render(robot.name, order_by_module(tree_rows(robot)))
