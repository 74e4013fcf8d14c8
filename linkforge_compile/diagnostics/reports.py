"""Decide what a report shows: suppressions in comments, the user's selection, and several runs merged into one."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.diagnostics.codes import OUTPUT_CODES, REGISTER
from linkforge_compile.diagnostics.codes.modules import VARIANTS_BEYOND_LIMIT
from linkforge_compile.diagnostics.codes.syntax import (
    IGNORE_MISWRITTEN,
    IGNORE_OF_ERROR,
    IGNORE_OF_UNKNOWN_CODE,
    IGNORE_WITHOUT_CODE,
    NOTHING_TO_IGNORE,
)
from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note, Severity
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.diagnostics.grouping import group_alike, ungrouped
from linkforge_compile.diagnostics.sink import Diagnostics
from linkforge_compile.source import Span


class Selection(NamedTuple):
    """The warnings and notes to report, by codes or their beginnings; `LF5` means LF5000 to LF5999.

    Errors are always reported.
    """

    select: tuple[str, ...] = ()
    """The only ones to report; all of them if empty."""
    ignore: tuple[str, ...] = ()
    """Those of the selected ones that are not reported."""
    errors: tuple[str, ...] = ()
    """Those whose warnings are reported as errors."""
    errors_only: bool = False

    def of(self, diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Return what is to be reported, in the same order."""
        wanted = (one for one in diagnostics if one.severity is Severity.ERROR or self._wants(one.code.id))
        raised = map(self._raised, wanted)
        return tuple(one for one in raised if one.severity is Severity.ERROR or not self.errors_only)

    def _raised(self, one: Diagnostic) -> Diagnostic:
        if one.severity is Severity.WARNING and one.code.id.startswith(self.errors):
            return replace(one, severity_override=Severity.ERROR)
        return one

    def _wants(self, code: str) -> bool:
        return (not self.select or code.startswith(self.select)) and not code.startswith(self.ignore)


class Suppression(NamedTuple):
    """A comment that suppresses codes on `line` of its file; each code comes with its own span.

    One that is not understood suppresses nothing.
    """

    span: Span
    line: int
    codes: tuple[tuple[str, Span], ...]
    is_understood: bool = True


def apply_suppressions(
    diagnostics: tuple[Diagnostic, ...], suppressions: tuple[Suppression, ...], *, is_whole: bool
) -> tuple[Diagnostic, ...]:
    """Return a report in reading order without what is suppressed, and with the faults of the comments.

    Errors stay. Unused suppressions are reported only if `is_whole`, which means that every stage and check ran; those
    of LF7 never are, as it depends on the formats of a compile which of them it reports.
    """
    # By the file's name, as one that is included twice is two files with the same comments.
    suppressed = {
        (one.span.file.name, one.line, code) for one in suppressions if one.is_understood for code, _ in one.codes
    }
    used = {_key(one) for one in diagnostics if one.severity is not Severity.ERROR} & suppressed
    kept = [one for one in diagnostics if one.severity is Severity.ERROR or _key(one) not in used]
    # A file may consist of comments: its faults are limited like all others.
    faults, seen = Diagnostics(), set()
    for fault in (fault for one in suppressions for fault in _faults(one, used, is_whole)):
        if (line := hash(str(fault))) not in seen:
            seen.add(line)
            faults.report(fault)
    return tuple(sorted((*kept, *faults.sorted()), key=lambda one: one.order))


def _key(diagnostic: Diagnostic) -> tuple[str, int, str]:
    span = diagnostic.span
    return (span.file.name, span.line, diagnostic.code.id) if span else ("", 0, diagnostic.code.id)


def _faults(comment: Suppression, used: Collection[tuple[str, int, str]], is_whole: bool) -> Iterator[Diagnostic]:
    if not comment.is_understood:
        codes = ", ".join(dict.fromkeys(code.upper() for code, _ in comment.codes))
        fault = IGNORE_MISWRITTEN.at(comment.span, codes=codes or "and codes such as LF6003")
        yield fault.replacing("", f"# linkforge: ignore {codes}", is_safe=True) if codes else fault
        return
    if not comment.codes:
        yield IGNORE_WITHOUT_CODE.at(comment.span)
    for code, span in comment.codes:
        if code not in REGISTER:
            longer = (one for one in sorted(REGISTER) if one.startswith(code.upper()) and len(one) > len(code))
            example = next(longer, None)
            hint = f"; write each in full, such as {example}" if example else ""
            yield IGNORE_OF_UNKNOWN_CODE.at(span, name=code, hint=hint, near=() if hint else REGISTER)
        elif REGISTER[code].severity is Severity.ERROR:
            yield IGNORE_OF_ERROR.at(span, code=code).with_fix(_removal(comment, span, is_safe=True))
        elif is_whole and not code.startswith(OUTPUT_CODES) and (span.file.name, comment.line, code) not in used:
            # Another variant, or other parameters, may need it.
            fix = _removal(comment, span, is_safe=False)
            yield NOTHING_TO_IGNORE.at(span, code=code, line=comment.line).with_fix(fix)


