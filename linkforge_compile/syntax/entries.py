"""The entries of a map, by name: of their keys, what is twice, and what `<<` lays in."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null

STUCK = re.compile(r"[A-Za-z_]\w*:\S.*")
"""A key and its value without the space between them."""


def plain_entries(written: Sequence[tuple[YamlNode, YamlNode]]) -> dict[str, YamlEntry] | None:
    """Return the entries that pairs of nodes make, as of nearly all maps; None where some keys need a second look."""
    entries = {key.text: YamlEntry(key, value) for key, value in written if isinstance(key, YamlScalar)}
    return entries if len(entries) == len(written) and "<<" not in entries else None


def entries_of(
    written: Sequence[tuple[YamlNode, YamlNode]], sink: Diagnostics, *, flow: bool, is_top: bool
) -> dict[str, YamlEntry]:
    """Return the entries that pairs of nodes make; `flow` is whether they stand in braces, `is_top` in the file's map.

    A key that is none is left out, and reported.
    """
    named = [entry for key, value in written if (entry := _entry(key, value, sink, flow=flow))]
    return _merged(_unique(named, sink, is_top=is_top), sink)


def _entry(key: YamlNode, value: YamlNode, sink: Diagnostics, *, flow: bool) -> YamlEntry | None:
    """Return the entry; None where its key is at fault, which is reported."""
    if isinstance(key, YamlScalar) and not (flow and is_null(value)):
        return YamlEntry(key, value)  # all but a few
    if isinstance(key, YamlFault):
        return None
    if not isinstance(key, YamlScalar):
        sink.report(codes.KEY_NOT_SCALAR.at(key.span, found=kind_of(key)))
        return None
    is_bare = value.span.start == value.span.end == key.span.end
    if is_bare and STUCK.fullmatch(key.span.text or ""):
        sink.report(codes.SPACE_AFTER_COLON.at(key.span, text=key.text))
        name = key.text.partition(":")[0]
        return YamlEntry(YamlScalar(name, name, key.span), YamlFault(key.span))
    return YamlEntry(key, value)


def _unique(entries: Sequence[YamlEntry], sink: Diagnostics, *, is_top: bool = False) -> dict[str, YamlEntry]:
    """Return the entries by name; which of two is meant nobody knows, so that what they say is a fault.

    Two sections of one name, at the top, are one with the entries of both, since others use the names in them.
    """
    unique = {entry.key.text: entry for entry in entries}
    if len(unique) == len(entries):
        return unique
    again: dict[str, list[YamlEntry]] = {}
    unique.clear()
    for entry in entries:
        if entry is not (kept := unique.setdefault(entry.name, entry)):
            again.setdefault(entry.name, [kept]).append(entry)
    begin = None if is_top else _begin_of_another(entries, again)
    if begin is not None and (line := _tell_another(entries, begin, again, sink)):
        unique[line.name] = YamlEntry(line.key, YamlFault(line.key.span))
    for first, *others in again.values() if begin is None else ():
        note = Note("first written here", first.key.span)
        sink.report_all(codes.DUPLICATE_KEY.at(one.key.span, key=one.name, more="", notes=[note]) for one in others)
    for name, (first, *others) in again.items():
        value: YamlNode = YamlFault(first.value.span)
        maps = [one.value for one in (first, *others) if isinstance(one.value, YamlMap)]
        if is_top and len(maps) == len(others) + 1:
            value = YamlMap(_unique([entry for each in maps for entry in each], sink), first.value.span)
        unique[name] = YamlEntry(first.key, value)
    return unique


def _begin_of_another(entries: Sequence[YamlEntry], again: Mapping[str, Sequence[YamlEntry]]) -> int | None:
    """Return where the keys of a second entry begin, whose own line is not where it was; None where there is none.

    Such keys are several, and from the first of them on none stands there for the first time and comes again.
    """
    seconds = {id(second) for _, second, *_ in again.values()}
    begin = next((at for at, entry in enumerate(entries) if id(entry) in seconds), 0)
    firsts = {id(first) for first, *_ in again.values()}
    is_one = len(again) > 1 and all(len(each) == 2 for each in again.values())
    return begin if is_one and not any(id(entry) in firsts for entry in entries[begin:]) else None


def _tell_another(
    entries: Sequence[YamlEntry], begin: int, again: Mapping[str, Sequence[YamlEntry]], sink: Diagnostics
) -> YamlEntry | None:
    """Tell of the keys of a second entry at the first of them; return the line with its name, if that stands above."""
    first, before = entries[begin], entries[begin - 1]
    note = Note("first written here", again[first.name][0].key.span)
    others = [f"'{entry.name}'" for entry in entries[begin + 1 :] if entry.name in again]
    more = f"as is {others[0]}" if len(others) == 1 else f"as are {len(others)} more below it"
    line = before if is_null(before.value) and before.name not in again else None
    cause = f"is '{line.name}' above it indented too far?" if line else "is a line with a name missing above it?"
    sink.report(codes.DUPLICATE_KEY.at(first.key.span, key=first.name, more=f", {more}; {cause}", notes=[note]))
    return line


def _merged(entries: dict[str, YamlEntry], sink: Diagnostics) -> dict[str, YamlEntry]:
    """Lay what `<<` names where it stands; the map's own entries win, then those of the earlier map."""
    merge = entries.get("<<")
    if merge is None or merge.key.span.text != "<<":  # in quotes it is a key as any other
        return entries
    merged: dict[str, YamlEntry] = {}
    for entry in entries.values():
        for one in _merge_sources(merge.value, sink) if entry is merge else (entry,):
            merged.setdefault(one.name, entries.get(one.name, one))
    return merged


def _merge_sources(value: YamlNode, sink: Diagnostics) -> Iterator[YamlEntry]:
    """Yield the entries of the map or maps that `<<` names, and report what is none."""
    for source in value if isinstance(value, YamlList) else (value,):
        if isinstance(source, YamlMap):
            yield from source
        elif not isinstance(source, YamlFault):
            sink.report(codes.MERGE_NOT_MAP.at(source.span, found=kind_of(source)))


def kind_of(node: YamlNode) -> str:
    """Return what stands at a node, as messages say it."""
    match node:
        case YamlMap():
            return "a map"
        case YamlList():
            return "a list"
        case YamlScalar(value=None):
            return "nothing"
    return "text" if isinstance(node, YamlScalar) and isinstance(node.value, str) else "a plain value"
