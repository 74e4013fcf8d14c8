"""Sections whose line is missing or indented: where they begin, and what then belongs to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.schema import SECTION_LINE_INDENTED, SECTION_LINE_LOST
from linkforge_compile.schema.hints import ESSENTIAL_KEYS, MAY_BE_EMPTY, OF_ANY_VALUE
from linkforge_compile.schema.json_schema import branches, mapping
from linkforge_compile.schema.nesting import line_above
from linkforge_compile.schema.registry import accepts
from linkforge_compile.schema.shapes import COMMON_KEYS, Shape, shapes, shortened
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlScalar, is_null


def restore_sections(tree: YamlMap, sink: Diagnostics) -> YamlMap:
    """Report sections whose line is missing or indented; return the file with them restored.

    Later stages then report no errors that follow from it.
    """
    tree = _restore_in(tree, shapes(), sink)
    semantic = tree.entries.get("semantic")
    if semantic is None or not isinstance(semantic.value, YamlMap):
        return tree
    part = _restore_in(semantic.value, shapes().under("semantic"), sink)
    entries = {**tree.entries, "semantic": YamlEntry(semantic.key, part)}
    return tree if part is semantic.value else YamlMap(entries, tree.span)


def _restore_in(node: YamlMap, shape: Shape, sink: Diagnostics) -> YamlMap:
    """Return an object with the sections that are inside others of its sections."""
    parts = {name: shape.under(name) for name in shape.keys if name not in COMMON_KEYS}
    sections = {
        name: part for name, part in parts.items() if part.is_object or "object" in str(part.schema.get("type"))
    }
    # `x-` sections are the author's own, and may look like anything.
    entries, todo = {**node.entries}, [entry for entry in node if not entry.name.startswith("x-")]
    while todo:
        around = todo.pop(0)
        absent = {name: section for name, section in sections.items() if name not in entries}
        if misplaced := _find_misplaced(around, shape.under(around.name), absent):
            fault, before, section = misplaced
            sink.report(fault)
            entries |= {around.name: YamlEntry(around.key, before), section.name: section}
            todo[:0] = [entries[around.name], section]
    return YamlMap(entries, node.span) if len(entries) > len(node) else node


def _find_misplaced(
    around: YamlEntry, shape: Shape, absent: Mapping[str, Shape]
) -> tuple[Diagnostic, YamlMap, YamlEntry] | None:
    """Return the fault of a section that begins inside another one, what remains of that, and the section."""
    inner = [*around.value] if isinstance(around.value, YamlMap) else []
    # From the end, so that each of several lines gets its own entries.
    for at, line in reversed([*enumerate(inner[:-1])]):
        below, section = inner[at + 1 :], absent.get(line.name)
        if section is not None and _is_indented(line, below, around.name, shape, section):
            fault = SECTION_LINE_INDENTED.at(line.key.span, name=line.name, around=around.name)
            return fault, _map(inner[:at], around), YamlEntry(line.key, _map(below, around))
    # The entries of a mount look like joints.
    others = {name: section for name, section in absent.items() if name != "mount"}
    begins = {name: at for name, section in others.items() if (at := _begin(inner, shape, name, section))}
    if not begins:
        return None

    def fit(name: str) -> tuple[int, int, int]:
        known = _keys_of_entries(absent[name])
        return begins[name], -sum(len(_keys(entry) & known) for entry in inner[begins[name] :]), len(known)

    name = min(begins, key=fit)
    at, first = begins[name], inner[begins[name]].key
    fault = SECTION_LINE_LOST.at(first.span, name=shortened(first.text), section=name, around=around.name)
    fault = fault.with_fix(line_above(name, inner[at], around))
    key = YamlScalar(name, name, first.span)
    return fault, _map(inner[:at], around), YamlEntry(key, _map(inner[at:], around))


def _map(entries: Sequence[YamlEntry], around: YamlEntry) -> YamlMap:
    """Return some entries of a section as a map."""
    first, last = (entries[0].key.span, entries[-1].value.span) if entries else (around.key.span, around.key.span)
    span = Span(first.file, first.line, first.column, last.end_line, last.end_column)
    return YamlMap({entry.name: entry for entry in entries}, span)


def _is_indented(line: YamlEntry, below: Sequence[YamlEntry], name: str, around: Shape, section: Shape) -> bool:
    """Whether an entry without a value is the indented line of the section whose entries follow it."""
    if not is_null(line.value) or line.name in around.keys or not all(_may_be_of(section, entry) for entry in below):
        return False
    if name in OF_ANY_VALUE:
        known, keyed = _keys_of_entries(section), [entry for entry in below if isinstance(entry.value, YamlMap)]
        if not any(section.is_object or (_may_contain(section, entry) and _keys(entry) & known) for entry in keyed):
            return False
    return around.things not in MAY_BE_EMPTY or not all(_may_contain(around, entry) for entry in below)


def _may_be_of(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry, by its kind and keys, may belong to a section."""
    if section.is_object:
        return _is_part_of(section, entry)
    if is_null(entry.value):
        return True
    keys, known = _keys(entry), _keys_of_entries(section)
    return bool(keys & known) if keys and known else _is_valid_in(section, entry)


