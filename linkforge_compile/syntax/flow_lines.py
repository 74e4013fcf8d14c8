"""Lines on which a list or map in brackets continues, which YAML wants indented and our parser does not."""

from __future__ import annotations


def find_outdented_line(text: str, begin: int, end: int, indent: int) -> tuple[int, int] | None:
    """Return where the first line with too few spaces begins and ends, without them; None if there is none.

    `begin` and `end` are those of the outermost brackets, `indent` is the column of the block around them, beyond
    which YAML wants each line. As in the parsers of editors, the last bracket may be at this column.
    """
    line_break = text.find("\n", begin, end)
    while line_break != -1:
        next_break = text.find("\n", line_break + 1, end)
        line_end = end if next_break == -1 else next_break
        line = text[line_break + 1 : line_end]
        content = line.lstrip()
        spaces, first = len(line) - len(line.lstrip(" ")), line_end - len(content)
        is_outdented = spaces < indent or (spaces == indent and first != end - 1)
        if is_outdented and content and not content.startswith("#"):
            return first, line_end
        line_break = next_break
    return None
