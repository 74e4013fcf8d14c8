"""Render diagnostics for programs: JSON, GitHub's workflow commands, and SARIF 2.1.0 (OASIS)."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from urllib.parse import quote

from linkforge_compile.diagnostics.diagnostic import Code, Diagnostic, Severity
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line

JSON_VERSION = 1
"""Grows when a program that reads the JSON must change; a new key is no such change."""

_GITHUB_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}

_SARIF_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_SARIF_ROOT = "%SRCROOT%"


def render_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Return one JSON object, of which docs/diagnostics.schema.json is the schema.

    Columns count characters from 1, and the end is just after the last one.
    """
    listed = [
        {
            "code": diagnostic.code.id,
            "severity": diagnostic.severity.value,
            "message": diagnostic.message,
            **_json_place(diagnostic.span),
            "notes": [{"message": note.message, **_json_place(note.span)} for note in diagnostic.notes],
            "help": diagnostic.code.help,
            "fixes": [_json_fix(fix) for fix in diagnostic.fixes],
        }
        for diagnostic in diagnostics
    ]
    return json.dumps({"version": JSON_VERSION, "diagnostics": listed}, ensure_ascii=False, indent=2) + "\n"


def _json_fix(fix: Fix) -> dict[str, object]:
    edits = [{**_json_place(edit.span), "text": edit.text} for edit in fix.edits]
    return {"title": fix.title, "is_safe": fix.is_safe, "edits": edits}


def _json_place(span: Span | None) -> dict[str, object]:
    if span is None:
        return dict.fromkeys(("file", "line", "column", "end_line", "end_column"))
    return {
        "file": span.file.shown,
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
    }


def render_github(diagnostics: Iterable[Diagnostic], *, root: Path) -> str:
    """Return a workflow command a line, which GitHub shows at the line of a pull request; the worst come first.

    GitHub shows ten of each severity for a step and drops the rest. `root` is the folder of the repository.
    """
    severities = list(_GITHUB_COMMANDS)
    worst_first = sorted(diagnostics, key=lambda diagnostic: severities.index(diagnostic.severity))
    return "".join(f"{_github_command(diagnostic, root)}\n" for diagnostic in worst_first)


def _github_command(diagnostic: Diagnostic, root: Path) -> str:
    span = diagnostic.span
    properties = [*_github_place(span, root), ("title", diagnostic.code.id)]
    # GitHub can show no line of the command line and of standard input, so the message names the place.
    message = diagnostic.message if span is None or span.file.path else f"{span}: {diagnostic.message}"
    notes = (f"{note.message}: {note.span}" if note.span else note.message for note in diagnostic.notes)
    listed = ",".join(f"{name}={_github_property(str(value))}" for name, value in properties)
    text = _github_data("\n".join((message, *notes)))
    return f"::{_GITHUB_COMMANDS[diagnostic.severity]} {listed}::{text}"


def _github_place(span: Span | None, root: Path) -> Iterator[tuple[str, str | int]]:
    if span is None or span.file.path is None:
        return
    yield "file", on_one_line(_name_under(root, span.file) or span.file.name)
    yield "line", span.line
    # The API of GitHub accepts columns only if start and end are on one line.
    if span.line == span.end_line:
        yield "col", span.column
        yield "endLine", span.end_line
        yield "endColumn", span.end_column
    else:
        yield "endLine", span.end_line


def _github_data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _github_property(text: str) -> str:
    return _github_data(text).replace(":", "%3A").replace(",", "%2C")


