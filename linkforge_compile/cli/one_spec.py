"""The commands that take one spec: its name among the words of the command line, and what compiling it gives."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.options import packages_of

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.pipeline import Compilation


def one_spec(specs: list[str]) -> str:
    """Return the one spec of a command line; UsageError for none or several."""
    if len(specs) == 1:
        return specs[0]
    if not specs:
        raise UsageError("takes one spec, found none")
    assignment = next((word for word in specs if "=" in word), None)
    remedy = f"; write '-p {assignment}' to set a parameter" if assignment else ""
    raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}{remedy}")


def compile_spec(spec: str, assignments: list[str], arguments: argparse.Namespace) -> Compilation:
    """Compile a spec, `-` for standard input, with the options that every command on a spec has."""
    from linkforge_compile.pipeline import compile_file, compile_text

    parameters, packages = [*arguments.parameters, *assignments], packages_of(arguments)
    variant, gazebo = arguments.variant, arguments.gazebo
    if spec != "-":
        return compile_file(spec, parameters=parameters, packages=packages, variant=variant, gazebo=gazebo)
    try:
        text = sys.stdin.buffer.read().decode("utf-8")
    except UnicodeDecodeError as error:
        raise UsageError(f"standard input is not UTF-8: {error.reason} at byte {error.start}") from None
    return compile_text(
        text,
        name="<stdin>",
        folder=Path.cwd(),
        parameters=parameters,
        packages=packages,
        variant=variant,
        gazebo=gazebo,
    )
