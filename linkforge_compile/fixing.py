"""Apply the safe fixes of a report to texts, each proven by a check of the texts that it makes.

`linkforge check --fix` writes the texts, and the language server returns them as edits.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import Generic, NamedTuple, Protocol, TypeVar

from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.diagnostics.codes.syntax import SPACE_AFTER_COLON, XACRO_EXPRESSION
from linkforge_compile.diagnostics.fix import Edit, Fix, apply_edits, without_overlaps
from linkforge_compile.diagnostics.grouping import ungrouped
from linkforge_compile.roots import identity

_MOST_CHECKS = 100
"""How often the specs are checked at most; each fix of a syntax error may uncover the next one."""

_SYNTAX, _YAML = "LF10", "LF1"
"""How the codes of errors begin that hide all others in a file, and of all errors of YAML, such as a repeated key."""


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


class Fixed(NamedTuple, Generic[_Report]):
    """What safe fixes make: the report that remains, and the changed texts by the paths of their files.

    `numbers` counts the fixes of each file; `refused` are the reasons, with their places, of those that bring an error.
    """

    report: _Report
    texts: dict[Path, str]
    numbers: Counter[Path]
    refused: tuple[str, ...]


def apply_safe_fixes(
    check: Callable[[Mapping[str, str]], _Report], may_change: Callable[[Path], bool]
) -> Fixed[_Report]:
    """Apply safe fixes until none is left that `check` proves, and return what they make.

    `check` reports on specs with texts in place of files, by real path. A fix that brings an error is not applied.
    """
    texts: dict[str, str] = {}
    shown: dict[str, Path] = {}
    numbers: Counter[Path] = Counter()  # by the file of the first edit
    refused: dict[tuple[object, ...], str] = {}
    report, at_once = check(texts), None
    for _ in range(_MOST_CHECKS):
        chosen = [one for one in _candidates(report, may_change) if one.key not in refused][:at_once]
        if not chosen:
            break
        edited = _edited(chosen)
        after = check({**texts, **{identity(path): text for path, text in edited.items()}})
        if not (fault := _new_fault(chosen, report, after)):
            texts |= {identity(path): text for path, text in edited.items()}
            shown |= {identity(path): path for path in edited}
            numbers.update(one.file for one in chosen)
            report, at_once = after, None
        elif len(chosen) == 1:
            [one] = chosen
            refused[one.key] = f"{one.fix.edits[0].span}: did not {one.fix.title}: {fault}"
            at_once = None
        else:
            at_once = len(chosen) // 2
    return Fixed(report, {shown[real]: text for real, text in texts.items()}, numbers, tuple(refused.values()))


def is_proven(diagnostic: Diagnostic, fix: Fix, before: Report, check: Callable[[Mapping[str, str]], Report]) -> bool:
    """Whether a safe fix of a diagnostic in a report can be applied; `check` is that of `apply_safe_fixes`."""
    chosen = [_Candidate(diagnostic, fix)]
    after = check({identity(path): text for path, text in _edited(chosen).items()})
    return not _new_fault(chosen, before, after)


def files_to_fix(report: Report) -> set[Path]:
    """Return the files that the safe fixes of a report would change."""
    return {path for one in _safe(report) for edit in one.fix.edits if (path := edit.span.file.path)}


def _safe(report: Report) -> list[_Candidate]:
    """Return the safe fixes of a report, each once."""
    by_edits: dict[tuple[object, ...], _Candidate] = {}
    for one in ungrouped(report.diagnostics):
        if fix := next((fix for fix in one.fixes if fix.is_safe), None):
            places = tuple((edit.span.file.name, *edit.span.range, edit.text) for edit in fix.edits)
            by_edits.setdefault(places, _Candidate(one, fix))
    return list(by_edits.values())


def _candidates(report: Report, may_change: Callable[[Path], bool]) -> list[_Candidate]:
    """Return the safe fixes of a report that can be applied together."""
    fixed = {path for path in files_to_fix(report) if may_change(path)}
    safe = [one for one in _safe(report) if all(edit.span.file.path in fixed for edit in one.fix.edits)]
    together = {id(fix) for fix in without_overlaps(one.fix for one in safe)}
    return [one for one in safe if id(one.fix) in together]


def _edited(chosen: Iterable[_Candidate]) -> dict[Path, str]:
    """Return the texts of the changed files by their paths."""
    edits: dict[Path, list[Edit]] = {}
    for edit in (edit for one in chosen for edit in one.fix.edits):
        if edit.span.file.path:
            edits.setdefault(edit.span.file.path, []).append(edit)
    return {path: apply_edits(some[0].span.file, some) for path, some in edits.items()}


def _new_fault(chosen: Collection[_Candidate], before: Report, after: Report) -> str:
    """Return why fixes cannot be applied: a diagnostic that is still there, or an error that they bring; "" if neither.

    They bring an error if it is at what they write, or if the text is no longer YAML. Others were hidden before: what
    cannot be read is not checked.
    """
    was, now = (Counter(map(_key, ungrouped(report.diagnostics))) for report in (before, after))
    corrected = {_key(member) for member in ungrouped(one.diagnostic for one in chosen)}
    has_hidden = any(one.diagnostic.code.id.startswith(_SYNTAX) for one in chosen)
    written = _places_written(chosen)
    for error in ungrouped(after.diagnostics):
        if error.span is None:
            continue
        at, _ = error.span.range
        is_in_edit = any(begin <= at <= end for begin, end in written.get(error.span.file.name, ()))
        if is_in_edit and _key(error) in corrected:
            return "it is reported again"
        if error.severity is not Severity.ERROR or now[_key(error)] <= was[_key(error)]:
            continue
        is_yaml = error.code.id.startswith(_YAML) and error.code not in (XACRO_EXPRESSION, SPACE_AFTER_COLON)
        if is_in_edit or (is_yaml and not has_hidden and error.span.file.name in written):
            return f"it would bring the error '{error.message}'"
    return ""


def _places_written(chosen: Iterable[_Candidate]) -> dict[str, list[tuple[int, int]]]:
    """Return the indexes between which the edited texts have what fixes write, by the name of the file."""
    ranges: dict[str, list[tuple[int, int, int]]] = {}
    for edit in (edit for one in chosen for edit in one.fix.edits):
        ranges.setdefault(edit.span.file.name, []).append((*edit.span.range, len(edit.text)))
    written: dict[str, list[tuple[int, int]]] = {}
    for name, edits in ranges.items():
        moved = 0
        for begin, end, length in sorted(edits):
            written.setdefault(name, []).append((begin + moved, begin + moved + length))
            moved += length - (end - begin)
    return written


def _key(diagnostic: Diagnostic) -> tuple[str, str, str]:
    """Return what identifies a diagnostic in two reports, in which its place may differ."""
    return diagnostic.code.id, diagnostic.span.file.name if diagnostic.span else "", diagnostic.message
