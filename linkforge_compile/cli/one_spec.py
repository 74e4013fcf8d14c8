"""From the words of the command line to a compiled or checked spec: a file, or `-` for standard input."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, TypedDict

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.options import packages_of
from linkforge_compile.limits import FACTOR_VARIABLE, MAX_FILE_BYTES, parse_factor

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.formats.urdf.sensor import Gazebo
    from linkforge_compile.pipeline import Compilation

STDIN = "<stdin>"
"""What standard input is called in diagnostics."""


def one_spec(specs: list[str]) -> str:
    """Return the one spec of a command line; UsageError for none or several."""
    if specs == [""]:
        raise UsageError("takes one spec, found '': is a variable of the shell empty?")
    if len(specs) == 1:
        return specs[0]
    if not specs:
        raise UsageError("takes one spec, found none")
    assignment = next((word for word in specs if "=" in word), None)
    remedy = f"; write '-p {assignment}' to set a parameter" if assignment else ""
    raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}{remedy}")


def compile_spec(
    spec: str,
    assignments: list[str],
    arguments: argparse.Namespace,
    output: Path | None = None,
    text: str | None = None,
) -> Compilation:
    """Compile a spec, `-` for standard input, with the options that every command on a spec has.

    `output` is the folder that the URDF of a file is for, None where that is not known. `text` is what was read
    already of what can be read once only.
    """
    from linkforge_compile.pipeline import compile_file, compile_text

    if spec == "-" or text is not None:
        text = standard_input() if text is None else text
        name = STDIN if spec == "-" else spec
        return compile_text(text, name=name, folder=Path.cwd(), **_settings(assignments, arguments))
    return compile_file(spec, output=output, **_settings(assignments, arguments))


def check_spec(spec: str, assignments: list[str], arguments: argparse.Namespace) -> Compilation:
    """Check a spec, `-` for standard input, with the same options."""
    from linkforge_compile.pipeline import check_file, check_text

    if spec == "-":
        text = standard_input()
        return check_text(text, name=STDIN, folder=Path.cwd(), **_settings(assignments, arguments))
    return check_file(spec, **_settings(assignments, arguments))


class _Settings(TypedDict):
    parameters: list[str]
    packages: dict[str, str]
    variant: str | None
    gazebo: Gazebo
    allow_outside: bool


def _settings(assignments: list[str], arguments: argparse.Namespace) -> _Settings:
    if (factor := os.environ.get(FACTOR_VARIABLE)) and parse_factor(factor) is None:
        raise UsageError(f"{FACTOR_VARIABLE} takes a whole number from 1 to 999999999, found '{factor}'")
    return {
        "parameters": [*arguments.parameters, *assignments],
        "packages": packages_of(arguments),
        "variant": arguments.variant,
        "gazebo": arguments.gazebo,
        "allow_outside": arguments.allow_outside,
    }


def standard_input() -> str:
    """Return the text on standard input, of which no more is read than of a file: a spec in UTF-8, or XML."""
    if sys.stdin is None:
        raise UsageError("cannot read standard input: it is closed")
    return _text(sys.stdin.buffer, "standard input")


def require_file(option: str, word: str | None) -> None:
    """Refuse standard input for what is read beside the robot."""
    if word == "-":
        raise UsageError(f"{option} takes a file; standard input may be the robot")


def once_only(word: str) -> str | None:
    """Return the text of what can be read once only, standard input or a pipe; None for a file."""
    if word == "-":
        return standard_input()
    try:
        if not stat.S_ISFIFO(os.stat(word).st_mode):  # noqa: PTH116
            return None
        with Path(word).open("rb") as pipe:
            return _text(pipe, f"'{word}'")
    except (OSError, ValueError):
        # Who reads it as a file tells why it cannot be read.
        return None


def is_xml(word: str, text: str | None) -> bool:
    """Whether a robot is XML, by its name or by how it begins; `text` is what was read of it already."""
    from linkforge_compile.source.encoding import begins_xml

    if Path(word).suffix.lower() in {".urdf", ".xml", ".xacro"}:
        return True
    if text is not None:
        return begins_xml(text)
    try:
        with Path(word).open("rb") as file:
            return begins_xml(file.read(_HEAD))
    except (OSError, ValueError):
        return False


_HEAD = 4096
"""Within so many bytes a URDF begins."""


def _text(stream: BinaryIO, name: str) -> str:
    content = stream.read(MAX_FILE_BYTES + 1)
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(f"{name} is larger than {MAX_FILE_BYTES // 1024**2} MiB")
    from linkforge_compile.source.encoding import EncodingError, begins_xml, xml_text

    try:
        return xml_text(content) if begins_xml(content) else content.decode("utf-8")
    except EncodingError as error:
        raise UsageError(f"{name} cannot be read: {error}") from None
    except UnicodeDecodeError as error:
        raise UsageError(f"{name} is not UTF-8: {error.reason} at byte {error.start}") from None
