"""The diagnostics of analyses as the protocol has them, by file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

from lsprotocol import types

from linkforge_compile.analysis import Analysis
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.grouping import group_at_places
from linkforge_compile.diagnostics.reports import without_repeats
from linkforge_compile.lsp.convert import SEVERITIES, Columns, uri_of
from linkforge_compile.resources import manual_folder

_START = types.Range(types.Position(0, 0), types.Position(0, 0))


def diagnostics_by_uri(analyses: Mapping[Path, Analysis], columns: Columns) -> dict[str, list[types.Diagnostic]]:
    """Return the diagnostics of several specs by the URI of their file, each once.

    One without a place is at the start of its spec.
    """
    found: defaultdict[str, list[types.Diagnostic]] = defaultdict(list)
    for root, report in _reports(analyses).items():
        for one in report:
            path = one.span.file.path if one.span else None
            found[uri_of(path or root)].append(_converted(one, root, columns))
    return found


def _reports(analyses: Mapping[Path, Analysis]) -> Mapping[Path, Iterable[Diagnostic]]:
    """Return the diagnostics of each spec without those that an earlier one has."""
    seen: set[str] = set()
    reports: dict[Path, list[Diagnostic]] = {}
    for root, analysis in analyses.items():
        reports[root] = []
        for one in group_at_places(without_repeats(analysis.compilation.diagnostics)):
            key = str(one)
            if one.span is None or key not in seen:
                reports[root].append(one)
                seen.add(key)
    return reports


def _converted(one: Diagnostic, root: Path, columns: Columns) -> types.Diagnostic:
    remarks = "".join(f"\n{note.message}" for note in one.notes if note.span is None)
    return types.Diagnostic(
        range=columns.range(one.span) if one.span and one.span.file.path else _START,
        message=one.message + remarks,
        severity=SEVERITIES[one.severity],
        code=one.code.id,
        code_description=types.CodeDescription((manual_folder() / f"{one.code.id}.md").as_uri()),
        source="linkforge",
        related_information=[
            types.DiagnosticRelatedInformation(location, note.message)
            for note in one.notes
            if note.span and (location := columns.location(note.span))
        ],
    )
