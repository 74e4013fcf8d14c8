"""Report the same fault of many parts of a robot as one diagnostic."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Hashable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import accumulate, islice

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note

SHOWN = 8
"""How many names a message lists, and how many notes it has."""

_WIDTH = 240
"""How many characters the names in a message have, unless one alone has more."""

_PLACES = 3
"""How many places of further parts a grouped diagnostic shows; its message has their names."""


def group_alike(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return a report in which all diagnostics of a file that are alike are one, at the first of them.

    Called on a report in reading order. Groups of reports that were merged are formed anew.
    """
    groups: dict[Hashable, list[Diagnostic]] = {}
    for number, one in enumerate(ungrouped(diagnostics)):
        groups.setdefault(number if one.group is None else one.group, []).append(one)
    return tuple(_as_one(group) for group in groups.values())


def group_at_places(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return a report for an editor, which marks each place: alike diagnostics are one only if they have one place."""
    places: dict[Hashable, list[Diagnostic]] = {}
    for one in ungrouped(diagnostics):
        places.setdefault((one.code.id, _place_of(one)), []).append(one)
    return tuple(one for alike in places.values() for one in group_alike(alike))


def ungrouped(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield diagnostics with the members of each group in its place."""
    for one in diagnostics:
        yield from one.members or (one,)


def _as_one(group: Sequence[Diagnostic]) -> Diagnostic:
    first, *others = group
    if not others:
        return first
    names = dict.fromkeys(one.subject for one in others if one.subject != first.subject)
    same = f"; the same for {join_names(names)}" if names else ""
    # A `for` makes many parts at one place, and so do two uses of a module.
    by_place = {_place_of(one): one for one in reversed(group)}
    elsewhere = [one for one in others if one.span and by_place[_place_of(one)] is one]
    places = [_note(one, first) for one in elsewhere[:_PLACES]]
    rest = [Note(f"and {more:,} more places")] if (more := len(elsewhere) - _PLACES) > 0 else []
    return replace(first, message=f"{first.message}{same}", notes=(*first.notes, *places, *rest), members=tuple(group))


def _place_of(one: Diagnostic) -> Hashable:
    """Return where a diagnostic is, equal for all specs that read the file; None for nowhere."""
    return one.span and (one.span.file.name, one.span.start, one.span.end)


def _note(one: Diagnostic, first: Diagnostic) -> Note:
    """Return a short note, with the whole message only if it differs from that of the first in more than the name."""
    same = first.message.replace(f"'{first.subject}'", f"'{one.subject}'")
    message = f"'{one.subject}' is here" if one.message == same else one.message
    return Note(message, one.span, is_brief=True)


def join_names(names: Collection[str], count: int | None = None) -> str:
    """Return "'a', 'b' and 'c'", or the first few and how many more; `count` is that of all names."""
    quoted = [f"'{name}'" for name in islice(names, SHOWN)]
    ends = list(accumulate(map(len, quoted)))
    total = count or len(names)
    if total > SHOWN or (ends and ends[-1] > _WIDTH):
        kept = max(1, min(SHOWN - 1, bisect_right(ends, _WIDTH)))
        quoted[kept:] = [f"{total - kept:,} more"] if total > kept else []
    return " and ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))