def _removal(comment: Suppression, code: Span, *, is_safe: bool) -> Fix:
    """Return the fix that removes a code from a comment; the only one together with the comment and its reason."""
    file, line, codes = code.file, code.line, [span for _, span in comment.codes]
    if len(codes) > 1:
        at = codes.index(code)
        begin, end = (codes[at - 1].end, code.end) if at else (code.start, codes[1].start)
        return Fix(f"remove {code.text}", (Edit(Span(file, *begin, *end), ""),), is_safe)
    text, start = file.line(line), comment.span.column - 1
    following = text.find("#", comment.span.end_column - 1)
    if following >= 0:
        place = Span(file, line, start + 1, line, following + 1)
    elif text[:start].strip():
        place = Span(file, line, len(text[:start].rstrip()) + 1, line, len(text) + 1)
    else:
        place = Span(file, line, 1, line + 1, 1)
    return Fix("remove this comment", (Edit(place, ""),), is_safe)


def without_repeats(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return diagnostics of several specs, each once: specs that use the same module repeat those of the module.

    One of the command line, such as an unknown parameter, is about the spec that its notes name.
    """
    first: dict[object, Diagnostic] = {}
    for one in ungrouped(diagnostics):
        first.setdefault(str(one) if one.span and one.span.file.path else (str(one), *map(str, one.notes)), one)
    return group_alike(first.values())


def count_losses(diagnostics: Iterable[Diagnostic], runs: Iterable[Collection[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Return a report in which text only counts the losses of formats that no run writes, as each has errors.

    The runs are those of the report, one for each spec and variant, with the severities that the user chose.
    """
    right = [run for run in runs if all(one.severity is not Severity.ERROR for one in run)]
    written = {_look(one) for run in right for one in ungrouped(run) if one.code.is_loss}

    def is_written(loss: Diagnostic) -> bool:
        return any(_look(one) in written for one in ungrouped([loss]))

    return tuple(
        replace(one, is_only_counted=True)
        if one.code.is_loss and one.severity is not Severity.ERROR and not is_written(one)
        else one
        for one in diagnostics
    )


def merge_reports(runs: Mapping[str, Iterable[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Return what any of the runs over a spec reported, in reading order, with a note if only some of them did.

    The runs are named as after "with": "the defaults", "variant 'sim'". Each run read the files anew, so diagnostics
    are equal if a person sees no difference: by code, place and message.
    """
    first: dict[Hashable, Diagnostic] = {}
    runs_of: dict[Hashable, list[str]] = {}
    for run, diagnostics in runs.items():
        for one in ungrouped(diagnostics):
            key = _look(one)
            first.setdefault(key, one)
            runs_of.setdefault(key, []).append(run)
    merged = []
    for key, one in first.items():
        if len(runs_of[key]) == len(runs):
            merged.append(one)
        elif one.code is not NOTHING_TO_IGNORE:  # a suppression that is used in one of the runs is useful
            merged.append(_with_note(one, runs_of[key]))
    return group_alike(sorted(merged, key=lambda one: one.order))


def _look(one: Diagnostic) -> Hashable:
    """Return a key that is equal for diagnostics of two runs between which a person sees no difference."""
    return one.code.id, str(one.span), one.message, one.full_text_hash


def _with_note(diagnostic: Diagnostic, runs: list[str]) -> Diagnostic:
    *others, last = runs
    if diagnostic.code is VARIANTS_BEYOND_LIMIT:
        words = f"what comes after {last} is not checked"
    else:
        words = f"with {', '.join(others)} and {last}" if others else f"with {last} only"
    return replace(diagnostic, notes=(*diagnostic.notes, Note(words)))
