"""The error of a sweep that cannot be run as it was requested."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.diagnostics import Diagnostic

MAX_POINTS = 1_000_000
"""How many points a sweep has at most, unless its user asks for more."""


class SweepError(ValueError):
    """What was requested is wrong.

    `message` has one or more lines, and `diagnostics` the faults that have a place in an option or a file.
    """

    def __init__(self, message: str, diagnostics: tuple[Diagnostic, ...] = ()) -> None:
        self.message, self.diagnostics = message, diagnostics
        super().__init__("\n".join((message, *map(str, diagnostics))) if diagnostics else message)
