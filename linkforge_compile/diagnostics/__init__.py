"""Diagnostics as values: a code, a sentence, a place and notes; each code has a manual page."""

from linkforge_compile.diagnostics.diagnostic import (
    Code,
    Diagnostic,
    Note,
    Severity,
    Where,
    notes_of,
)
from linkforge_compile.diagnostics.sink import MAX_KEPT, BeyondLimitError, Diagnostics, too_many_errors
from linkforge_compile.diagnostics.unresolved import DeletedNames, UnresolvedNames
