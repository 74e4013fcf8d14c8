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
from linkforge_compile.diagnostics.sink import MAX_TOLD, BeyondLimitError, Diagnostics, too_many_errors
from linkforge_compile.diagnostics.unresolved import DeletedNames, UnresolvedNames

__all__ = [
    "MAX_TOLD",
    "BeyondLimitError",
    "Blame",
    "Code",
    "DeletedNames",
    "Diagnostic",
    "Diagnostics",
    "Note",
    "Severity",
    "UnresolvedNames",
    "Where",
    "brought_in_at",
    "notes_of_changes",
    "too_many_errors",
]
