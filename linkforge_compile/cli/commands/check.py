"""`linkforge check`: all that is wrong with specs, every error at once."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import add_spec_options, packages_of, split_assignments, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.pipeline import Compilation

_EXAMPLES = """\
A required parameter without a value is no error here: what depends on it is not judged.

examples:
  linkforge check robots/*.robot.yaml
  linkforge check arm.robot.yaml hardware:=mock
  linkforge check --all-variants arm.robot.yaml     with the defaults and with each of its variants
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="SPEC", nargs="+", help="specs, NAME.robot.yaml")
    parser.add_argument(
        "--all-variants", action="store_true", help="check the defaults and every variant of each spec, in one report"
    )
    add_spec_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.diagnostics.render import summary
    from linkforge_compile.pipeline import check_file, check_variants

    specs, assignments = split_assignments(arguments.words)
    if not specs:
        raise UsageError("takes at least one spec")
    if arguments.all_variants and arguments.variant is not None:
        raise UsageError("takes --variant or --all-variants, not both")
    parameters, packages = [*arguments.parameters, *assignments], packages_of(arguments)
    # Specs that use one module share its faults: each is told and counted once.
    told: dict[str, Diagnostic] = {}
    faulty, variants = False, 0
    for spec in specs:
        if arguments.all_variants:
            compilations = check_variants(spec, parameters=parameters, packages=packages, gazebo=arguments.gazebo)
            variants += len(compilations) - 1
        else:
            one = check_file(
                spec, parameters=parameters, packages=packages, variant=arguments.variant, gazebo=arguments.gazebo
            )
            compilations = {arguments.variant: one}
        report = _one_report(compilations)
        new = {str(diagnostic): diagnostic for diagnostic in report if str(diagnostic) not in told}
        tell(new.values())
        told |= new
        faulty |= any(compilation.has_errors for compilation in compilations.values())
    checked = f"checked {_counted(len(specs), 'spec')}"
    if arguments.all_variants:
        checked += f" with the defaults and {_counted(variants, 'variant')}"
    print(f"{checked}: {summary(told.values())}", file=sys.stderr)
    return FAULTY_SPEC if faulty else OK


def _one_report(compilations: Mapping[str | None, Compilation]) -> tuple[Diagnostic, ...]:
    from linkforge_compile.diagnostics.runs import told_once

    runs = {
        "the defaults" if variant is None else f"variant '{variant}'": compilation.diagnostics
        for variant, compilation in compilations.items()
    }
    return told_once(runs, every="the defaults and every variant")


def _counted(count: int, noun: str) -> str:
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"
