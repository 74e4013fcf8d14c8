"""Collects the diagnostics of a compile, within limits."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections import defaultdict
from collections.abc import Collection, Hashable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeAlias

from linkforge_compile.diagnostics.codes.modules import MORE_WARNINGS, TOO_MANY_ERRORS
from linkforge_compile.diagnostics.diagnostic import Code, Diagnostic, Note, Severity
from linkforge_compile.source import Position, SourceFile, Span

MAX_KEPT = 1_000
"""How many errors a compile reports, and how many warnings and notes, where a group counts as one."""

MAX_AT_ONE_PLACE = 3
"""How many diagnostics with one code are kept for one place; a `for` may give one in each of its rounds."""

MAX_REPORTED = 10_000
"""How many errors are found before a repeated one ends the compile."""

MAX_COUNTED = 50_000
"""How many warnings and notes beyond MAX_KEPT are counted; one more ends the compile.

A place counts at most MAX_AT_ONE_PLACE times, so a `for` with many rounds does not reach this."""

_Place: TypeAlias = tuple[str, Span]
_Identity: TypeAlias = tuple[str, Span | None, str, int]


class BeyondLimitError(Exception):
    """The compile exceeds a limit and ends with `diagnostic`."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(str(diagnostic))


def too_many_errors(where: Span | None, *notes: Note) -> BeyondLimitError:
    """Return the exception to raise at the first error beyond MAX_KEPT."""
    return BeyondLimitError(TOO_MANY_ERRORS.at(where, notes=notes, what="errors"))


class Diagnostics:
    """Collects what the stages report; equal diagnostics are kept once.

    A module that is used twice is evaluated twice, and reports each fault of its text twice.
    """

    def __init__(self) -> None:
        self._reported: dict[_Identity, Diagnostic] = {}
        self._errors = 0
        self._errors_reported = 0
        # Hashes, because a message may be long.
        self._seen: set[int] = set()
        self._at: defaultdict[_Place, set[int]] = defaultdict(set)
        self._error_starts: defaultdict[SourceFile, list[Position]] = defaultdict(list)
        # Of the warnings and notes that are kept: a group, or the number of a single one.
        self._groups: set[Hashable] = set()
        self._left_out = 0
        self._recorded: list[Diagnostic] | None = None

    @contextmanager
    def recording(self) -> Iterator[list[Diagnostic]]:
        """Collect everything that is reported meanwhile, kept or not."""
        recorded: list[Diagnostic] = []
        around, self._recorded = self._recorded, recorded
        try:
            yield recorded
        finally:
            self._recorded = around

    def report(self, diagnostic: Diagnostic) -> None:
        """Keep a diagnostic, or only count it if there are many; BeyondLimitError if there are too many."""
        if self._recorded is not None:
            self._recorded.append(diagnostic)
        is_error = diagnostic.severity is Severity.ERROR
        self._errors_reported += is_error
        is_kept = self._is_kept(diagnostic)
        if self._left_out > MAX_COUNTED:
            raise BeyondLimitError(TOO_MANY_ERRORS.at(diagnostic.span, what="warnings and notes"))
        if is_error and is_kept and self._errors >= MAX_KEPT:
            raise too_many_errors(diagnostic.span)
        if is_error and not is_kept and self._errors_reported > MAX_REPORTED:
            again = Note(f"{MAX_REPORTED:,} were found, most of them again and again at the same places")
            raise too_many_errors(diagnostic.span, again)
        if is_kept:
            self._errors += is_error
            self._reported[_identity(diagnostic)] = diagnostic

    def _is_kept(self, diagnostic: Diagnostic) -> bool:
        """Whether a diagnostic is new and within the limits; count it if it is beyond them."""
        number = hash(_identity(diagnostic))
        if number in self._seen:
            return False
        self._seen.add(number)
        is_error = diagnostic.severity is Severity.ERROR
        if diagnostic.span is not None:
            if is_error:
                insort(self._error_starts[diagnostic.span.file], diagnostic.span.start)
            at = self._at[diagnostic.code.id, diagnostic.span]
            at.add(number)
            if len(at) > MAX_AT_ONE_PLACE and not diagnostic.subject:
                return False
        if not is_error:
            group = number if diagnostic.group is None else diagnostic.group
            if group not in self._groups and len(self._groups) >= MAX_KEPT:
                self._left_out += 1
                return False
            self._groups.add(group)
        return True

    def abort(self, beyond: BeyondLimitError) -> None:
        """Keep the diagnostic that ended the compile, whatever the limits are."""
        diagnostic = beyond.diagnostic
        self._reported[_identity(diagnostic)] = diagnostic

    def report_all(self, diagnostics: Iterable[Diagnostic]) -> None:
        for diagnostic in diagnostics:
            self.report(diagnostic)

    def has_error_in(self, span: Span) -> bool:
        """Whether an error was reported at a place that begins in a span."""
        starts = self._error_starts.get(span.file, [])
        following = bisect_left(starts, span.start)
        return following < len(starts) and (starts[following] < span.end or starts[following] == span.start)

    def places_of(self, codes: Collection[Code]) -> set[Span]:
        """Return where these codes were reported, also those that were only counted."""
        ids = {code.id for code in codes}
        return {span for code, span in self._at if code in ids}

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._reported.values())

    def __len__(self) -> int:
        return len(self._reported)

    def sorted(self) -> tuple[Diagnostic, ...]:
        """Return all of them in reading order."""
        last = {(one.code.id, one.span): one for one in self}
        listed = [self._with_count(one) if last[one.code.id, one.span] is one else one for one in self]
        if self._left_out:
            listed.insert(0, MORE_WARNINGS.at(None, count=f"{self._left_out:,}"))
        return tuple(sorted(listed, key=lambda diagnostic: diagnostic.order))

    def _with_count(self, last: Diagnostic) -> Diagnostic:
        """Return the last diagnostic of its code at its place, with a note on how many more there are."""
        if last.span is None or last.subject:
            return last
        if (more := len(self._at[last.code.id, last.span]) - MAX_AT_ONE_PLACE) <= 0:
            return last
        note = Note(f"and {more:,} more like this at the same place")
        return replace(last, notes=(*last.notes, note), omitted=more)


def _identity(diagnostic: Diagnostic) -> _Identity:
    """Return a key that is equal for equal diagnostics."""
    return diagnostic.code.id, diagnostic.span, diagnostic.message, diagnostic.full_text_hash
