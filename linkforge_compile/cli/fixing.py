"""`linkforge check --fix`: applies the safe fixes of a report and writes the files."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

from linkforge_compile.cli.reports import errors_of, print_status
from linkforge_compile.cli.specs import count
from linkforge_compile.diagnostics.fix import Edit, Fix, apply_edits, without_overlaps
from linkforge_compile.diagnostics.grouping import ungrouped
from linkforge_compile.roots import identity, top_of

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Diagnostic

_MOST_CHECKS = 100
"""How often the specs are checked at most; each fix of a syntax error may uncover the next one."""

_SYNTAX = "LF10"
"""How the codes of errors begin that hide others: what cannot be read is not checked."""


class Report(Protocol):
    """What a check of all specs reports."""

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]: ...


_Report = TypeVar("_Report", bound=Report)


class _Candidate(NamedTuple):
    """A safe fix, and the diagnostic that it corrects."""

    diagnostic: Diagnostic
    fix: Fix

    @property
    def key(self) -> tuple[object, ...]:
        """What identifies it in the next report, in which its place may have moved."""
        return *_key(self.diagnostic), *(edit.text for edit in self.fix.edits)

    @property
    def file(self) -> Path:
        """The file of its first edit."""
        path = self.fix.edits[0].span.file.path
        assert path, "texts without a file are not changed"
        return path


def fix_files(
    check: Callable[[Mapping[str, str]], _Report], specs: Iterable[str], arguments: argparse.Namespace
) -> _Report:
    """Apply safe fixes until none is left, write the files, and return the report of what remains.

    `check` reports on the specs with texts in place of files, by real path. Only files of the packages or repositories
    of the specs are changed. A fix that brings a new error is not applied.
    """
    tops = {Path(identity(top_of(Path(spec)))) for spec in specs}
    texts: dict[str, str] = {}
    shown: dict[str, Path] = {}
    fixed: Counter[Path] = Counter()  # by the file of the first edit
    refused: dict[tuple[object, ...], str] = {}
    report, at_once = check(texts), None
    for _ in range(_MOST_CHECKS):
        chosen = [one for one in _candidates(report, tops) if one.key not in refused][:at_once]
        if not chosen:
            break
        edited = _edited(chosen)
        after = check({**texts, **{identity(path): text for path, text in edited.items()}})
        if not (fault := _new_fault(chosen, report, after)):
            texts |= {identity(path): text for path, text in edited.items()}
            shown |= {identity(path): path for path in edited}
            fixed.update(one.file for one in chosen)
            report, at_once = after, None
        elif len(chosen) == 1:
            [one] = chosen
            refused[one.key] = f"{one.fix.edits[0].span}: did not {one.fix.title}: {fault}"
            at_once = None
        else:
            at_once = len(chosen) // 2
    _write({shown[real]: text for real, text in texts.items()}, fixed, arguments)
    for line in refused.values():
        print_status(line, arguments)
    return report


def _candidates(report: Report, tops: Collection[Path]) -> list[_Candidate]:
    """Return the safe fixes of a report that can be applied together, each once."""
    by_edits: dict[tuple[object, ...], _Candidate] = {}
    for one in ungrouped(report.diagnostics):
        if fix := next((fix for fix in one.fixes if fix.is_safe), None):
            places = tuple((edit.span.file.name, *edit.range, edit.text) for edit in fix.edits)
            by_edits.setdefault(places, _Candidate(one, fix))
    files = {edit.span.file.path for one in by_edits.values() for edit in one.fix.edits}
    fixed = {path for path in files if path and _may_change(path, tops)}
    safe = [one for one in by_edits.values() if all(edit.span.file.path in fixed for edit in one.fix.edits)]
    together = {id(fix) for fix in without_overlaps(one.fix for one in safe)}
    return [one for one in safe if id(one.fix) in together]


def _may_change(path: Path, tops: Collection[Path]) -> bool:
    """Whether a file may be written, is in one of the folders, and is UTF-8."""
    real = Path(identity(path))
    if not any(real.is_relative_to(top) for top in tops) or not os.access(real, os.W_OK) or not real.is_file():
        return False
    try:
        real.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return True


def _edited(chosen: Iterable[_Candidate]) -> dict[Path, str]:
    """Return the texts of the changed files by their paths."""
    edits: dict[Path, list[Edit]] = {}
    for edit in (edit for one in chosen for edit in one.fix.edits):
        if edit.span.file.path:
            edits.setdefault(edit.span.file.path, []).append(edit)
    return {path: apply_edits(some[0].span.file, some) for path, some in edits.items()}


def _new_fault(chosen: Collection[_Candidate], before: Report, after: Report) -> str:
    """Return why fixes cannot be applied: a diagnostic that is still there, or an error that they bring; "" if neither.

    An error that was hidden by one of the syntax is not new, unless it is of the syntax again, in what was edited.
    """
    was, now = (Counter(map(_key, ungrouped(report.diagnostics))) for report in (before, after))
    if any(now[key] >= was[key] for key in (_key(one.diagnostic) for one in chosen)):
        return "it is reported again"
    has_hidden = any(one.diagnostic.code.id.startswith(_SYNTAX) for one in chosen)
    for error in errors_of(after.diagnostics):
        is_new = now[_key(error)] > was[_key(error)]
        if is_new and not (has_hidden and not (error.code.id.startswith(_SYNTAX) and _is_in_edit(error, chosen))):
            return f"it would bring the error '{error.message}'"
    return ""


def _key(diagnostic: Diagnostic) -> tuple[str, str, str]:
    """Return what identifies a diagnostic in two reports, in which its place may differ."""
    return diagnostic.code.id, diagnostic.span.file.name if diagnostic.span else "", diagnostic.message


def _is_in_edit(error: Diagnostic, chosen: Iterable[_Candidate]) -> bool:
    """Whether an error is on an edited line, not to the right of what was written there."""
    span = error.span
    edits = (edit for one in chosen for edit in one.fix.edits)
    return span is not None and any(
        edit.span.file.name == span.file.name
        and edit.span.line == span.line
        and span.column <= edit.span.end_column + len(edit.text)
        for edit in edits
    )


def _write(texts: Mapping[Path, str], fixed: Mapping[Path, int], arguments: argparse.Namespace) -> None:
    """Write the files and print how many problems were fixed in each."""
    from linkforge_compile.cli.output import write_changed

    write_changed(texts)
    for path, number in fixed.items():
        print_status(f"fixed {count(number, 'problem')} in {path}", arguments)
