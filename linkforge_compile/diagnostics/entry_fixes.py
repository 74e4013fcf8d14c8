"""Fixes that leave out, add or exchange entries and items of YAML, by the places of what is there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from linkforge_compile.diagnostics.fix import Edit, Fix, shift_lines_below
from linkforge_compile.source import Located, SourceFile, SourceRef, Span

_BLANK = re.compile(r"(?:\s|(?<!\S)#[^\r\n]*)*")
_COLON = re.compile(r"[ \t]*:")
_CLOSING = re.compile(r"\s*\}")
_SEPARATOR = re.compile(r"\s*, *")
_BETWEEN = re.compile(r"\s*,?\s*")
_DASHES = re.compile(r" *(?:- +)?")


def leave_out(ref: SourceRef | None, *path: str | int) -> Fix | None:
    """Return the fix that leaves out the entry or item at the end of a path; None if it is not written there.

    So it is in a URDF, in the value of an expression, and where the lines have something else.
    """
    return leave_out_all(ref, [path], f"remove '{path[-1]}'")


def leave_out_all(ref: SourceRef | None, paths: Iterable[Sequence[str | int]], title: str) -> Fix | None:
    """Return the fix that leaves out several entries or items; None if one of them is not written there."""
    places = [_place_at(ref.node, path) if ref else None for path in paths]
    return _removal(places, title, is_item=False)


def leave_out_item(items: Span, title: str) -> Fix | None:
    """Return the fix that leaves out an item of a list; None if it is not written as YAML."""
    return _removal([items if _is_written(items) else None], title, is_item=True)


def leave_out_entry(key: Span, value: Span | None) -> Fix | None:
    """Return the fix that leaves out the entry of a key and its value, None for one that is empty."""
    if value is None:
        colon = _COLON.match(key.file.counted, key.file.index_of(*key.end))
        value = key._replace(end_column=key.end_column + len(colon[0])) if colon else key
    return _removal([_place_of(key, value)], f"remove '{key.text}'", is_item=False)


def as_items(entries: Sequence[tuple[Span, Span]], title: str) -> Fix | None:
    """Return the fix that writes a map as a list with an item for each entry, of which these are keys and values.

    None for a map that is an item itself.
    """
    places = [_place_of(key, value) for key, value in entries]
    written = [place for place in places if place]
    if len(written) < len(places) or not written:
        return None
    file, first, last = written[0].file, written[0], written[-1]
    begin, closing = _before(file, file.index_of(*first.start)), _CLOSING.match(file.counted, file.index_of(*last.end))
    if closing and file.counted[begin - 1 : begin] == "{":
        around = _before(file, begin - 1)
        if file.counted[around - 1 : around] in ("-", ",", "["):
            return None
        whole = file.between(begin - 1, closing.end())
        items = ", ".join(f"{{{one.full_text}}}" for one in written)
        return Fix(title, (Edit(whole, f"[{items}]"),))
    if not all(place.begins_line for place in written):
        return None
    edits = [Edit(Span(file, *place.start, *place.start), "- ") for place in written]
    return Fix(title, (*edits, *(edit for place in written for edit in shift_lines_below(place, len("- ")))))


def add_entry(ref: SourceRef | None, *path: str | int, entry: str, after: str = "") -> Fix | None:
    """Return the fix that adds an entry, such as `lidar: {}`, to the map at a path; None if none is written there.

    It becomes the first entry, or the next one after a key. A map that has its key gets no second one.
    """
    node: Located | None = ref.node if ref else None
    for step in path:
        node = None if node is None else node.child(step)
    if node is None or not _is_written(node.span) or node.child(entry.partition(":")[0]) is not None:
        return None
    place, file, title = node.span, node.span.file, f"write '{entry}'"
    if before := _place_at(node, [after]) if after else None:
        end = before.end
        if _is_in_flow(file, file.index_of(*end)):
            return Fix(title, (Edit(Span(file, *end, *end), f", {entry}"),))
        end = end._replace(column=len(file.line(end.line)) + 1)
        new = f"{file.newline}{' ' * (before.column - 1)}{entry}"
        return Fix(title, (Edit(Span(file, *end, *end), new),)) if _begins_line(before) else None
    text = place.full_text
    if place.is_flow:
        begin, new = place.start._replace(column=place.column + 1), f"{entry}{', ' if text[1:-1].strip() else ''}"
    else:
        begin, new = place.start, f"{entry}{file.newline}{' ' * (place.column - 1)}"
    is_map = place.is_flow or (text and _begins_line(place))
    return Fix(title, (Edit(Span(file, *begin, *begin), new),)) if is_map else None


def add_to_short_form(ref: SourceRef | None, key: str, entry: str) -> Fix | None:
    """Return the fix that adds an entry to a map with a key, or to the value of that key that is written alone."""
    if ref is None or ref.node.child(key) is not None:
        return add_entry(ref, entry=entry, after=key)
    place = ref.node.span
    is_value = _is_written(place) and place.text
    return Fix(f"write '{entry}'", (Edit(place, f"{{{key}: {place.text}, {entry}}}"),)) if is_value else None


def exchange(title: str, first: Span | None, second: Span | None) -> Fix | None:
    """Return the fix that exchanges two texts on a line of their own; None if they are not two."""
    if first is None or second is None or first.start == second.start or not first.text or not second.text:
        return None
    is_written = first.file is second.file and _is_written(first) and _is_written(second)
    return Fix(title, (Edit(first, second.text), Edit(second, first.text))) if is_written else None


def move_entry(ref: SourceRef, section: str, name: str, to: str, *, is_only: bool) -> Fix | None:
    """Return the fix that moves an entry of a section to another one; the only one by the key of the section."""
    key = ref.node.key_span(section)
    inner = ref.node.child(section)
    value = None if inner is None else inner.child(name)
    if is_only and ref.node.child(to) is None and key and _is_written(key):
        return Fix(f"write '{to}'", (Edit(key, to),))
    if value is None or not value.span.text:
        return None
    entry = f"{name}: {value.span.text}"
    whole = add_entry(ref, entry=f"{to}: {{{entry}}}", after=section) if ref.node.child(to) is None else None
    added = whole or add_entry(ref, to, entry=entry)
    return together(f"write '{to}: {{{name}: …}}'", added, leave_out(ref, section, name))


def together(title: str, *fixes: Fix | None) -> Fix | None:
    """Return the fix that makes the edits of several; None if one of them is None."""
    if any(fix is None for fix in fixes):
        return None
    return Fix(title, tuple(edit for fix in fixes if fix for edit in fix.edits))


def _is_written(place: Span) -> bool:
    """Whether the text at a place is YAML and its own value."""
    return not place.file.is_xml and place.origin is None


def _place_at(node: Located | None, path: Sequence[str | int]) -> Span | None:
    """Return the place of the entry, with its key, at the end of a path; None if it is not written as YAML."""
    *steps, last = path
    for step in steps:
        node = None if node is None else node.child(step)
    value, key = (None, None) if node is None else (node.child(last), node.key_span(str(last)))
    return None if key is None or value is None else _place_of(key, value.span)


def _place_of(key: Span, value: Span) -> Span | None:
    if key.file is not value.file or key.start > value.start or not (_is_written(key) and _is_written(value)):
        return None
    return Span(key.file, *key.start, *max(key.end, value.end))


def _begins_line(place: Span) -> bool:
    """Whether only the dash of an item is before a place on its line."""
    return _DASHES.fullmatch(place.file.line(place.line)[: place.column - 1]) is not None


def _is_in_flow(file: SourceFile, end: int) -> bool:
    """Whether what ends at an index is in brackets or braces."""
    blank = _BLANK.match(file.counted, end)
    after = blank.end() if blank else end
    return file.counted[after : after + 1] in (",", "}", "]")


def _before(file: SourceFile, index: int) -> int:
    """Return the index after the last character before an index that is no space."""
    while file.counted[index - 1 : index].isspace():
        index -= 1
    return index


def _removal(places: Iterable[Span | None], title: str, *, is_item: bool) -> Fix | None:
    """Return the fix that removes entries or items of one file, and what separates them from others."""
    known = [*places]
    written = sorted((place for place in known if place), key=lambda place: place.start)
    if not written or len(written) < len(known) or len({id(place.file) for place in written}) > 1:
        return None
    edits = [_edit(place, is_item=is_item) for place in _joined(written)]
    return None if None in edits else Fix(title, tuple(edit for edit in edits if edit))


def _joined(places: Iterable[Span]) -> list[Span]:
    """Return places in order, neighbours as one."""
    joined: list[Span] = []
    for place in places:
        last, file = joined[-1] if joined else None, place.file
        if last and _BETWEEN.fullmatch(file.counted, file.index_of(*last.end), file.index_of(*place.start)):
            joined[-1] = Span(file, *last.start, *place.end)
        else:
            joined.append(place)
    return joined


def _edit(place: Span, *, is_item: bool) -> Edit | None:
    """Return the edit that removes neighbours of a list or map; None if their lines have something else."""
    file = place.file
    text, (begin, end) = file.counted, place.range
    if _is_in_flow(file, end):
        before = _before(file, begin)
        if separator := _SEPARATOR.match(text, end):
            end = separator.end()
        elif text[before - 1 : before] == ",":
            begin = before - 1
            if "#" in text[text.rfind("\n", 0, begin) + 1 : begin]:  # the comma may be in a comment
                return None
        elif text[before - 1 : before] not in ("{", "["):
            return None
        return Edit(file.between(begin, end), "")
    if not _begins_line(place):
        return None
    if "-" in file.line(place.line)[: place.column - 1] and not is_item:
        following = file.line(place.end_line + 1)
        is_entry = following[: place.column - 1].isspace() and following[place.column - 1 :][:1].strip()
        return Edit(Span(file, *place.start, place.end_line + 1, place.column), "") if is_entry else None
    return Edit(Span(file, place.line, 1, place.end_line + 1, 1), "")
