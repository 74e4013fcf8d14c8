"""Where faults flow: the only mutable object in the pipeline."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Severity
from linkforge_compile.source import Span


class Diagnostics:
    """Collects what the stages report, each fault once.

    A module that is used twice is read once and evaluated twice: a fault of its text comes twice, with the
    same words at the same place, and is kept the first time only.
    """

    def __init__(self) -> None:
        self._reported: dict[tuple[str, Span | None, str], Diagnostic] = {}

    def report(self, diagnostic: Diagnostic) -> None:
        key = (diagnostic.code.id, diagnostic.span, diagnostic.message)
        self._reported.setdefault(key, diagnostic)

    def report_all(self, diagnostics: Iterable[Diagnostic]) -> None:
        for diagnostic in diagnostics:
            self.report(diagnostic)

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._reported.values())

    def __len__(self) -> int:
        return len(self._reported)

    def sorted(self) -> tuple[Diagnostic, ...]:
        """Return all of them in the order of the files, and of the places in each file."""
        return tuple(sorted(self, key=lambda diagnostic: diagnostic.order))
