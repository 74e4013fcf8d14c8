"""`linkforge deps`: the files from which a robot is compiled, for build systems."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import (
    add_format_options,
    add_spec_and_values,
    add_spec_options,
    compile_spec,
    refuse_options_of_other_formats,
    require_one_spec,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, report
from linkforge_compile.cli.targets import (
    add_for_option,
    add_output_option,
    default_format,
    name_of,
    refuse_formats_as_specs,
    targets_of,
)

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.cli.targets import Targets
    from linkforge_compile.pipeline import Compilation

FORMATS = ("make", "json")

_EXAMPLES = """\
It lists the spec, the files that it includes and uses, data files, xacro files, meshes whose inertia is computed, the
meshes of an MJCF, and the meshes and textures of an SDF with --meshes file; and linkforge's own templates of the
format, and its version. The format is URDF, unless -o or --for name other files.

examples:
  linkforge deps arm.robot.yaml                       arm.urdf: arm.robot.yaml ...
  linkforge deps arm.robot.yaml -o build/arm.urdf     build/arm.urdf: arm.robot.yaml ...
  linkforge deps arm.robot.yaml -o build/ --for mjcf  build/arm.mjcf: arm.robot.yaml ...
  linkforge deps arm.robot.yaml -o arm.sdf --meshes file    arm.sdf: arm.robot.yaml ... meshes/hand.stl
  linkforge deps arm.robot.yaml --format json         for other tools, also for a spec with errors

In JSON, "files" are the files of the robot, "unread" those that could not be read, and "linkforge" the compiler's own.
For a spec with errors, which has no output, no Make rule is printed.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge deps [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    add_output_option(parser)
    parser.add_argument("--format", choices=FORMATS, default="make", help="a Make rule (default), or JSON")
    add_for_option(parser, "the outputs of this format; repeat it for others")
    add_spec_options(parser)
    add_format_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_to_stdout

    specs, assignments = split_assignments(arguments.words)
    refuse_formats_as_specs(specs, "--for")
    spec = require_one_spec(specs)
    targets = _targets(spec, arguments.outputs, arguments.formats)
    refuse_options_of_other_formats(arguments, targets.formats, "--for")
    compilation = compile_spec(spec, assignments, arguments, formats=targets.formats)
    is_faulty = report(compilation.diagnostics, arguments)
    if arguments.format == "json":
        write_to_stdout(_json_text(compilation, targets))
    elif not is_faulty:
        from linkforge_compile.cli.output import inputs_of, make_rules

        targets.require_files("a Make rule", "lists what files are made from")
        inputs = inputs_of(compilation.files, targets.template_folders)
        write_to_stdout(make_rules(_outputs(targets, compilation), inputs))
    return FAULTY_SPEC if is_faulty else OK


def _targets(spec: str, outputs: list[str], chosen: list[str]) -> Targets:
    """Return the targets of the outputs, that of one format if there are none."""
    name = name_of(spec)
    return targets_of(name, outputs or ["./" if chosen else f"{name}{default_format().suffix}"], chosen)


def _outputs(targets: Targets, compilation: Compilation) -> tuple[Path, ...]:
    """Return the files that `linkforge compile` would write."""
    from linkforge_compile.cli.build import targets_for

    assert compilation.robot is not None, "a spec without errors has a robot"
    needed, faults = targets_for(compilation.robot, targets)
    return (targets if faults else needed).files


def _json_text(compilation: Compilation, targets: Targets) -> str:
    from linkforge_compile.cli.output import json_text
    from linkforge_compile.resources import compiler_files

    document = {
        "version": 1,
        "files": list(map(str, compilation.files)),
        "unread": list(map(str, compilation.unread)),
        "linkforge": list(map(str, compiler_files(targets.template_folders))),
    }
    return json_text(document)
