"""`linkforge import`: a URDF and its SRDF as a spec."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    STDIN,
    add_outside_option,
    add_package_option,
    add_parameter_option,
    packages_of,
    read_stdin,
    require_file,
    require_one_spec,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, print_failure, progress_after, report
from linkforge_compile.cli.targets import file_to_write, imported_spec
from linkforge_compile.diagnostics import Diagnostic, Severity

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.importing import Import

_EXAMPLES = """\
The spec compiles to the same robot. Elements that the language cannot express are kept as raw XML in `extra`; a
diagnostic reports anything that cannot be kept. Relative mesh paths are not changed, so keep the spec beside the URDF;
a diagnostic reports paths that do not resolve from another folder.

examples:
  linkforge import arm.urdf
  linkforge import arm.urdf -o arm.robot.yaml --strict
  linkforge import arm.urdf --srdf arm.srdf -o arm.robot.yaml
  linkforge import ur.urdf.xacro --srdf ur.srdf.xacro ur_type:=ur5e -o .    each gets the arguments that it has
  linkforge import --refresh ur.robot.yaml            again, from the vendor's new files, with the command in the spec
  linkforge import --refresh ur.robot.yaml --check    only report the changes, and overrides that no longer fit
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = (
        "linkforge import [options] ROBOT.urdf | ROBOT.urdf.xacro [ARGUMENT:=VALUE ...]\n"
        "       linkforge import --refresh SPEC.robot.yaml [--check]"
    )
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words",
        metavar="ROBOT.urdf",
        nargs="+",
        help="the robot; a file .xacro is expanded first; - for a URDF on standard input",
    )
    parser.add_argument("--srdf", metavar="ROBOT.srdf", help="the SRDF of the same robot, or a xacro of it")
    parser.add_argument(
        "-o", "--output", metavar="PATH", help="a file that ends in .yaml, or a folder for NAME.robot.yaml"
    )
    parser.add_argument("--force", action="store_true", help="replace an existing spec with other content")
    parser.add_argument("--refresh", action="store_true", help="import a spec again, with the command at its top")
    parser.add_argument(
        "--check", action="store_true", help="with --refresh: write nothing; exit code 1 if there is something to write"
    )
    parser.add_argument("--strict", action="store_true", help="if something cannot be kept, write nothing and fail")
    add_parameter_option(parser, "set an argument of the xacro files")
    add_package_option(parser)
    add_outside_option(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    if arguments.refresh:
        from linkforge_compile.cli.refresh import refresh

        return refresh(arguments, add_arguments)
    if arguments.check:
        raise UsageError("--check is for --refresh")
    files, assignments = split_assignments(arguments.words)
    _refuse_other_kinds(files)
    urdf = require_one_spec(files)
    from linkforge_compile.cli.output import refuse_to_replace

    require_file("--srdf", arguments.srdf)
    given = [Path(file) for file in (urdf, arguments.srdf) if file is not None]
    refuse_to_replace(given, [file_to_write(arguments.output)])
    output = imported_spec(urdf, arguments.output)
    from linkforge_compile.importing import import_urdf

    with progress_after(f"reading {urdf}", arguments):
        imported = import_urdf(
            STDIN if urdf == "-" else urdf,
            srdf=arguments.srdf,
            arguments=[*arguments.parameters, *assignments],
            packages=packages_of(arguments),
            allow_outside=arguments.allow_outside,
            output=output.parent if output else None,
            text=read_stdin() if urdf == "-" else None,
        )
    diagnostics = _with_losses_as_errors(imported) if arguments.strict else imported.diagnostics
    is_faulty = report(diagnostics, arguments) or imported.has_errors
    if imported.text is None:
        return FAULTY_SPEC
    if arguments.strict and is_faulty:
        print_failure(f"nothing written: {_reason(imported.losses)}", arguments)
        return FAULTY_SPEC
    text = imported.origin.with_head(imported.text, output) if imported.origin else imported.text
    _write(text, output, arguments)
    return FAULTY_SPEC if is_faulty else OK


def _with_losses_as_errors(imported: Import) -> list[Diagnostic]:
    from linkforge_compile.diagnostics.codes.importing import LOSSES

    return [
        replace(one, severity_override=Severity.ERROR) if one.code in LOSSES else one for one in imported.diagnostics
    ]


def _reason(losses: tuple[Diagnostic, ...]) -> str:
    if not losses:
        return "there are errors"
    count = sum(1 + loss.omitted for loss in losses)
    codes = sorted({loss.code.id for loss in losses})
    return f"{count} {'loss' if count == 1 else 'losses'} ({', '.join(codes)})"


def _refuse_other_kinds(files: list[str]) -> None:
    """Refuse an SRDF without its URDF, and a spec."""
    srdf = next((file for file in files if file.lower().endswith((".srdf", ".srdf.xacro"))), None)
    if srdf:
        robot = next((file for file in files if file != srdf), "ROBOT.urdf")
        raise UsageError(f"'{srdf}' is an SRDF; pass it with its robot: linkforge import {robot} --srdf {srdf}")
    if len(files) == 1 and files[0].lower().endswith((".yaml", ".yml")):
        raise UsageError(f"'{files[0]}' is a spec already; import takes a URDF or a xacro of one")


def _write(text: str, output: Path | None, arguments: argparse.Namespace) -> None:
    from linkforge_compile.cli.output import write_document

    if output and output.is_file() and not arguments.force and output.read_bytes() != text.encode("utf-8"):
        # Once imported, a spec belongs to the user: do not lose what was changed in it.
        raise UsageError(f"'{output}' exists with other content; use --force to replace it")
    write_document(text, output, arguments)
