"""Which diagnostics the user wants to be told, and how seriously."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Severity


class Selection(NamedTuple):
    """What is left of a report; codes are whole ones or their beginnings, `LF5` for LF5000 to LF5999.

    Errors are always told: a spec that has one gives no robot, whoever looks.
    """

    select: tuple[str, ...] = ()
    """The only warnings and notes to tell; all of them for an empty tuple."""
    ignore: tuple[str, ...] = ()
    """Those of the selected ones that are not told."""
    warnings_are_errors: bool = False
    errors_only: bool = False

    def of(self, diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Return what is to be told, in the same order."""
        told = (self._weighed(diagnostic) for diagnostic in diagnostics if self._wants(diagnostic))
        return tuple(each for each in told if each.severity is Severity.ERROR or not self.errors_only)

    def _wants(self, diagnostic: Diagnostic) -> bool:
        if diagnostic.severity is Severity.ERROR:
            return True
        code = diagnostic.code.id
        return (not self.select or code.startswith(self.select)) and not code.startswith(self.ignore)

    def _weighed(self, diagnostic: Diagnostic) -> Diagnostic:
        if self.warnings_are_errors and diagnostic.severity is Severity.WARNING:
            return replace(diagnostic, severity_override=Severity.ERROR)
        return diagnostic
