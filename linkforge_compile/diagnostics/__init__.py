"""What went wrong, as values: a code, a sentence, a place, and the way out."""

from linkforge_compile.diagnostics.diagnostic import Code, Diagnostic, Note, Severity, Where
from linkforge_compile.diagnostics.gaps import Gaps
from linkforge_compile.diagnostics.sink import Diagnostics

__all__ = ["Code", "Diagnostic", "Diagnostics", "Gaps", "Note", "Severity", "Where"]
