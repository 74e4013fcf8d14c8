"""Files that were read, places in them, and references from later values back to these places."""

from linkforge_compile.source.source_ref import Key, Located, Sourced, SourceRef
from linkforge_compile.source.span import (
    Change,
    ModuleUse,
    Origin,
    Position,
    SourceFile,
    Span,
    TracedSpan,
    span_of,
)
from linkforge_compile.source.text_place import place_of_byte
