"""From the words of the command line to a compiled or checked spec: a file, or `-` for standard input."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from linkforge_compile.bounds import MAX_FILE_BYTES
from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.options import packages_of

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.backends.urdf.sensor import Gazebo
    from linkforge_compile.pipeline import Compilation

STDIN = "<stdin>"
"""What standard input is called in diagnostics."""


def one_spec(specs: list[str]) -> str:
    """Return the one spec of a command line; UsageError for none or several."""
    if len(specs) == 1:
        return specs[0]
    if not specs:
        raise UsageError("takes one spec, found none")
    assignment = next((word for word in specs if "=" in word), None)
    remedy = f"; write '-p {assignment}' to set a parameter" if assignment else ""
    raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}{remedy}")


def compile_spec(
    spec: str, assignments: list[str], arguments: argparse.Namespace, output: Path | None = None
) -> Compilation:
    """Compile a spec, `-` for standard input, with the options that every command on a spec has.

    `output` is the folder that the URDF of a file is for, None where that is not known.
    """
    from linkforge_compile.pipeline import compile_file, compile_text

    if spec == "-":
        text = _standard_input()
        return compile_text(text, name=STDIN, folder=Path.cwd(), **_settings(assignments, arguments))
    return compile_file(spec, output=output, **_settings(assignments, arguments))


def check_spec(spec: str, assignments: list[str], arguments: argparse.Namespace) -> Compilation:
    """Check a spec, `-` for standard input, with the same options."""
    from linkforge_compile.pipeline import check_file, check_text

    if spec == "-":
        text = _standard_input()
        return check_text(text, name=STDIN, folder=Path.cwd(), **_settings(assignments, arguments))
    return check_file(spec, **_settings(assignments, arguments))


class _Settings(TypedDict):
    parameters: list[str]
    packages: dict[str, str]
    variant: str | None
    gazebo: Gazebo
    allow_outside: bool


def _settings(assignments: list[str], arguments: argparse.Namespace) -> _Settings:
    return {
        "parameters": [*arguments.parameters, *assignments],
        "packages": packages_of(arguments),
        "variant": arguments.variant,
        "gazebo": arguments.gazebo,
        "allow_outside": arguments.allow_outside,
    }


def _standard_input() -> str:
    """Return the text on standard input, of which no more is read than of a file."""
    if sys.stdin is None:
        raise UsageError("cannot read standard input: it is closed")
    content = sys.stdin.buffer.read(MAX_FILE_BYTES + 1)
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(f"standard input is larger than {MAX_FILE_BYTES // 1024**2} MiB")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise UsageError(f"standard input is not UTF-8: {error.reason} at byte {error.start}") from None
