"""Where things were written: files, spans in them, and the references by which every later value finds back."""

from linkforge_compile.source.file import SourceFile, span_of
from linkforge_compile.source.ref import Key, Located, Sourced, SourceRef
from linkforge_compile.source.span import Change, Origin, Position, Span, Trace, TracedSpan

__all__ = [
    "Change",
    "Key",
    "Located",
    "Origin",
    "Position",
    "SourceFile",
    "SourceRef",
    "Sourced",
    "Span",
    "Trace",
    "TracedSpan",
    "span_of",
]
