"""Reads the input of a command, a file or `-` for standard input, and compiles or checks it."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.options import format_options_of, packages_of
from linkforge_compile.limits import FACTOR_VARIABLE, MAX_FILE_BYTES, parse_factor

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.pipeline import Compilation, Settings

STDIN = "<stdin>"
"""The name of standard input in diagnostics."""


def require_one_spec(specs: list[str]) -> str:
    """Return the only spec of a command line; UsageError if there is none, or several."""
    if specs == [""]:
        raise UsageError("takes one spec, found '': is a variable of the shell empty?")
    if len(specs) == 1:
        return specs[0]
    if not specs:
        raise UsageError("takes one spec, found none")
    assignment = next((word for word in specs if "=" in word), None)
    hint = f"; write '-p {assignment}' to set a parameter" if assignment else ""
    raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}{hint}")


def compile_spec(
    spec: str,
    assignments: list[str],
    arguments: argparse.Namespace,
    *,
    output: Path | None = None,
    text: str | None = None,
    formats: tuple[str, ...] = (),
) -> Compilation:
    """Compile a spec with the options of `add_spec_options`.

    `output` is the folder of the documents, None if unknown. `text` is the content of a spec that was read already,
    because it can be read only once. `formats` are the requested ones.
    """
    from linkforge_compile.pipeline import compile_path, compile_source

    settings = settings_of(assignments, arguments)._replace(formats=formats)
    if spec == "-" or text is not None:
        text = read_stdin() if text is None else text
        return compile_source(text, STDIN if spec == "-" else spec, Path.cwd(), settings)
    return compile_path(spec, settings._replace(output=output))


def check_spec(spec: str, assignments: list[str], arguments: argparse.Namespace) -> Compilation:
    """Check a spec with the options of `add_spec_options`."""
    from linkforge_compile.pipeline import compile_path, compile_source

    settings = check_settings_of(assignments, arguments)
    if spec == "-":
        return compile_source(read_stdin(), STDIN, Path.cwd(), settings)
    return compile_path(spec, settings)


def check_settings_of(assignments: list[str], arguments: argparse.Namespace) -> Settings:
    """Return the settings of a check, for which a parameter may lack its value."""
    from linkforge_compile.expand import Unset

    return settings_of(assignments, arguments)._replace(unset=Unset.NOTE)


def settings_of(assignments: list[str], arguments: argparse.Namespace) -> Settings:
    """Return what the options that every command on a spec has say; UsageError for a wrong value."""
    from linkforge_compile.pipeline import Settings

    if (factor := os.environ.get(FACTOR_VARIABLE)) and parse_factor(factor) is None:
        raise UsageError(f"{FACTOR_VARIABLE} takes a whole number from 1 to 999999999, found '{factor}'")
    return Settings(
        [*arguments.parameters, *assignments],
        packages_of(arguments),
        arguments.variant,
        format_options_of(arguments),
        allow_outside=arguments.allow_outside,
    )


def read_stdin() -> str:
    """Return the text on standard input, a spec in UTF-8 or XML; UsageError if it is larger than a file may be."""
    if sys.stdin is None:
        raise UsageError("cannot read standard input: it is closed")
    return _read_text(sys.stdin.buffer, "standard input")


def require_file(option: str, word: str | None) -> None:
    """Refuse `-` as the value of an option, because standard input may be the robot."""
    if word == "-":
        raise UsageError(f"{option} takes a file; standard input may be the robot")


def read_unseekable(word: str) -> str | None:
    """Return the text of standard input or a pipe, which can be read only once; None for a file."""
    if word == "-":
        return read_stdin()
    try:
        if not stat.S_ISFIFO(os.stat(word).st_mode):  # noqa: PTH116
            return None
        with Path(word).open("rb") as pipe:
            return _read_text(pipe, f"'{word}'")
    except (OSError, ValueError):
        return None  # reading it as a file reports the reason


def is_xml(word: str, text: str | None) -> bool:
    """Whether a robot is XML, by its name or its first bytes; `text` is its content if it was read already."""
    from linkforge_compile.source.characters import begins_xml

    if Path(word).suffix.lower() in {".urdf", ".xml", ".xacro"}:
        return True
    if text is not None:
        return begins_xml(text)
    try:
        with Path(word).open("rb") as file:
            return begins_xml(file.read(4096))
    except (OSError, ValueError):
        return False


def _read_text(stream: BinaryIO, name: str) -> str:
    content = stream.read(MAX_FILE_BYTES + 1)
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(f"{name} is larger than {MAX_FILE_BYTES // 1024**2} MiB")
    from linkforge_compile.source.characters import EncodingError, begins_xml, xml_text

    try:
        return xml_text(content) if begins_xml(content) else content.decode("utf-8")
    except EncodingError as error:
        raise UsageError(f"{name} cannot be read: {error}") from None
    except UnicodeDecodeError as error:
        raise UsageError(f"{name} is not UTF-8: {error.reason} at byte {error.start}") from None
