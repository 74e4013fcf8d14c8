"""Unknown keys and misplaced sections: what to write instead, or where they belong."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import chain, islice

from linkforge_compile.diagnostics import MAX_KEPT, Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.schema import SECTION_LINE_INDENTED, SECTION_LINE_LOST
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.hints import (
    ESSENTIAL_KEYS,
    MAY_BE_EMPTY,
    OF_ANY_VALUE,
    known_key_hint,
    number_of_list_hint,
    other_key_hint,
)
from linkforge_compile.schema.json_schema import Json, Schema, branches, has_names, mapping
from linkforge_compile.schema.number_texts import number_hint
from linkforge_compile.schema.registry import accepts
from linkforge_compile.schema.shapes import (
    COMMON_KEYS,
    Shape,
    nested,
    shapes,
    shortened,
    shown,
    split_path,
)
from linkforge_compile.schema.srdf_habits import srdf_hint
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, is_null

_MOST_LISTED = 10
"""The most keys of an object that a hint lists."""

_NOT_HOMES = {"defaults", "override"}
"""Fields whose keys change other parts, so that a misplaced key is not suggested there."""


def group_unknown_keys(node: YamlMap, schema: Schema) -> Iterator[tuple[Sequence[YamlEntry], str, Sequence[str]]]:
    """Yield the keys of a map that its schema does not know, in groups with the same mistake.

    Each has the hint and the candidates of a did-you-mean.
    """
    known, patterns = mapping(schema.get("properties", {})), mapping(schema.get("patternProperties", {}))
    unknown = (
        (before, entry)
        for before, entry in zip(chain((None,), node), node, strict=False)
        if entry.name not in known
        and not isinstance(entry.value, YamlFault)
        and not any(re.search(pattern, entry.name) for pattern in patterns)
    )
    groups: dict[str, list[YamlEntry]] = {}
    for before, entry in islice(unknown, MAX_KEPT + 1):  # a hostile map has a hundred thousand
        if before and (hint := _decimal_comma_hint(before.value, entry)):
            yield [entry], hint, ()
        else:
            groups.setdefault(_group(entry, node, schema), []).append(entry)
    for group, entries in groups.items():
        if group in known:
            yield entries, _home_hint(group, entries, node), ()
            continue
        hint, near = _hint(entries[0], node, schema)
        more = len(entries) - 1
        if more and not number_of_list_hint(str(schema["title"]), entries[0].name):
            hint = f"{hint} ({more} more like it here)"
        yield entries, hint, near


def find_like_space(entry: YamlEntry) -> Span | None:
    """Return the span of a character that looks like a space and indents the key; None for other keys."""
    found = LIKE_SPACES.match(entry.key.span.text or "")
    return entry.key.span.within(found.start(1), 1) if found else None


def _group(entry: YamlEntry, node: YamlMap, schema: Schema) -> str:
    """Return what an unknown key shares with others of the same mistake: the key it belongs under, or its hint."""
    owner, name = str(schema["title"]), entry.name
    known = mapping(schema.get("properties", {}))
    if numbers := number_of_list_hint(owner, name):
        return numbers
    homes = [] if known_key_hint(owner, name) or _is_other_number(name, known) else _homes(name, known)
    if len(homes) == 1:
        return homes[0]
    if find_like_space(entry):
        return " "
    if _table_hint(entry, schema):
        return f"{name}:"
    hint, near = _hint(entry, node, schema)
    # If no key of the map is known, the whole map is misplaced.
    is_misplaced = hint and not near and node.entries.keys().isdisjoint(known)
    return hint.replace(name, "…") if is_misplaced and name else f"{name}:"


def _home_hint(home: str, entries: Sequence[YamlEntry], node: YamlMap) -> str:
    """Return how to write keys that belong under another key."""
    written = ", ".join(f"{entry.name}: {shown(entry.value)}" for entry in entries)
    if home == "mesh" and isinstance(file := node.get(home), YamlScalar):
        return f"write 'mesh: {{file: {shown(file)}, {written}}}'"
    if node.get(home) is None:
        return f"write '{home}: {{{written}}}'"
    others = alternatives([f"'{entry.name}'" for entry in entries[1:]], "and") if len(entries) > 1 else ""
    return f"it belongs under '{home}'" + (f", as {others}" if others else "")


def _hint(entry: YamlEntry, node: YamlMap, schema: Schema) -> tuple[str, Sequence[str]]:
    """Return the hint for an unknown key and the candidates of a did-you-mean; mostly one of them is empty."""
    owner, name = str(schema["title"]), entry.name
    known = mapping(schema.get("properties", {}))
    if hint := _table_hint(entry, schema) or _place_hint(entry, known):
        return hint, ()
    if nearest(name, known):
        return "", [*known]
    if hint := other_key_hint(owner, name):
        return hint, ()
    if owner == "a parameter" and node.entries.keys().isdisjoint(known):
        return "write a map that is its value under 'default'", ()
    if owner == "an override" and _is_empty(entry.value):
        return f"write it in its section, such as 'links: {{{name}: …}}'", ()
    own = [key for key in known if key not in COMMON_KEYS]
    if not 0 < len(own) <= _MOST_LISTED:
        return "", ()
    return f"its keys are {alternatives(own, 'and')}" if len(own) > 1 else f"its key is {own[0]}", ()


def _table_hint(entry: YamlEntry, schema: Schema) -> str:
    """Return the hint of the table, or for a path in one key: `limits/effort`."""
    owner, name = str(schema["title"]), entry.name
    if hint := number_of_list_hint(owner, name) or known_key_hint(owner, name) or srdf_hint(owner, entry):
        return hint
    first, *steps = split_path(name)
    is_path = first in mapping(schema.get("properties", {})) and steps and all(steps)
    return f"write '{nested([first, *steps], '…')}'" if is_path else ""


def _place_hint(entry: YamlEntry, known: Mapping[str, Json]) -> str:
    """Return where a key belongs or what to write for it, by the keys of its value; "" where that is not clear."""
    if _is_other_number(entry.name, known):
        return ""
    if homes := _homes(entry.name, known):
        return "it belongs under " + alternatives([f"'{home}'" for home in homes])
    parts = {name: part for name, part in known.items() if name not in _NOT_HOMES}
    if sections := [name for name, part in parts.items() if _may_be_entry(entry.value, part)]:
        return "write " + alternatives([f"'{name}: {{{entry.name}: …}}'" for name in sections])
    inner = entry.value.entries if isinstance(entry.value, YamlMap) else {}
    if inner and all(name in known and name not in COMMON_KEYS for name in inner):
        return "write its entries without this map around them"
    entries = [one.value for one in inner.values() if not _is_empty(one.value)]
    sections = [name for name, part in parts.items() if entries and all(_may_be_entry(one, part) for one in entries)]
    # A mount has the keys of a joint, but is never written under another key.
    candidates = [f"'{name}'" for name in sections if name != "mount"]
    return f"write {alternatives(candidates)}" if candidates else ""


def _homes(name: str, known: Mapping[str, Json]) -> list[str]:
    """Return the fields of an object that have a key of this name."""
    if name in COMMON_KEYS or name == "name":
        return []
    parts = ((home, branches(mapping(part))) for home, part in known.items() if home not in _NOT_HOMES)
    return [home for home, kinds in parts if any(name in mapping(kind.get("properties", {})) for kind in kinds)]


def _is_other_number(name: str, known: Mapping[str, Json]) -> bool:
    """Whether a key is known in its plural or singular."""
    return f"{name}s" in known or name.removesuffix("s") in known


def _decimal_comma_hint(before: YamlNode, entry: YamlEntry) -> str:
    """Return how to write `1,5 mm`, which in braces is the value 1 of the entry before and a key `5 mm`."""
    if not (isinstance(before, YamlScalar) and isinstance(before.value, int) and is_null(entry.value)):
        return ""
    hint = number_hint(f"{before.text},{entry.name}", unit=None)
    return f"write {hint}" if hint else ""


def _is_empty(node: YamlNode) -> bool:
    return is_null(node) or (isinstance(node, YamlMap) and not node.entries)


def _may_be_entry(node: YamlNode, section: Json) -> bool:
    """Whether a section keyed by names has entries with all the keys of a map."""
    keys = {entry.name for entry in node} if isinstance(node, YamlMap) else set()
    entries = [mapping(part["additionalProperties"]) for part in branches(mapping(section)) if has_names(part)]
    known = {key for part in entries for branch in branches(part) for key in mapping(branch.get("properties", {}))}
    return bool(keys) and keys <= known


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