def _is_part_of(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry may belong to an object: the object has its key and accepts at least a part of its value."""
    if entry.name not in section.keys:
        return False
    part, parts = section.under(entry.name), entry.value if isinstance(entry.value, YamlMap) else ()
    return _is_valid_in(section, entry) or any(_is_valid_in(part, each) for each in parts)


def _begin(inner: Sequence[YamlEntry], around: Shape, name: str, section: Shape) -> int:
    """Return the index from which all entries belong to another section; 0 if there is none."""
    at = len(inner)
    while at and _belongs(inner[at - 1], around, name, section):
        at -= 1
    while at < len(inner) and _may_contain(around, inner[at]):
        at += 1
    # The condition of an object is its first entry.
    if section.is_object and 0 < at < len(inner) and inner[at - 1].name == "when":
        at -= 1
    tail = inner[at:]
    is_whole = any(not is_null(entry.value) and not _lacks_essential_key(entry, section) for entry in tail)
    # A joint with few fields may be a link as well.
    is_clear = section.things in ESSENTIAL_KEYS or not all(_is_valid_in(around, entry) for entry in tail)
    return at if is_whole and is_clear else 0


def _belongs(entry: YamlEntry, around: Shape, name: str, section: Shape) -> bool:
    """Whether an entry of one section clearly belongs to another."""
    if section.is_object:
        return entry.name not in around.keys and _is_part_of(section, entry)
    if is_null(entry.value):
        return section.has_names
    if not isinstance(entry.value, YamlMap):
        return name == "variables" and around.is_free and not isinstance(entry.value, YamlFault)
    keys, own = _keys(entry), _keys_of_entries(around)
    # All keys are those of its own section, which a type makes sure: one of its values is wrong.
    if "type" in keys and keys <= own:
        return False
    known = keys & _keys_of_entries(section)
    is_misspelt = len(keys - known) <= 1 < len(known) and not keys & own
    return bool(known) and (known == keys or is_misspelt)


def _may_contain(section: Shape, entry: YamlEntry) -> bool:
    """Whether an entry may be one of a section: it is valid there and has the essential key."""
    if is_null(entry.value):
        return section.things in MAY_BE_EMPTY
    return _is_valid_in(section, entry) and not _lacks_essential_key(entry, section)


def _is_valid_in(section: Shape, entry: YamlEntry) -> bool:
    return accepts(section.schema, YamlMap({entry.name: entry}, entry.key.span))


def _lacks_essential_key(entry: YamlEntry, section: Shape) -> bool:
    """Whether an entry has no key that all entries of the section have."""
    essential = ESSENTIAL_KEYS.get(section.things)
    return essential is not None and isinstance(entry.value, YamlMap) and essential not in entry.value.entries


def _keys(entry: YamlEntry) -> Set[str]:
    return entry.value.entries.keys() - COMMON_KEYS if isinstance(entry.value, YamlMap) else frozenset()


def _keys_of_entries(section: Shape) -> Set[str]:
    """Return the keys that the entries of a section may have; none where they are the author's own."""
    entry = section.schema.get("additionalProperties")
    kinds = branches(entry) if isinstance(entry, dict) else []
    return {key for kind in kinds for key in mapping(kind.get("properties", {}))} - COMMON_KEYS
