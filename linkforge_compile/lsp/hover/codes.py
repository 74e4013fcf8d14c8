"""Show the title of a diagnostic's code in a comment, with its page."""

from __future__ import annotations

import re

from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.resources import manual_folder
from linkforge_compile.source import Position, SourceFile

_CODE = re.compile(r"\bLF\d{4}\b", re.IGNORECASE)


def show_code(file: SourceFile, at: Position) -> str:
    """Return what the code at a position in a comment means; "" if there is none."""
    line = file.line(at.line)
    for found in _CODE.finditer(line):
        is_there = found.start() <= at.column - 1 <= found.end()
        known = REGISTER.get(found[0].upper())
        if is_there and known is not None and "#" in line[: found.start()]:
            page = (manual_folder() / f"{known.id}.md").as_uri()
            return f"[{known.id}]({page}), {known.severity.value}: {known.title}"
    return ""
