"""Report the same fault of many parts of a robot as one diagnostic."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from itertools import islice

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note, OneOf

SHOWN = 8
"""How many names a message lists, and how many notes it has."""

_PLACES = 3
"""How many places of further parts a grouped diagnostic shows; its message has their names."""


def group_alike(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return a report with all diagnostics that differ only in the name of a part as one, at the first of them.

    Called on the final report in reading order: a comment that suppresses one of them leaves the others.
    """
    groups: dict[object, list[Diagnostic]] = {}
    for number, one in enumerate(diagnostics):
        shared = one.one_of._replace(name="") if one.one_of else number
        groups.setdefault((one.code.id, one.severity, shared), []).append(one)
    return tuple(_as_one(group) for group in groups.values())


def _as_one(group: list[Diagnostic]) -> Diagnostic:
    first, *others = group
    words = [one.one_of for one in group if one.one_of]
    if not others or not words:
        return first
    places = [Note(f"'{one.name}'", each.span) for one, each in zip(words[1:], others, strict=True) if each.span]
    rest = [Note(f"and {len(places) - _PLACES:,} more")] if len(places) > _PLACES + 1 else []
    shown = places[:_PLACES] if rest else places
    return replace(first, message=_sentence(first, words), notes=(*first.notes, *shown, *rest))


def _sentence(first: Diagnostic, words: list[OneOf]) -> str:
    names = dict.fromkeys(one.name for one in words)
    before, _, after = words[0]
    return first.message if len(names) == 1 else f"{before}{join_names(names)}{after}"


def join_names(names: Collection[str], count: int | None = None) -> str:
    """Return "'a', 'b' and 'c'", or the first few and how many more; `count` is that of all names."""
    quoted = [f"'{name}'" for name in islice(names, SHOWN)]
    if (more := (count or len(names)) - SHOWN) > 0:
        quoted[SHOWN - 1 :] = [f"{more + 1} more"]
    return " and ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))
