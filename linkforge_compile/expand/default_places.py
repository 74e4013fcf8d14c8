"""Which places are in the `defaults` of their file: no entry that took them over knows it any more.

Only `explain` asks, of a few places, so the file is read again rather than a mark carried through every stage.
"""

from __future__ import annotations

from functools import lru_cache

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlNode, read


def is_default(place: Span) -> bool:
    """Whether what stands at a place of a spec that was compiled is a default."""
    section = _section(place.file)
    return section is not None and place.lies_in(section.span)


@lru_cache(maxsize=8)
def _section(file: SourceFile) -> YamlNode | None:
    if "defaults" not in file.text:
        return None
    tree = read(file, Diagnostics())
    return tree.get("defaults") if tree else None
