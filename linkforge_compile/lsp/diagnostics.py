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
    """Return the diagnostics of several specs by the URI of their file, each once, as `check` of all of them has them.

    One without a place is at the start of its spec.
    """
    found: defaultdict[str, list[types.Diagnostic]] = defaultdict(list)
    for root, analysis in analyses.items():
        found[uri_of(root)] += (_converted(one, columns) for one in report_of([analysis]) if _file_of(one) is None)
    for one in report_of(analyses.values()):
        if path := _file_of(one):
            found[uri_of(path)].append(_converted(one, columns))
    return {uri: listed for uri, listed in found.items() if listed}


def report_of(analyses: Iterable[Analysis]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of several specs, with those of one place that are alike as one."""
    return group_at_places(without_repeats(one for each in analyses for one in each.compilation.diagnostics))


def _file_of(one: Diagnostic) -> Path | None:
    return one.span.file.path if one.span else None


def _converted(one: Diagnostic, columns: Columns) -> types.Diagnostic:
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
