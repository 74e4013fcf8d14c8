"""Where faults flow: the only mutable object in the pipeline."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from typing import TypeAlias

from linkforge_compile.diagnostics.codes.modules import MORE_WARNINGS, TOO_MANY_ERRORS
from linkforge_compile.diagnostics.diagnostic import Code, Diagnostic, Note, Severity
from linkforge_compile.source import Position, SourceFile, Span

MAX_KEPT = 1_000
"""How many errors are told of one compile, and how many warnings and notes."""

MAX_AT_ONE_PLACE = 3
"""How often one kind of fault is told of one place; a `for` may give it in each of ten thousand rounds."""

MAX_REPORTED = 10_000
"""How many errors are looked at, those among them that are counted only, or were told already: then one that is no
news ends the compile."""

MAX_COUNTED = 50_000
"""How many warnings and notes are counted that are not told: a place counts three times at most, whatever number of
links a `for` makes there, so that only a file of as many faults ends the compile."""

_Place: TypeAlias = tuple[str, Span]
_Identity: TypeAlias = tuple[str, Span | None, str, int]


class BeyondLimitError(Exception):
    """The compile ends here: what `diagnostic` tells leaves nothing to go on with in bounded time."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(str(diagnostic))


def too_many_errors(where: Span | None, *notes: Note) -> BeyondLimitError:
    """Return what to raise at the error that is one too many."""
    return BeyondLimitError(TOO_MANY_ERRORS.at(where, notes=notes, what="errors"))


class Diagnostics:
    """Collects what the stages report, each fault once.

    A module that is used twice is read once and evaluated twice: a fault of its text comes twice, with the
    same words at the same place, and is kept the first time only.
    """

    def __init__(self) -> None:
        self._reported: dict[_Identity, Diagnostic] = {}
        self._errors = 0
        self._errors_reported = 0
        # By their hashes, as a message may be long, and only their number is told.
        self._seen: set[int] = set()
        self._at: defaultdict[_Place, set[int]] = defaultdict(set)
        self._error_starts: defaultdict[SourceFile, list[Position]] = defaultdict(list)
        self._left_out = 0

    def report(self, diagnostic: Diagnostic) -> None:
        """Keep a diagnostic, or count it where enough were told; raise BeyondLimitError where there is no end."""
        is_error = diagnostic.severity is Severity.ERROR
        self._errors_reported += is_error
        is_told = self._is_to_be_told(diagnostic)
        if self._left_out > MAX_COUNTED:
            raise BeyondLimitError(TOO_MANY_ERRORS.at(diagnostic.span, what="warnings and notes"))
        if is_error and is_told and self._errors >= MAX_KEPT:
            raise too_many_errors(diagnostic.span)
        if is_error and not is_told and self._errors_reported > MAX_REPORTED:
            again = Note(f"{MAX_REPORTED:,} were found, most of them again and again at the same places")
            raise too_many_errors(diagnostic.span, again)
        if is_told:
            self._errors += is_error
            self._reported[_identity(diagnostic)] = diagnostic

    def _is_to_be_told(self, diagnostic: Diagnostic) -> bool:
        """Whether a diagnostic is neither told already nor one too many, which is counted here."""
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
            if len(at) > MAX_AT_ONE_PLACE:
                return False
        if not is_error and len(self._reported) - self._errors >= MAX_KEPT:
            self._left_out += 1
            return False
        return True

    def abort(self, beyond: BeyondLimitError) -> None:
        """Keep what ended the compile, however much was told before."""
        diagnostic = beyond.diagnostic
        self._reported[_identity(diagnostic)] = diagnostic

    def report_all(self, diagnostics: Iterable[Diagnostic]) -> None:
        for diagnostic in diagnostics:
            self.report(diagnostic)

    def has_error_in(self, span: Span) -> bool:
        """Whether an error was told of what begins in a stretch of text; looked up, not searched."""
        starts = self._error_starts.get(span.file, [])
        following = bisect_left(starts, span.start)
        return following < len(starts) and (starts[following] < span.end or starts[following] == span.start)

    def places_of(self, codes: Collection[Code]) -> set[Span]:
        """Return where faults of these kinds were reported, those among them that are only counted."""
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
        """Return all of them in the order of the files, and of the places in each file."""
        last = {(one.code.id, one.span): one for one in self}
        told = [self._counted(one) if last[one.code.id, one.span] is one else one for one in self]
        if self._left_out:
            told.insert(0, MORE_WARNINGS.at(None, count=f"{self._left_out:,}"))
        return tuple(sorted(told, key=lambda diagnostic: diagnostic.order))

    def _counted(self, last: Diagnostic) -> Diagnostic:
        """Return the last diagnostic of its kind at its place with how many more there are."""
        if last.span is None or (more := len(self._at[last.code.id, last.span]) - MAX_AT_ONE_PLACE) <= 0:
            return last
        note = Note(f"and {more:,} more like this at the same place")
        return replace(last, notes=(*last.notes, note), omitted=more)


def _identity(diagnostic: Diagnostic) -> _Identity:
    """Return what makes two diagnostics one."""
    return diagnostic.code.id, diagnostic.span, diagnostic.message, diagnostic.full_text_hash
