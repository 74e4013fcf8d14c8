"""Cycles among things that use one another by name: links through joints, joints by mimic, groups by subgroups."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.checks.references import SHOWN, Use
from linkforge_compile.core.models.graph import find_cycles
from linkforge_compile.diagnostics import Code, Diagnostic

Graph: TypeAlias = Mapping[str, Sequence[Use]]
"""What each name uses."""


def cycles(graph: Graph) -> Iterator[list[Use]]:
    """Yield every cycle once, as the uses round it; without the last of them there would be none."""
    for cycle in find_cycles({name: [use.name for use in uses] for name, uses in graph.items()}):
        yield [graph[name][place] for name, place in cycle]


def report_cycles(graph: Graph, code: Code) -> Iterator[Diagnostic]:
    """Report each cycle once, at the use that closes it, with the others as notes."""
    for cycle in cycles(graph):
        closing = cycle[-1]
        notes = [use.note(f"{use.user} leads to '{use.name}'") for use in cycle[:-1][:SHOWN]]
        path = shown_path([closing.name, *(use.name for use in cycle)])
        yield closing.told(code, path=path, notes=notes)


def shown_path(names: Sequence[str]) -> str:
    """Return "a → b → a"; of a long way round, its first and last names."""
    if len(names) <= SHOWN:
        return " → ".join(names)
    return " → ".join((*names[: SHOWN - 3], "…", *names[-2:]))