def render_sarif(
    diagnostics: Iterable[Diagnostic], *, root: Path, version: str, manual: Callable[[Code], str], pages: Path
) -> str:
    """Return a log of one run; paths under `root`, the folder of the repository, are relative to it.

    `version` is that of linkforge. `manual` returns the page of a code in Markdown, and `pages` is the folder of all.
    """
    diagnostics = tuple(diagnostics)
    codes = sorted({one.code.id: one.code for one in diagnostics}.values(), key=lambda code: code.id)
    indexes = {code.id: index for index, code in enumerate(codes)}
    rules = [_sarif_rule(code, manual(code), pages) for code in codes]
    run = {
        "tool": {"driver": {"name": "linkforge", "version": version, "rules": rules}},
        # The default would be UTF-16 code units.
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_SARIF_ROOT: {"uri": f"{root.as_uri().rstrip('/')}/"}},
        "results": [_sarif_result(one, indexes[one.code.id], root) for one in diagnostics],
    }
    log = {"$schema": _SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(log, ensure_ascii=False, indent=2) + "\n"


def _sarif_rule(code: Code, page: str, pages: Path) -> dict[str, object]:
    # The paragraph below the heading explains the code.
    paragraphs = [" ".join(paragraph.split()) for paragraph in page.split("\n\n")]
    return {
        "id": code.id,
        "shortDescription": {"text": code.title},
        "fullDescription": {"text": paragraphs[1] if len(paragraphs) > 1 else code.title},
        "help": {"text": code.help, "markdown": page},
        "helpUri": (pages / f"{code.id}.md").as_uri(),
        "defaultConfiguration": {"level": code.severity.value},
    }


def _sarif_result(diagnostic: Diagnostic, rule: int, root: Path) -> dict[str, object]:
    text = "\n".join((diagnostic.message, *(note.message for note in diagnostic.notes if note.span is None)))
    result: dict[str, object] = {
        "ruleId": diagnostic.code.id,
        "ruleIndex": rule,
        "level": diagnostic.severity.value,
        "message": {"text": text},
    }
    if diagnostic.span:
        result["locations"] = [{"physicalLocation": _sarif_place(diagnostic.span, root)}]
    related = [
        {"message": {"text": note.message}, "physicalLocation": _sarif_place(note.span, root)}
        for note in diagnostic.notes
        if note.span
    ]
    fixes = [_sarif_fix(fix, root) for fix in diagnostic.fixes]
    return result | ({"relatedLocations": related} if related else {}) | ({"fixes": fixes} if fixes else {})


def _sarif_fix(fix: Fix, root: Path) -> dict[str, object]:
    changes: dict[SourceFile, list[dict[str, object]]] = {}
    for edit in fix.edits:
        replacement = {"deletedRegion": _sarif_region(edit.span), "insertedContent": {"text": edit.text}}
        changes.setdefault(edit.span.file, []).append(replacement)
    return {
        "description": {"text": fix.title},
        "artifactChanges": [
            {"artifactLocation": _sarif_artifact(file, root), "replacements": replacements}
            for file, replacements in changes.items()
        ],
    }


def _sarif_place(span: Span, root: Path) -> dict[str, object]:
    return {"artifactLocation": _sarif_artifact(span.file, root), "region": _sarif_region(span)}


def _sarif_region(span: Span) -> dict[str, object]:
    return {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }


def _sarif_artifact(file: SourceFile, root: Path) -> dict[str, object]:
    # A name that is not UTF-8 is quoted byte by byte.
    if name := _name_under(root, file):
        return {"uri": quote(name, errors="surrogateescape"), "uriBaseId": _SARIF_ROOT}
    if path := _absolute(file):
        return {"uri": path.as_uri()}
    return {"uri": quote(file.name, errors="surrogateescape")}


def _name_under(root: Path, file: SourceFile) -> str | None:
    """Return a file's path from the root, with slashes; None if it is elsewhere, or not a file."""
    path = _absolute(file)
    return path.relative_to(root).as_posix() if path and path.is_relative_to(root) else None


def _absolute(file: SourceFile) -> Path | None:
    """Return a file's absolute path, None for no file; links are not followed, so one in the repository stays in it."""
    # Path.absolute would keep the `..` that the user wrote.
    return Path(os.path.abspath(file.path)) if file.path else None  # noqa: PTH100
