"""What went wrong, as values: a code, a sentence, a place, and the way out."""

from linkforge_compile.diagnostics.diagnostic import Blame, Code, Diagnostic, Note, Severity, Where
from linkforge_compile.diagnostics.gaps import Gaps, Removed
from linkforge_compile.diagnostics.sink import Diagnostics

__all__ = ["Blame", "Code", "Diagnostic", "Diagnostics", "Gaps", "Note", "Removed", "Severity", "Where"]
