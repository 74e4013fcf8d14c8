"""Files that were read, places in them, and references from later values back to these places."""

from linkforge_compile.source.span import (
    Change,
    Key,
    Located,
    Origin,
    Position,
    Sourced,
    SourceFile,
    SourceRef,
    Span,
    Trace,
    TracedSpan,
    span_of,
)
from linkforge_compile.source.text_place import place_of_byte

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
    "place_of_byte",
    "span_of",
]
