"""Circles among things that use one another by name: links through joints, joints by mimic, groups by subgroups."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.checks.references import SHOWN, Use
from linkforge_compile.diagnostics import Code, Diagnostic

Graph: TypeAlias = Mapping[str, Sequence[Use]]
"""Who uses whom; a walk starts at the names in their order. Names without an entry end it."""


def circles(graph: Graph) -> Iterator[tuple[Use, ...]]:
    """Yield every circle once, as the uses round it; without the last of them there would be none.

    Depth first without recursion, since a chain may be 10,000 links long; linear in names and uses.
    """
    done: set[str] = set()
    for start in graph:
        if start in done:
            continue
        path: list[Use] = []
        depth = {start: 0}
        pending = [iter(graph[start])]
        while pending:
            use = next(pending[-1], None)
            if use is None:
                pending.pop()
                left = path.pop().name if path else start
                del depth[left]
                done.add(left)
            elif use.name in depth:
                yield (*path[depth[use.name] :], use)
            elif use.name not in done:
                path.append(use)
                depth[use.name] = len(path)
                pending.append(iter(graph.get(use.name, ())))


def told_circles(graph: Graph, code: Code) -> Iterator[Diagnostic]:
    """Tell each circle once, at the use that closes it, with the others as notes."""
    for circle in circles(graph):
        closing = circle[-1]
        notes = [use.note(f"{use.user} leads to '{use.name}'") for use in circle[:-1][:SHOWN]]
        path = shown_path([closing.name, *(use.name for use in circle)])
        yield closing.told(code, path=path, notes=notes)


def shown_path(names: Sequence[str]) -> str:
    """Return "a → b → a"; of a long way round, its first and last names."""
    if len(names) <= SHOWN:
        return " → ".join(names)
    return " → ".join((*names[: SHOWN - 3], "…", *names[-2:]))
