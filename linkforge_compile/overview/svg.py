"""The graph of a robot as a picture: a row for each link, indented by depth, with its modules as boxes.

Text widths are estimated, since the font is unknown: monospaced fonts have similar widths.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.diagnostics.terminal import width_of
from linkforge_compile.formats.environment import render_own
from linkforge_compile.overview.graph import ModuleRun, module_runs
from linkforge_compile.overview.joint_text import edge_text
from linkforge_compile.overview.tree import TreeRow

# All sizes are in pixels.
MARGIN, TITLE_HEIGHT = 16, 40
ROW, NODE_HEIGHT, INDENT = 30, 22, 28
BOX_HEADER, BOX_FOOTER, BOX_PADDING = 22, 8, 7
LINK_CHARACTER, JOINT_CHARACTER = 8, 7
"""The width of a character in the names of links and of joints."""
LARGEST_INDENT = 60
"""The largest number of levels that are indented."""


class Node(NamedTuple):
    """A link, by its upper left corner, with an SVG path from the link above it, and the joint between them.

    `kind` of the joint is `fixed`, `moving`, or `following` for one with mimic.
    """

    x: int
    y: int
    width: int
    name: str
    joint: str
    type: str
    kind: str
    is_again: bool
    elbow: str

    @property
    def middle(self) -> int:
        return self.y + NODE_HEIGHT // 2

    @property
    def right(self) -> int:
        label = width_of(f"{self.joint} {self.type}") * JOINT_CHARACTER if self.joint else 0
        return self.x + self.width + 10 + label


class Box(NamedTuple):
    """A module, as a rectangle with its name."""

    x: int
    y: int
    width: int
    height: int
    name: str
    level: int


def render_svg(name: str, rows: Sequence[TreeRow]) -> str:
    """Return a picture that browsers show in light and dark."""
    runs = module_runs(rows)
    left = MARGIN + BOX_PADDING * max((run.height for run in runs), default=0)
    tops, bottom = _tops(rows, runs)
    nodes = list(_nodes(rows, tops, left))
    boxes = [_box(run, rows, nodes) for run in runs]
    right = max(
        (*(node.right for node in nodes), *(box.x + box.width for box in boxes), width_of(name) * 10), default=0
    )
    picture = {"name": name, "width": right + MARGIN, "height": bottom + MARGIN, "nodes": nodes, "boxes": boxes}
    return render_own("overview/graph.svg.xml.j2", {"picture": picture, "node_height": NODE_HEIGHT})


def _tops(rows: Sequence[TreeRow], runs: Sequence[ModuleRun]) -> tuple[list[int], int]:
    """Return the upper edge of each row, below the names of the boxes that begin there, and the lower edge of all."""
    y, tops = TITLE_HEIGHT, []
    begins, ends = [0] * len(rows), [0] * len(rows)
    for run in runs:
        begins[run.first] += 1
        ends[run.last] += 1
    for begin, end in zip(begins, ends, strict=True):
        y += begin * BOX_HEADER
        tops.append(y)
        y += ROW + end * BOX_FOOTER
    return tops, y


def _nodes(rows: Sequence[TreeRow], tops: Sequence[int], left: int) -> Iterator[Node]:
    corners: list[tuple[int, int]] = []  # of the links above, where their lines down begin
    for row, y in zip(rows, tops, strict=True):
        x = left + INDENT * min(row.depth, LARGEST_INDENT)
        del corners[row.depth :]
        middle = y + NODE_HEIGHT // 2
        elbow = f"M{corners[-1][0]} {corners[-1][1]}V{middle}H{x}" if corners else ""
        corners.append((x + INDENT // 2 - 2, y + NODE_HEIGHT))
        name = f"{row.link} (again)" if row.is_again else row.link
        yield Node(
            x,
            y,
            width_of(name) * LINK_CHARACTER + 16,
            name,
            row.joint.name if row.joint else "",
            edge_text(row.joint) if row.joint else "",
            _kind(row.joint),
            row.is_again,
            elbow,
        )


def _kind(joint: Joint | None) -> str:
    if joint is None or joint.type == JointType.FIXED:
        return "fixed"
    return "following" if joint.mimic else "moving"


def _box(run: ModuleRun, rows: Sequence[TreeRow], nodes: Sequence[Node]) -> Box:
    """Return the rectangle of a run, as wide as its links and its name."""
    inside, level = nodes[run.first : run.last + 1], len(run.module)
    x = min(node.x for node in inside) - BOX_PADDING * run.height
    y = inside[0].y - BOX_HEADER * (len(rows[run.first].modules) - level + 1)
    bottom = inside[-1].y + NODE_HEIGHT + BOX_FOOTER * (len(rows[run.last].modules) - level + 1)
    name = f"{run.module[-1]} (continued)" if run.is_continued else run.module[-1]
    right = max(x + width_of(name) * JOINT_CHARACTER + 16, *(node.right + BOX_PADDING * run.height for node in inside))
    return Box(x, y, right - x, bottom - y, name, level)
