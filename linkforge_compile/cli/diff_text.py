"""The differences of two robots as lines for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby

from linkforge_compile.compare import Difference, RemovedName, removed_parts

_DEPTH = {"semantic": 3}
"""The length of the path to a part that is printed on a line of its own, by section; 2 in other sections."""

_SIGNS = {"added": "+", "removed": "-", "renamed": ">", "moved": ">", "changed": "~"}

BREAKING = "breaking: removed names that others may rely on"


def difference_lines(
    labels: tuple[str, str], differences: Sequence[Difference], removed: Sequence[RemovedName]
) -> Iterator[str]:
    """Yield the numbers of differences, the removed names, and each part by section."""
    kinds = Counter[str](difference.kind for difference in differences)
    yield f"{' → '.join(labels)}: {', '.join(f'{kinds[kind]} {kind}' for kind in _SIGNS if kind in kinds)}"
    yield from _removed_lines(removed)
    for section, members in groupby(differences, key=lambda difference: difference.path[0]):
        yield from ("", section)
        for part, group in groupby(members, key=lambda difference: difference.path[1 : _DEPTH.get(section, 2)]):
            yield from _part_lines(part, list(group))


def _removed_lines(removed: Sequence[RemovedName]) -> Iterator[str]:
    """Yield the kind and name of each removed name, and the interfaces of a joint in one line."""
    if not removed:
        return
    yield from ("", BREAKING)
    width = max(len(name.kind) for name in removed)
    yield from (f"  {kind:{width}}  {text}" for kind, text in removed_parts(removed))


def _part_lines(part: tuple[str, ...], differences: Sequence[Difference]) -> Iterator[str]:
    """Yield what happened to a part as a whole, then what differs in it."""
    name, steps = "/".join(part), len(part) + 1
    whole = [difference for difference in differences if len(difference.path) <= steps]
    for difference in whole:
        sign = _SIGNS[difference.kind]
        yield f"  {sign} {name}: {difference.text}" if name else f"  {sign} {difference.text}"
    inner = [difference for difference in differences if len(difference.path) > steps]
    if inner and not whole:
        yield f"  ~ {name}"
    for difference in inner:
        sign = "" if difference.kind == "changed" else f"{_SIGNS[difference.kind]} "
        yield f"      {sign}{'/'.join(difference.path[steps:])}: {difference.text}"
