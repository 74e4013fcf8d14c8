"""Report the same fault of many parts of a robot as one diagnostic."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from itertools import islice

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note

SHOWN = 8
"""How many names a message lists, and how many notes it has."""

_PLACES = 3
"""How many places of further parts a grouped diagnostic shows; its message has their names."""


def group_alike(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return a report in which all diagnostics of a file that are alike are one, at the first of them.

    Called on the final report in reading order: a comment that suppresses one of them leaves the others.
    """
    groups: dict[object, list[Diagnostic]] = {}
    for number, one in enumerate(diagnostics):
        file = one.span.file.name if one.span else ""
        shared = (file, one.one_of.alike) if one.one_of else number
        groups.setdefault((one.code.id, one.severity, shared), []).append(one)
    return tuple(_as_one(group) for group in groups.values())


def _as_one(group: list[Diagnostic]) -> Diagnostic:
    first, *others = group
    names = dict.fromkeys(one.one_of.name for one in group if one.one_of)
    if not others or not first.one_of:
        return first
    del names[first.one_of.name]
    same = f"; the same for {join_names(names)}" if names else ""
    places = [Note(one.message, one.span) for one in others if one.span]
    rest = [Note(f"and {len(places) - _PLACES:,} more")] if len(places) > _PLACES + 1 else []
    shown = places[:_PLACES] if rest else places
    return replace(first, message=f"{first.message}{same}", notes=(*first.notes, *shown, *rest))


def join_names(names: Collection[str], count: int | None = None) -> str:
    """Return "'a', 'b' and 'c'", or the first few and how many more; `count` is that of all names."""
    quoted = [f"'{name}'" for name in islice(names, SHOWN)]
    if (more := (count or len(names)) - SHOWN) > 0:
        quoted[SHOWN - 1 :] = [f"{more + 1} more"]
    return " and ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))
