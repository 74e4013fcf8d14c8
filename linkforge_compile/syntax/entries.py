"""Make the entries of a map: report faulty and repeated keys, and merge `<<`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.syntax.fixes import space_after_colon
from linkforge_compile.syntax.nodes import (
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    has_expression,
    is_null,
)

STUCK = re.compile(r"[A-Za-z_]\w*:\S.*")
"""A key and its value without a space between them."""


def make_entries(
    written: Sequence[tuple[YamlNode, YamlNode]], sink: Diagnostics, *, flow: bool, is_top: bool
) -> dict[str, YamlEntry]:
    """Return the entries of pairs of nodes, by name; report faulty keys and leave them out.

    `flow` is whether the map is in braces, `is_top` whether it is the file's own map.
    """
    entries = {key.text: YamlEntry(key, value) for key, value in written if isinstance(key, YamlScalar)}
    is_plain = len(entries) == len(written) and "<<" not in entries
    if is_plain and not (flow and any(is_null(value) for _, value in written)):
        return entries
    named = [entry for key, value in written if (entry := _make_entry(key, value, sink, flow=flow))]
    return _merge(_unique(named, sink, is_top=is_top), sink)


def _make_entry(key: YamlNode, value: YamlNode, sink: Diagnostics, *, flow: bool) -> YamlEntry | None:
    """Return an entry; None where its key is faulty, which is reported."""
    if isinstance(key, YamlScalar) and not (flow and is_null(value)):
        return YamlEntry(key, value)
    if isinstance(key, YamlFault):
        return None
    if not isinstance(key, YamlScalar):
        sink.report(codes.KEY_NOT_SCALAR.at(key.span, found=kind_of(key)))
        return None
    is_bare = value.span.start == value.span.end == key.span.end
    if is_bare and STUCK.fullmatch(key.span.text or ""):
        sink.report(space_after_colon(key.span, key.text))
        name = key.text.partition(":")[0]
        return YamlEntry(YamlScalar(name, name, key.span), YamlFault(key.span))
    return YamlEntry(key, value)


def _unique(entries: Sequence[YamlEntry], sink: Diagnostics, *, is_top: bool = False) -> dict[str, YamlEntry]:
    """Return the entries by name; the value of a repeated key becomes a YamlFault.

    Two sections of the same name at the top of a file are merged, because other sections use the names in them.
    """
    unique = {entry.key.text: entry for entry in entries}
    if len(unique) == len(entries):
        return unique
    again: dict[str, list[YamlEntry]] = {}
    unique.clear()
    for entry in entries:
        if entry is not (kept := unique.setdefault(entry.name, entry)):
            again.setdefault(entry.name, [kept]).append(entry)
    begin = None if is_top else _find_second_entry(entries, again)
    if begin is not None and (line := _report_second_entry(entries, begin, again, sink)):
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


def _find_second_entry(entries: Sequence[YamlEntry], again: Mapping[str, Sequence[YamlEntry]]) -> int | None:
    """Return the index at which the keys of a second entry begin whose own line is missing; None for no such entry.

    It has several repeated keys, and after its first one no key that is repeated later.
    """
    seconds = {id(second) for _, second, *_ in again.values()}
    begin = next((at for at, entry in enumerate(entries) if id(entry) in seconds), 0)
    firsts = {id(first) for first, *_ in again.values()}
    is_one = len(again) > 1 and all(len(each) == 2 for each in again.values())
    return begin if is_one and not any(id(entry) in firsts for entry in entries[begin:]) else None


def _report_second_entry(
    entries: Sequence[YamlEntry], begin: int, again: Mapping[str, Sequence[YamlEntry]], sink: Diagnostics
) -> YamlEntry | None:
    """Report the keys of a second entry at the first of them; return the entry above if that may be its name."""
    first, before = entries[begin], entries[begin - 1]
    note = Note("first written here", again[first.name][0].key.span)
    others = [f"'{entry.name}'" for entry in entries[begin + 1 :] if entry.name in again]
    more = f"as is {others[0]}" if len(others) == 1 else f"as are {len(others)} more below it"
    line = before if is_null(before.value) and before.name not in again else None
    cause = f"is '{line.name}' above it indented too far?" if line else "is a line with a name missing above it?"
    sink.report(codes.DUPLICATE_KEY.at(first.key.span, key=first.name, more=f", {more}; {cause}", notes=[note]))
    return line


def _merge(entries: dict[str, YamlEntry], sink: Diagnostics) -> dict[str, YamlEntry]:
    """Put the entries that `<<` names in its place; the map's own entries win, then those of the earlier map."""
    merge = entries.get("<<")
    if merge is None or merge.key.span.text != "<<":  # in quotes it is an ordinary key
        return entries
    merged: dict[str, YamlEntry] = {}
    for entry in entries.values():
        for one in _merge_sources(merge.value, sink) if entry is merge else (entry,):
            merged.setdefault(one.name, entries.get(one.name, one))
    return merged


def _merge_sources(value: YamlNode, sink: Diagnostics) -> Iterator[YamlEntry]:
    """Yield the entries of the map or maps that `<<` names; report anything else."""
    for source in value if isinstance(value, YamlList) else (value,):
        if isinstance(source, YamlMap):
            yield from source
        elif not isinstance(source, YamlFault):
            is_computed = isinstance(source, YamlScalar) and has_expression(source.text)
            hint = "; write '$(merge(a, b))' in place of this map to merge computed ones" if is_computed else ""
            sink.report(codes.MERGE_NOT_MAP.at(source.span, found=f"{kind_of(source)}{hint}"))


def kind_of(node: YamlNode) -> str:
    """Return what messages call a node: "a map", "text", ..."""
    match node:
        case YamlMap():
            return "a map"
        case YamlList():
            return "a list"
        case YamlScalar(value=None):
            return "nothing"
    return "text" if isinstance(node, YamlScalar) and isinstance(node.value, str) else "a plain value"
