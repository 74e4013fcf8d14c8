"""Diagnostics as GitHub's workflow commands, which show each at its line of a pull request."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note, Severity
from linkforge_compile.diagnostics.render.under_root import name_under
from linkforge_compile.source import Span
from linkforge_compile.source.characters import on_one_line

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def render_github(diagnostics: Iterable[Diagnostic], *, root: Path) -> str:
    """Return a command a line, the worst first: GitHub shows ten of each kind for a step and drops the rest.

    `root` is the folder of the repository.
    """
    severities = list(_COMMANDS)
    worst_first = sorted(diagnostics, key=lambda diagnostic: severities.index(diagnostic.severity))
    return "".join(f"{_command(diagnostic, root)}\n" for diagnostic in worst_first)


def _command(diagnostic: Diagnostic, root: Path) -> str:
    properties = [*_place(diagnostic.span, root), ("title", diagnostic.code.id)]
    text = "\n".join((_message(diagnostic), *map(_told, diagnostic.notes)))
    listed = ",".join(f"{name}={_property(str(value))}" for name, value in properties)
    return f"::{_COMMANDS[diagnostic.severity]} {listed}::{_data(text)}"


def _place(span: Span | None, root: Path) -> Iterator[tuple[str, str | int]]:
    if span is None or span.file.path is None:
        return
    yield "file", on_one_line(name_under(root, span.file) or span.file.name)
    yield "line", span.line
    # The API behind the commands takes columns only where start and end are on one line.
    if span.line == span.end_line:
        yield "col", span.column
        yield "endLine", span.end_line
        yield "endColumn", span.end_column
    else:
        yield "endLine", span.end_line


def _message(diagnostic: Diagnostic) -> str:
    span = diagnostic.span
    # The command line and standard input are no files that GitHub could show.
    return diagnostic.message if span is None or span.file.path else f"{span}: {diagnostic.message}"


def _told(note: Note) -> str:
    return f"{note.message}: {note.span}" if note.span else note.message


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
