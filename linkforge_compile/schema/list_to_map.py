"""Fixes that write a list as a map by names, or an entry under its name."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkforge_compile.diagnostics.fix import Edit, Fix, shift_lines, shift_lines_below
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, is_null

_STEP = 2
_DASH = re.compile(r" *- +")
_NAME = re.compile(r"[\w$().:/-]+")


def as_map(items: YamlList, key: Span | None, *, is_empty_allowed: bool) -> Fix | None:
    """Return the fix that writes the items of a list as entries of a map, each by its `name` or its only key.

    `key` is that of the list. A text is an entry without a value, where these are allowed. None for other items, for
    names that are there twice, and for what is written in another way.
    """
    names = [_name_of(item, is_empty_allowed=is_empty_allowed) for item in items]
    texts = [name.text for name in names if name]
    if not texts or len(texts) < len(names) or len({*texts}) < len(texts) or not all(map(_NAME.fullmatch, texts)):
        return None
    file = items.span.file
    if file.is_xml or items.span.origin or any(item.span.file is not file for item in items):
        return None
    if items.span.is_flow:
        entries = [_in_flow(item, name) for item, name in zip(items, names, strict=True) if name]
        new = f"{{{', '.join(entries)}}}"
        return Fix("write a map", (Edit(items.span, new),)) if all(entries) and items.span.text else None
    edits = [edit for item, name in zip(items, names, strict=True) if name for edit in _in_block(item, name, key)]
    return Fix("write a map", tuple(edits)) if edits and len({edit.span for edit in edits}) == len(edits) else None


def as_entries(items: YamlList, entries: Sequence[str], key: Span | None) -> Fix | None:
    """Return the fix that writes entries of a map in place of a list; `key` is that of the list."""
    place, file = items.span, items.span.file
    if not entries or key is None or file.is_xml or place.origin:
        return None
    if place.is_flow:
        return Fix("write a map", (Edit(place, f"{{{', '.join(entries)}}}"),))
    shift = 0 if place.column > key.column else _STEP
    separator = f"{file.newline}{' ' * (place.column - 1 + shift)}"
    return Fix("write a map", (Edit(place, " " * shift + separator.join(entries)),))


def under_name(node: YamlMap) -> Fix | None:
    """Return the fix that writes the entries of a map under its first key, which has no value; None for another map."""
    name, *entries = node
    file, title = node.span.file, f"write '{name.name}: {{{entries[0].name}: …}}'" if entries else ""
    if not entries or not is_null(name.value) or file.is_xml:
        return None
    if node.span.is_flow:
        between = Span(file, *name.key.span.end, *entries[0].key.span.start)
        end = Span(file, *entries[-1].value.span.end, *entries[-1].value.span.end)
        return Fix(title, (Edit(between, ": {"), Edit(end, "}")))
    below = Span(file, *entries[0].key.span.start, *entries[-1].value.span.end)
    return None if name.key.span.line == below.line else Fix(title, shift_lines(below, _STEP))


def _name_of(item: YamlNode, *, is_empty_allowed: bool) -> YamlScalar | None:
    """Return the name of an item: that of a map by its first entry, or its only key."""
    if isinstance(item, YamlScalar):
        return item if is_empty_allowed and isinstance(item.value, str) else None
    if not isinstance(item, YamlMap) or not len(item):
        return None
    name = item.get("name")
    if isinstance(name, YamlScalar) and next(iter(item)).name == "name":
        return name
    return next(iter(item)).key if len(item) == 1 else None


def _in_flow(item: YamlNode, name: YamlScalar) -> str:
    """Return an item as an entry in braces; "" for one that is not on one line."""
    if isinstance(item, YamlScalar):
        return f"{name.text}: "
    entries = [one for one in item if one.value is not name] if isinstance(item, YamlMap) else []
    if entries and entries[0].key is name:
        text = entries[0].value.span.text
        return "" if text is None else f"{name.text}: {text}"
    texts = [_entry_text(one) for one in entries]
    return f"{name.text}: {{{', '.join(texts)}}}" if all(texts) else ""


def _entry_text(entry: YamlEntry) -> str:
    text = entry.value.span.text
    return "" if text is None else f"{entry.name}: {text}"


def _in_block(item: YamlNode, name: YamlScalar, key: Span | None) -> list[Edit]:
    """Return the edits of an item with a dash; none for one that has something else on its lines."""
    place, file = item.span, item.span.file
    dash = _DASH.fullmatch(file.line(place.line)[: place.column - 1])
    if dash is None or place.line != name.span.line:
        return []
    column = place.column - len(dash[0].lstrip())  # of the dash
    shift = 0 if key is None or column > key.column else _STEP
    begin, blank = Span(file, place.line, 1, *place.start), " " * (column - 1 + shift)
    whole = Span(file, *place.start, *place.end)
    if isinstance(item, YamlScalar):
        return [Edit(begin, blank), Edit(Span(file, *place.end, *place.end), ":")]
    if place.is_flow:
        text = _in_flow(item, name)
        return [Edit(begin, blank), Edit(whole, text)] if text else []
    own = next(iter(item)) if isinstance(item, YamlMap) else None
    if own is None or own.key is name:
        return [Edit(begin, blank), *shift_lines_below(place, shift - (place.column - column))]
    after = Span(file, *place.start, *name.span.end)
    return [Edit(begin, blank), Edit(after, f"{name.text}:"), *shift_lines_below(place, shift)]
