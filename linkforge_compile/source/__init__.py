"""Where things were written: files, spans in them, and the references by which every later value finds back."""

from linkforge_compile.source.file import SourceFile, span_of
from linkforge_compile.source.ref import Key, Located, Sourced, SourceRef
from linkforge_compile.source.span import Change, ComputedSpan, Origin, PatchedSpan, Position, Span, Trace

__all__ = [
    "Change",
    "ComputedSpan",
    "Key",
    "Located",
    "Origin",
    "PatchedSpan",
    "Position",
    "SourceFile",
    "SourceRef",
    "Sourced",
    "Span",
    "Trace",
    "span_of",
]
