"""Fixes that write entries of a map under another key of it, or without the map around them."""

from __future__ import annotations

from collections.abc import Sequence

from linkforge_compile.diagnostics.fix import Edit, Fix, shift_lines, shift_lines_below
from linkforge_compile.schema.shapes import nested
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar, is_null

_STEP = "  "
_MARKS_OF_FLOW = frozenset(",[]{}\n")


def under_key(key: str, entries: Sequence[YamlEntry], around: YamlMap) -> Fix | None:
    """Return the fix that writes neighbours in a map under a key of it, which may be the section just before them.

    None if that is not an edit of their lines alone.
    """
    written, first = list(around), entries[0]
    at = next(index for index, entry in enumerate(written) if entry is first)
    place = _place(entries)
    if written[at : at + len(entries)] != [*entries] or place is None:
        return None
    section, title = around.get(key), f"write '{key}: {{{first.name}: …}}'"
    if around.span.is_flow:
        if section is not None:
            return None
        begin, end = (Span(place.file, *at, *at) for at in (place.start, place.end))
        return Fix(title, (Edit(begin, f"{key}: {{"), Edit(end, "}")))
    if section is None:
        start = Span(place.file, *place.start, *place.start)
        line = f"{key}:{place.file.newline}{' ' * (place.column - 1)}{_STEP}"
        return Fix(title, (Edit(start, line), *shift_lines_below(place, len(_STEP))))
    before = written[at - 1] if at else None
    inner = next(iter(section), None) if isinstance(section, YamlMap) and not section.span.is_flow else None
    if before is None or before.value is not section or inner is None:
        return None
    return Fix(title, shift_lines(place, inner.key.span.column - place.column))


def as_path(steps: Sequence[str], entry: YamlEntry) -> Fix | None:
    """Return the fix that writes the value of an entry under a path of keys, on its line; None for longer values."""
    place, value = _place([entry]), entry.value
    text = value.span.text
    is_plain = isinstance(value, YamlScalar) and not _MARKS_OF_FLOW.isdisjoint(text or "")
    if place is None or place.text is None or not text or is_null(value) or (is_plain and text[0] not in "'\""):
        return None
    new = nested(steps, text)
    return Fix(f"write '{nested(steps, '…')}'", (Edit(place, new),))


def in_place(new: Sequence[str], entries: Sequence[YamlEntry], around: YamlMap) -> Fix | None:
    """Return the fix that writes new entries for neighbours in a map; None if they are none."""
    written, place = list(around), _place(entries)
    at = next(index for index, entry in enumerate(written) if entry is entries[0])
    if place is None or written[at : at + len(entries)] != [*entries]:
        return None
    separator = ", " if around.span.is_flow else f"{place.file.newline}{' ' * (place.column - 1)}"
    return Fix(f"write '{', '.join(new)}'", (Edit(place, separator.join(new)),))


def section_of(key: str, inner: Sequence[str], entry: YamlEntry, around: YamlMap) -> Fix | None:
    """Return the fix that writes a section with entries on lines of their own in place of an entry."""
    place = _place([entry])
    if place is None or around.get(key) is not None:
        return None
    indentation = f"{place.file.newline}{' ' * (place.column - 1 + len(_STEP))}"
    lines = "".join(f"{indentation}{one}" for one in inner)
    text = f"{key}:{lines}" if len(inner) > 1 and not around.span.is_flow else f"{key}: {{{', '.join(inner)}}}"
    return Fix(f"write '{key}'", (Edit(place, text),))


def without_map(entry: YamlEntry, around: YamlMap) -> Fix | None:
    """Return the fix that writes the entries of a map without the map; None if they are not on lines of their own."""
    place, inner = _place([entry]), entry.value
    if place is None or not isinstance(inner, YamlMap) or not inner.entries:
        return None
    title, first = f"remove '{entry.name}'", next(iter(inner)).key.span
    if inner.span.is_flow:
        if not around.span.is_flow or not inner.span.full_text.endswith("}"):
            return None
        _, end = inner.span.range
        begin = Span(place.file, *place.start, inner.span.line, inner.span.column + 1)
        return Fix(title, (Edit(begin, ""), Edit(place.file.between(end - 1, end), "")))
    if first.line != place.line + 1:
        return None
    whole = Span(place.file, first.line, first.column, place.end_line, place.end_column)
    edits = shift_lines(whole, place.column - first.column)
    return Fix(title, (Edit(Span(place.file, place.line, 1, first.line, 1), ""), *edits))


def line_above(key: str, entry: YamlEntry, around: YamlEntry) -> Fix | None:
    """Return the fix that writes the line of a section above an entry that is in another section."""
    place, section = _place([entry]), around.key.span
    # The line of the section around may be lost as well; it then has the place of its first entry.
    if place is None or not section.begins_line or not place.begins_line or place.column <= section.column:
        return None
    start = Span(place.file, place.line, 1, place.line, 1)
    return Fix(f"write '{key}:' above", (Edit(start, f"{' ' * (section.column - 1)}{key}:{place.file.newline}"),))


def _place(entries: Sequence[YamlEntry]) -> Span | None:
    """Return the place of entries; None if they are not written there one after the other."""
    file, at = entries[0].key.span.file, entries[0].key.span.start
    for entry in entries:
        key, value = entry.key.span, entry.value.span
        if file.is_xml or key.file is not file or value.file is not file or key.start < at or value.start < key.end:
            return None
        at = max(key.end, value.end)
    # A block ends at the begin of the line below it.
    if at.column == 1:
        at = at._replace(line=at.line - 1, column=len(file.line(at.line - 1)) + 1)
    return Span(file, *entries[0].key.span.start, *at)
