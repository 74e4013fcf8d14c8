"""`linkforge check`: all that is wrong with specs, every error at once."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import add_spec_options, packages_of, split_assignments, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Diagnostic

_EXAMPLES = """\
A required parameter without a value is no error here: what depends on it is not judged.

examples:
  linkforge check robots/*.robot.yaml
  linkforge check arm.robot.yaml hardware:=mock
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="SPEC", nargs="+", help="specs, NAME.robot.yaml")
    add_spec_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.diagnostics.render import summary
    from linkforge_compile.pipeline import check_file

    specs, assignments = split_assignments(arguments.words)
    if not specs:
        raise UsageError("takes at least one spec")
    packages = packages_of(arguments)
    # Specs that use one module share its faults: each is told and counted once.
    told: dict[str, Diagnostic] = {}
    faulty = False
    for spec in specs:
        compilation = check_file(spec, parameters=[*arguments.parameters, *assignments], packages=packages)
        new = {str(diagnostic): diagnostic for diagnostic in compilation.diagnostics if str(diagnostic) not in told}
        tell(new.values())
        told |= new
        faulty |= compilation.robot is None
    print(f"checked {len(specs)} spec{'s' if len(specs) > 1 else ''}: {summary(told.values())}", file=sys.stderr)
    return FAULTY_SPEC if faulty else OK
