"""Diagnostics as one JSON object, for programs; docs/diagnostics.schema.json is its schema."""

from __future__ import annotations

import json
from collections.abc import Iterable

from linkforge_compile.diagnostics.diagnostic import Diagnostic
from linkforge_compile.source import Span

VERSION = 1
"""Grows when a program that reads the object must change; a new key is no such change."""


def render_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Return the object; columns count characters from 1, and the end is just behind the last one."""
    whole = {"version": VERSION, "diagnostics": [_object(diagnostic) for diagnostic in diagnostics]}
    return json.dumps(whole, ensure_ascii=False, indent=2) + "\n"


def _object(diagnostic: Diagnostic) -> dict[str, object]:
    return {
        "code": diagnostic.code.id,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        **_place(diagnostic.span),
        "notes": [{"message": note.message, **_place(note.span)} for note in diagnostic.notes],
        "help": diagnostic.code.help,
    }


def _place(span: Span | None) -> dict[str, object]:
    if span is None:
        return dict.fromkeys(("file", "line", "column", "end_line", "end_column"))
    return {
        "file": span.file.shown,
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
    }
