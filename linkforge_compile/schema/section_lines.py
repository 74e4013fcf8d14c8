"""A line that begins a section and is lost or indented: what stands below it is put where it belongs, and told once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.schema import SECTION_LINE_INDENTED, SECTION_LINE_LOST
from linkforge_compile.schema.gate import accepts
from linkforge_compile.schema.json_types import branches, mapping
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.schema.words import COMMON_KEYS, shortened
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlScalar, is_null


def with_sections_restored(tree: YamlMap, sink: Diagnostics) -> YamlMap:
    """Return a file with the sections whose line is lost or indented, each of which is reported.

    All later stages see the file as it was meant, so that nothing in it is told or missed besides.
    """
    tree = _restored(tree, shapes(), sink)
    semantic = tree.entries.get("semantic")
    if semantic is None or not isinstance(semantic.value, YamlMap):
        return tree
    part = _restored(semantic.value, shapes().under("semantic"), sink)
    if part is semantic.value:
        return tree
    return YamlMap({**tree.entries, "semantic": YamlEntry(semantic.key, part)}, tree.span)


def _restored(node: YamlMap, shape: Shape, sink: Diagnostics) -> YamlMap:
    """Return an object with the sections that it holds inside others of its sections."""
    # What is under `x-` is the author's own, and may look like anything.
    entries, todo = {**node.entries}, [entry for entry in node if not entry.name.startswith("x-")]
    while todo:
        around = todo.pop(0)
        absent = {name: section for name, section in _sections(shape).items() if name not in entries}
        lost = _lost_in(around, shape.under(around.name), absent)
        if lost:
            sink.report(lost.diagnostic)
            entries |= {around.name: YamlEntry(around.key, lost.before), lost.section.name: lost.section}
            todo[:0] = [entries[around.name], lost.section]
    return YamlMap(entries, node.span) if len(entries) > len(node) else node


def _sections(shape: Shape) -> Mapping[str, Shape]:
    """Return the parts of an object that are maps, by their keys."""
    parts = {name: shape.under(name) for name in shape.keys if name not in COMMON_KEYS}
    return {name: part for name, part in parts.items() if part.is_object or "object" in str(part.schema.get("type"))}


class _Lost(NamedTuple):
    """A section found inside another one, of which `before` is what stays."""

    diagnostic: Diagnostic
    before: YamlMap
    section: YamlEntry


def _lost_in(around: YamlEntry, shape: Shape, absent: Mapping[str, Shape]) -> _Lost | None:
    """Return the section that begins inside of another one, None where there is none."""
    said = [*around.value] if isinstance(around.value, YamlMap) else []
    # From the end, so that of several lines each has its own entries below it.
    for at, line in reversed([*enumerate(said[:-1])]):
        below, section = said[at + 1 :], absent.get(line.name)
        if section is not None and _is_indented(line, below, around.name, shape, section):
            fault = SECTION_LINE_INDENTED.at(line.key.span, name=line.name, around=around.name)
            return _Lost(fault, _map(said[:at], around), YamlEntry(line.key, _map(below, around)))
    # A mount is a joint as any other.
    others = {name: section for name, section in absent.items() if name != "mount"}
    begins = {name: at for name, section in others.items() if (at := _begin(said, shape, name, section))}
    if not begins:
        return None

    def fit(name: str) -> tuple[int, int, int]:
        known = _keys_of_entries(absent[name])
        return begins[name], -sum(len(_keys(entry) & known) for entry in said[begins[name] :]), len(known)

    name = min(begins, key=fit)
    at, first = begins[name], said[begins[name]].key
    fault = SECTION_LINE_LOST.at(first.span, name=shortened(first.text), section=name, around=around.name)
    key = YamlScalar(name, name, first.span)
    return _Lost(fault, _map(said[:at], around), YamlEntry(key, _map(said[at:], around)))


def _map(entries: Sequence[YamlEntry], around: YamlEntry) -> YamlMap:
    """Return a part of a section as a map of its own."""
    first, last = (entries[0].key.span, entries[-1].value.span) if entries else (around.key.span, around.key.span)
    span = Span(first.file, first.line, first.column, last.end_line, last.end_column)
    return YamlMap({entry.name: entry for entry in entries}, span)


def _is_indented(line: YamlEntry, below: Sequence[YamlEntry], name: str, around: Shape, section: Shape) -> bool:
    """Whether an entry without a value is the line of the section that stands below it, all in `around` of a name."""
    if not is_null(line.value) or line.name in around.keys or not all(_may_be_of(section, entry) for entry in below):
        return False
    if name in _OF_ANY_VALUE and not any(_is_plainly_of(section, entry) for entry in below):
        return False
    return around.things not in _MAY_BE_EMPTY or not all(_takes(around, entry) for entry in below)


def _is_plainly_of(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry is one of a section and, as its keys tell, of no other."""
    if section.is_object:
        return isinstance(entry.value, YamlMap)
    return _takes(section, entry) and bool(_keys(entry) & _keys_of_entries(section))


