"""Lines on which a list or map in brackets continues, which YAML wants indented and our parser does not."""

from __future__ import annotations

import re

_LINE = re.compile(r"\n(?P<spaces> *)[ \t]*(?P<rest>[^\s#][^\n]*)")


def find_outdented_line(text: str, begin: int, end: int, indent: int) -> tuple[int, int] | None:
    """Return where the first line with too few spaces begins and ends, without them; None if there is none.

    `begin` and `end` are those of the outermost brackets, `indent` is the column of the block around them, beyond
    which YAML wants each line. As in the parsers of editors, the last bracket may be at this column.
    """
    for line in _LINE.finditer(text, begin, end):
        spaces, rest = len(line["spaces"]), line.start("rest")
        if spaces < indent or (spaces == indent and rest != end - 1):
            return rest, line.end()
    return None
