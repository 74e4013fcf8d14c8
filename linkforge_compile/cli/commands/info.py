"""`linkforge info`: prints the figures of a robot that are asked for first."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import add_spec_and_values, add_spec_options, packages_of
from linkforge_compile.cli.reports import add_report_options
from linkforge_compile.cli.specs import compile_one

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.listing import Listing

_EXAMPLES = """\
It prints links and joints, degrees of freedom, mass and its centre, reach, size, mesh files, sensors, hardware,
controllers, planning groups, parameters and modules. The reach is an upper bound, and the size includes meshes if the
extra `mesh` is installed. SPEC can also be a URDF or a xacro.

examples:
  linkforge info arm.robot.yaml
  linkforge info arm.robot.yaml reach:=0.7m --variant lab
  linkforge info arm.urdf.xacro model:=x5
  linkforge info arm.robot.yaml --json            for tools; numbers are in SI units
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge info [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    parser.add_argument("--json", action="store_true", help="as JSON, for tools")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    one = compile_one(arguments)
    if one is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.overview.figures import figures_of
    from linkforge_compile.overview.figures_text import figures_document, render_figures

    figures, listing = figures_of(one.robot), _listing(one.spec, arguments)
    if arguments.json:
        write_to_stdout(json_text(figures_document(figures, listing)))
    else:
        write_to_stdout("".join(f"{line}\n" for line in render_figures(figures, listing)))
    return OK


def _listing(spec: str, arguments: argparse.Namespace) -> Listing | None:
    """Return the parameters of a file; None for standard input, which can be read only once."""
    from linkforge_compile.pipeline import parameters_of

    if not Path(spec).is_file():
        return None
    listing, _ = parameters_of(spec, packages=packages_of(arguments), allow_outside=arguments.allow_outside)
    return listing
