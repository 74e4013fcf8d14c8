"""The kinematic tree as text: lines from link to link, and columns with the joint above each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.diagnostics.terminal import BOLD, CYAN, DIM, padded, styled, width_of
from linkforge_compile.overview.joint_text import motion_text, short, type_text
from linkforge_compile.overview.tree import TreeRow

WIDTH = 100
"""The columns into which the tree fits where there is no terminal, unless names are too long [characters]."""

MOST_INDENTED = 24
"""The largest number of levels that are indented; a deeper link has the number of its level before its name."""

MOST_INDENTED_IN_LINES = 6
"""The same in a tree without columns, which is for narrow terminals."""

LONGEST_POSITION = 24
"""A position with a longer text, such as a joint that it follows, gets its own line in a narrow tree [characters]."""


class Lines(NamedTuple):
    """The characters that draw a tree; each piece of a line has three."""

    branch: str
    last: str
    passing: str
    ellipsis: str


UNICODE = Lines("├─ ", "└─ ", "│  ", "…")
ASCII = Lines("|- ", "`- ", "|  ", "...")


def lines_for(encoding: str | None) -> Lines:
    """Return the lines that an encoding can represent."""
    try:
        "".join(UNICODE).encode(encoding or "ascii")
    except (UnicodeError, LookupError):
        return ASCII
    return UNICODE


def render_links(rows: Sequence[TreeRow], lines: Lines = UNICODE, *, is_colored: bool = False) -> Iterator[str]:
    """Yield the tree with only the names of the links."""
    for branch in _branches(rows, lines, 3):
        yield branch.drawn(branch.width, is_colored)


def render_tree(
    rows: Sequence[TreeRow], lines: Lines = UNICODE, *, is_colored: bool = False, width: int = WIDTH
) -> Iterator[str]:
    """Yield titles and a line for each link; if that is too wide, each joint gets one or two lines of its own."""
    wide, narrow = (_branches(rows, lines, step) for step in (3, 2))
    shallow = _branches(rows, lines, 2, MOST_INDENTED_IN_LINES)
    columns = (_in_columns(rows, wide), _in_columns(rows, narrow))
    tables = (*columns, _in_pairs(rows, narrow), _in_lines(rows, narrow), _in_lines(rows, shallow))
    table = next((table for table in tables if table.width <= width), tables[-1])
    return table.lines(is_colored)


class _Branch(NamedTuple):
    """A name with the lines before it and a note after it, and the lines that pass below it."""

    before: str
    name: str
    note: str = ""
    passing: str = ""

    @property
    def width(self) -> int:
        return sum(map(width_of, (self.before, self.name, self.note)))

    def drawn(self, width: int, is_colored: bool) -> str:
        """Return its text, filled up to a width."""
        dim, bold = (DIM, BOLD) if is_colored else ("", "")
        text = f"{styled(self.before, dim)}{styled(self.name, bold)}{styled(self.note, dim)}"
        return text + " " * (width - self.width)


def _branches(rows: Sequence[TreeRow], lines: Lines, step: int, most: int = MOST_INDENTED) -> list[_Branch]:
    """Return the links with their lines; a level is indented by `step` columns, at `most` so many levels are."""
    branches: list[_Branch] = []
    followed: set[int] = set()  # the levels at which another link follows, as rows are drawn from the last one up
    for row in reversed(rows):
        depth = min(row.depth, most)
        passing = [lines.passing[:step] if level in followed else " " * step for level in range(1, depth + 1)]
        own = (lines.branch if depth in followed else lines.last)[: step - 1] + " " if depth else ""
        level = f"({row.depth}) " if row.depth > most else ""
        before = "".join(passing[:-1]) + own + level
        branches.append(_Branch(before, row.link, _note(row, lines), "".join(passing)))
        followed = {level for level in followed if level < depth} | {depth}
    return branches[::-1]


def _note(row: TreeRow, lines: Lines) -> str:
    again = " (again)" if row.is_again else ""
    return again + (f" {lines.ellipsis} {row.hidden} below" if row.hidden else "")


class _Table(NamedTuple):
    """Titles, and rows of a branch and cells; masses are aligned at their right end."""

    titles: Sequence[str]
    rows: Sequence[tuple[_Branch, Sequence[str]]]

    @property
    def widths(self) -> list[int]:
        first = max(width_of(self.titles[0]), *(branch.width for branch, cells in self.rows if any(cells)), 0)
        columns = zip(self.titles[1:], *(cells for _, cells in self.rows), strict=True)
        return [first, *(max(map(width_of, column)) for column in columns)]

    @property
    def width(self) -> int:
        columns = sum(self.widths) + 2 * (len(self.titles) - 1)
        return max(columns, *(branch.width for branch, _ in self.rows))

    def lines(self, is_colored: bool) -> Iterator[str]:
        first, *widths = self.widths
        title = padded(self.titles[0], first) + self._cells(self.titles[1:], widths, False)
        yield styled(title, DIM if is_colored else "")
        for branch, cells in self.rows:
            yield (branch.drawn(first, is_colored) + self._cells(cells, widths, is_colored)).rstrip()

    def _cells(self, cells: Sequence[str], widths: Sequence[int], is_colored: bool) -> str:
        texts = []
        for title, cell, width in zip(self.titles[1:], cells, widths, strict=True):
            text = padded(cell, width) if title != "mass" else " " * (width - width_of(cell)) + cell
            is_moving = title == "type" and cell not in {"", JointType.FIXED}
            texts.append(styled(text, CYAN if is_moving and is_colored else ""))
        return "".join(f"  {text}" for text in texts)


def _in_columns(rows: Sequence[TreeRow], branches: Sequence[_Branch]) -> _Table:
    """Return a table with a row for each link."""
    cells = [(row.joint.name if row.joint else "", *_motion(row.joint), _mass_text(row)) for row in rows]
    return _Table(("link", "joint", "type", "position", "mass"), list(zip(branches, cells, strict=True)))


def _in_pairs(rows: Sequence[TreeRow], branches: Sequence[_Branch]) -> _Table:
    """Return a table with a row for each joint, and one for the link below it."""
    found: list[tuple[_Branch, Sequence[str]]] = []
    for row, branch in zip(rows, branches, strict=True):
        link = branch
        if row.joint:
            kind, position = _motion(row.joint)
            is_long = width_of(position) > LONGEST_POSITION
            found.append((_Branch(branch.before, "", row.joint.name), (kind, "" if is_long else position)))
            if is_long:
                found.append((_Branch(f"{branch.passing}  ", "", position), ("", "")))
            link = branch._replace(before=branch.passing)
        found.append((link, ("", _mass_text(row))))
    return _Table(("joint, and its link below", "type", "position, mass"), found)


def _in_lines(rows: Sequence[TreeRow], branches: Sequence[_Branch]) -> _Table:
    """Return a table without columns: a row for each joint, its position and the link below it."""
    found: list[tuple[_Branch, Sequence[str]]] = []
    for row, branch in zip(rows, branches, strict=True):
        link, mass = branch, _mass_text(row)
        if row.joint:
            kind, position = _motion(row.joint)
            found.append((_Branch(branch.before, "", f"{row.joint.name}  {kind}"), ()))
            if position:
                found.append((_Branch(f"{branch.passing}  ", "", position), ()))
            link = branch._replace(before=branch.passing)
        found.append((link._replace(note=f"  {mass}{link.note}" if mass else link.note), ()))
    return _Table(("joint, and its link below",), found)


def _motion(joint: Joint | None) -> tuple[str, str]:
    return (type_text(joint), motion_text(joint)) if joint else ("", "")


def _mass_text(row: TreeRow) -> str:
    return "" if row.mass is None or row.is_again else f"{short(row.mass)} kg"
