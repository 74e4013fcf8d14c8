"""Diagnostics as SARIF 2.1.0 (OASIS), which code hosts and editors show as alerts."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from urllib.parse import quote

from linkforge_compile.diagnostics.diagnostic import Code, Diagnostic, Note
from linkforge_compile.diagnostics.render.under_root import absolute, name_under
from linkforge_compile.source import Span

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_ROOT = "%SRCROOT%"


def render_sarif(
    diagnostics: Iterable[Diagnostic], *, root: Path, version: str, manual: Callable[[Code], str] | None = None
) -> str:
    """Return a log of one run; paths are relative to `root`, the folder of the repository, where they lie under it.

    `version` is that of linkforge, `manual` gives a code's page in Markdown.
    """
    told = tuple(diagnostics)
    codes = sorted({diagnostic.code.id: diagnostic.code for diagnostic in told}.values(), key=lambda code: code.id)
    places = {code.id: index for index, code in enumerate(codes)}
    run = {
        "tool": {"driver": {"name": "linkforge", "version": version, "rules": [_rule(code, manual) for code in codes]}},
        # Ours count characters, where UTF-16 code units would be meant by default.
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"uri": f"{root.as_uri().rstrip('/')}/"}},
        "results": [_result(diagnostic, places[diagnostic.code.id], root) for diagnostic in told],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, ensure_ascii=False, indent=2) + "\n"


def _rule(code: Code, manual: Callable[[Code], str] | None) -> dict[str, object]:
    help_ = {"text": code.help, "markdown": manual(code)} if manual else {"text": code.help}
    return {
        "id": code.id,
        "shortDescription": {"text": code.title},
        "help": help_,
        "defaultConfiguration": {"level": code.severity.value},
    }


def _result(diagnostic: Diagnostic, rule: int, root: Path) -> dict[str, object]:
    result: dict[str, object] = {
        "ruleId": diagnostic.code.id,
        "ruleIndex": rule,
        "level": diagnostic.severity.value,
        "message": {"text": _text(diagnostic)},
    }
    if diagnostic.span:
        result["locations"] = [{"physicalLocation": _place(diagnostic.span, root)}]
    if related := [_related(note, note.span, root) for note in diagnostic.notes if note.span]:
        result["relatedLocations"] = related
    return result


def _text(diagnostic: Diagnostic) -> str:
    """Return the message and the notes that have no place of their own."""
    return "\n".join((diagnostic.message, *(note.message for note in diagnostic.notes if note.span is None)))


def _related(note: Note, span: Span, root: Path) -> dict[str, object]:
    return {"message": {"text": note.message}, "physicalLocation": _place(span, root)}


def _place(span: Span, root: Path) -> dict[str, object]:
    region = {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }
    return {"artifactLocation": _artifact(span, root), "region": region}


def _artifact(span: Span, root: Path) -> dict[str, object]:
    if name := name_under(root, span.file):
        return {"uri": _quoted(name), "uriBaseId": _ROOT}
    if path := absolute(span.file):
        return {"uri": path.as_uri()}
    return {"uri": _quoted(span.file.name)}


def _quoted(name: str) -> str:
    """Return a name as a URI says it: its very bytes, be they UTF-8 or not."""
    return quote(name, errors="surrogateescape")
