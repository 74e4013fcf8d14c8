"""`linkforge expand`: a spec with all its modules as one flat spec, with a comment on where each part was written."""

from __future__ import annotations

import argparse
from pathlib import Path

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import add_spec_and_values, add_spec_options
from linkforge_compile.cli.reports import add_report_options
from linkforge_compile.cli.specs import compile_one
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.source.characters import on_one_line

_EXAMPLES = """\
The result has no modules, parameters, expressions, loops or defaults, and compiles to the same URDF and SRDF. A comment
on each part shows where it was written. Relative mesh paths are those of the compiled robot, so keep the file beside
the spec.

examples:
  linkforge expand cell.robot.yaml
  linkforge expand cell.robot.yaml -o flat.robot.yaml reach:=0.7m
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge expand [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="write to a file instead of standard output")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    one = compile_one(arguments)
    if one is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import refuse_to_replace, write_document
    from linkforge_compile.export_spec import write_spec

    output = file_to_write(arguments.output)
    refuse_to_replace(one.files, [output])
    name = on_one_line(Path(one.spec).name)
    banner = None if one.spec == "-" else f"Expanded by linkforge from {name}; edit that file, not this one."
    write_document(write_spec(one.robot, banner=banner, origins=True), output, arguments)
    return OK
