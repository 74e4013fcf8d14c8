"""The graph of a robot as a flowchart of Mermaid, which GitHub draws in Markdown: modules are subgraphs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.overview.graph import ModuleBox, module_boxes, walk_boxes
from linkforge_compile.overview.joint_text import edge_text
from linkforge_compile.overview.tree import TreeRow

_PLAIN = frozenset(" _-./,")


def render_mermaid(name: str, rows: Sequence[TreeRow]) -> str:
    """Return a document for a block of Markdown, or a file of its own."""
    whole = module_boxes(rows)
    nodes = {row.link: f"n{number}" for number, row in enumerate(row for row in rows if not row.is_again)}
    boxes = {box.module: f"m{number}" for number, box in enumerate(walk_boxes(whole))}
    lines = (
        *("---", f"title: {json.dumps(_escaped(name), ensure_ascii=False)}", "---"),
        "flowchart LR",
        *_inside(whole, nodes, boxes, "  "),
        *(_edge(row.joint, nodes) for row in rows if row.joint),
    )
    return "".join(f"{line}\n" for line in lines)


def _inside(
    box: ModuleBox, nodes: Mapping[str, str], boxes: Mapping[tuple[str, ...], str], indent: str
) -> Iterator[str]:
    yield from (f'{indent}{nodes[link]}["{_escaped(link)}"]' for link in box.links)
    for inner in box.boxes:
        yield f'{indent}subgraph {boxes[inner.module]}["{_escaped(inner.name)}"]'
        yield from _inside(inner, nodes, boxes, f"{indent}  ")
        yield f"{indent}end"


def _edge(joint: Joint, nodes: Mapping[str, str]) -> str:
    arrow = "-.->" if joint.type == JointType.FIXED else "-->"
    label = f"{_escaped(joint.name)}<br/>{_escaped(edge_text(joint))}"
    return f'  {nodes[joint.parent]} {arrow}|"{label}"| {nodes[joint.child]}'


def _escaped(text: str) -> str:
    """Return a text in which only letters, digits and plain punctuation are not written as codes."""
    return "".join(char if char.isalnum() or char in _PLAIN else f"#{ord(char)};" for char in text)
