"""What went wrong, as values: a code, a sentence, a place, and the way out."""

from linkforge_compile.diagnostics.diagnostic import (
    Blame,
    Code,
    Diagnostic,
    Note,
    Severity,
    Where,
    brought_in_at,
    notes_of_changes,
)
from linkforge_compile.diagnostics.gaps import Gaps, Removed
from linkforge_compile.diagnostics.sink import MAX_TOLD, BeyondLimitError, Diagnostics, too_many_errors

__all__ = [
    "MAX_TOLD",
    "BeyondLimitError",
    "Blame",
    "Code",
    "Diagnostic",
    "Diagnostics",
    "Gaps",
    "Note",
    "Removed",
    "Severity",
    "Where",
    "brought_in_at",
    "notes_of_changes",
    "too_many_errors",
]
