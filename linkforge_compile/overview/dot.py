"""The graph of a robot in the language of Graphviz: modules are clusters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.overview.graph import ModuleBox, module_boxes
from linkforge_compile.overview.joint_text import edge_text
from linkforge_compile.overview.tree import TreeRow


def render_dot(name: str, rows: Sequence[TreeRow]) -> str:
    """Return a document that `dot -Tpdf` draws."""
    lines = (
        f"digraph {_quoted(name)} {{",
        "  rankdir=LR;",
        '  node [shape=box, style=rounded, fontname="Helvetica"];',
        '  edge [fontname="Helvetica", fontsize=10];',
        *_inside(module_boxes(rows), "  "),
        *(_edge(row.joint) for row in rows if row.joint),
        "}",
    )
    return "".join(f"{line}\n" for line in lines)


def _inside(box: ModuleBox, indent: str) -> Iterator[str]:
    yield from (f"{indent}{_quoted(link)};" for link in box.links)
    for inner in box.boxes:
        yield f"{indent}subgraph {_quoted('cluster_' + '/'.join(inner.module))} {{"
        yield f"{indent}  label={_quoted(inner.name)};"
        yield from _inside(inner, f"{indent}  ")
        yield f"{indent}}}"


def _edge(joint: Joint) -> str:
    style = ", style=dashed" if joint.type == JointType.FIXED else ""
    label = rf"{_quoted(joint.name)[:-1]}\n{edge_text(joint)}" + '"'
    return f"  {_quoted(joint.parent)} -> {_quoted(joint.child)} [label={label}{style}];"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", " ")
    return f'"{escaped}"'
