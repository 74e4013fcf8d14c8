"""Keys with dots in the parameters of controllers: in ROS 2, `a.b: 1` and `a: {b: 1}` are the same parameter."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.syntax import DUPLICATE_KEY
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar, is_null


def with_nested_keys(fields: Fields, section: str) -> Fields:
    """Return an object with maps for the keys with dots in a section; report parameters that it has twice."""
    node = fields.node.get(section)
    if not isinstance(node, YamlMap) or not _has_dots(node):
        return fields
    nested = fields.node.with_value(section, YamlMap(_nested(node, (), fields), node.span))
    return Fields(nested, fields.owner, fields.sink, fields.trail, fields.key, fields.path, fields.outer)


def _has_dots(node: YamlMap) -> bool:
    return any("." in entry.name or (isinstance(entry.value, YamlMap) and _has_dots(entry.value)) for entry in node)


def _nested(entries: Iterable[YamlEntry], path: tuple[str, ...], fields: Fields) -> dict[str, YamlEntry]:
    entries = tuple(entries)
    values = {one.name for one in entries if not isinstance(one.value, YamlMap) and not is_null(one.value)}
    by_name: dict[str, list[YamlEntry]] = {}
    for entry in entries:
        unfolded = _unfolded(entry, values)
        by_name.setdefault(unfolded.name, []).append(unfolded)
    return {name: _merged(alike, (*path, name), fields) for name, alike in by_name.items()}


def _unfolded(entry: YamlEntry, values: Collection[str]) -> YamlEntry:
    """Return the entry `a: {b: 1}` for `a.b: 1`, unless `a` is among the names that have values themselves."""
    outer, _, inner = entry.name.partition(".")
    if not outer or not inner or outer in values:
        return entry
    below = YamlEntry(_part_of(entry.key, inner, len(outer) + 1), entry.value, entry.replaced)
    return YamlEntry(_part_of(entry.key, outer, 0), YamlMap({inner: below}, entry.key.span))


def _part_of(key: YamlScalar, text: str, begin: int) -> YamlScalar:
    """Return the part of a key from an index on, at its own place if the key is written as it is."""
    span = key.span
    if type(span) is Span and span.text == key.text:
        column = span.column + begin
        span = span._replace(column=column, end_column=column + len(text))
    return YamlScalar(text, text, span)


def _merged(entries: list[YamlEntry], path: tuple[str, ...], fields: Fields) -> YamlEntry:
    """Return one entry for those of the same name: their maps in one, or the first with a value."""
    first, *others = [one for one in entries if not is_null(one.value)] or entries[:1]
    maps = [one.value for one in (first, *others) if isinstance(one.value, YamlMap)]
    if len(maps) == len(others) + 1:
        inner = _nested((one for each in maps for one in each), path, fields)
        return first._replace(value=YamlMap(inner, first.value.span))
    for one in others:
        notes, place = [Note("first written here", first.key.span)], SourceRef(one.key, None, fields.trail)
        more = "; a dot is the same as a map in a map"
        fields.sink.report(DUPLICATE_KEY.at(place, key=".".join(path), more=more, notes=notes))
    return first