def _may_be_of(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry may stand in a section, as far as its kind and its keys tell."""
    if section.is_object:
        return _is_part_of(section, entry)
    if is_null(entry.value):
        return True
    keys, known = _keys(entry), _keys_of_entries(section)
    return bool(keys & known) if keys and known else _is_shaped_as(section, entry)


def _is_part_of(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry may stand in an object: it has one of its keys, and at least a part of its value fits."""
    if entry.name not in section.keys:
        return False
    part, parts = section.under(entry.name), entry.value if isinstance(entry.value, YamlMap) else ()
    return _is_shaped_as(section, entry) or any(_is_shaped_as(part, each) for each in parts)


def _begin(said: Sequence[YamlEntry], around: Shape, name: str, section: Shape) -> int:
    """Return where the entries begin, up to the end, that belong to another section; 0 where none do."""
    at = len(said)
    while at and _belongs(said[at - 1], around, name, section):
        at -= 1
    while at < len(said) and _takes(around, said[at]):
        at += 1
    # The condition of an object stands first in it.
    if section.is_object and 0 < at < len(said) and said[at - 1].name == "when":
        at -= 1
    tail = said[at:]
    is_whole = any(not is_null(entry.value) and not _lacks_its_essence(entry, section) for entry in tail)
    # A joint that says little may be a link as well.
    is_plain = section.things in _ESSENTIAL or not all(_is_shaped_as(around, entry) for entry in tail)
    return at if is_whole and is_plain else 0


def _belongs(entry: YamlEntry, around: Shape, name: str, section: Shape) -> bool:
    """Whether an entry of one section is plainly one of another."""
    if section.is_object:
        return entry.name not in around.keys and _is_part_of(section, entry)
    if is_null(entry.value):
        return section.has_names
    if not isinstance(entry.value, YamlMap):
        return name == "variables" and around.is_free and not isinstance(entry.value, YamlFault)
    keys = _keys(entry)
    known = keys & _keys_of_entries(section)
    is_misspelt = len(keys - known) <= 1 < len(known) and not keys & _keys_of_entries(around)
    return bool(known) and (known == keys or is_misspelt)


def _takes(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry may be one of a section: it is shaped as they are, and says what they must say."""
    if is_null(entry.value):
        return section.things in _MAY_BE_EMPTY
    return _is_shaped_as(section, entry) and not _lacks_its_essence(entry, section)


def _is_shaped_as(section: Shape, entry: YamlEntry) -> bool:
    return accepts(section.schema, YamlMap({entry.name: entry}, entry.key.span))


def _lacks_its_essence(entry: YamlEntry, section: Shape) -> bool:
    """Whether an entry does not say what all of its kind must."""
    essential = _ESSENTIAL.get(section.things)
    return essential is not None and isinstance(entry.value, YamlMap) and essential not in entry.value.entries


def _keys(entry: YamlEntry) -> Set[str]:
    return entry.value.entries.keys() - COMMON_KEYS if isinstance(entry.value, YamlMap) else frozenset()


def _keys_of_entries(section: Shape) -> Set[str]:
    """Return the keys that the entries of a section have; none where they are the author's."""
    entry = section.schema.get("additionalProperties")
    kinds = branches(entry) if isinstance(entry, dict) else []
    return {key for kind in kinds for key in mapping(kind.get("properties", {}))} - COMMON_KEYS


_MAY_BE_EMPTY = {"links"}
"""What has entries that say nothing: a link may, and have any name."""

_OF_ANY_VALUE = {"metadata", "variables"}
"""Sections whose entries may be anything, without a value as well."""

_ESSENTIAL = {
    "joints": "child",
    "frames": "parent",
    "modules": "use",
    "sensors": "link",
    "transmissions": "joints",
    "ros2_control blocks": "hardware_plugin",
    "virtual joints": "child_link",
    "end effectors": "parent_link",
}
"""What no entry can do without, by what a section has."""
