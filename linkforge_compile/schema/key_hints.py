"""Hints for unknown keys: what to write instead, or where the key belongs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from typing import NamedTuple

from linkforge_compile.diagnostics import MAX_KEPT
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.hints import known_key_hint, number_of_list_hint, other_key_hint
from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.number_hints import number_hint
from linkforge_compile.schema.repetition import has_names
from linkforge_compile.schema.words import COMMON_KEYS, alternatives, nested, shown, split_path
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, is_null

_MOST_LISTED = 10
"""The most keys of an object that a hint lists."""

_NOT_HOMES = {"defaults", "override"}
"""Fields whose keys change other parts, so that a misplaced key is not suggested there."""


class UnknownKeys(NamedTuple):
    """Unknown keys with the same mistake, and its hint; `near` are the candidates of a did-you-mean."""

    entries: Sequence[YamlEntry]
    hint: str
    near: Sequence[str] = ()


def group_unknown_keys(node: YamlMap, schema: Schema) -> Iterator[UnknownKeys]:
    """Yield the keys of a map that its schema does not know, in groups with the same mistake."""
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
            yield UnknownKeys([entry], hint)
        else:
            groups.setdefault(_group(entry, node, schema), []).append(entry)
    for group, entries in groups.items():
        if group in known:
            yield UnknownKeys(entries, _home_hint(group, entries, node))
            continue
        hint, near = _hint(entries[0], node, schema)
        more = len(entries) - 1
        if more and not number_of_list_hint(str(schema["title"]), entries[0].name):
            hint = f"{hint} ({more} more like it here)"
        yield UnknownKeys(entries, hint, near)


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
    if hint := number_of_list_hint(owner, name) or known_key_hint(owner, name):
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
    return [home for home, part in known.items() if home not in _NOT_HOMES and name in _keys_of(part)]


def _is_other_number(name: str, known: Mapping[str, Json]) -> bool:
    """Whether a key is known in its plural or singular."""
    return f"{name}s" in known or name.removesuffix("s") in known


def _decimal_comma_hint(before: YamlNode, entry: YamlEntry) -> str:
    """Return how to write `1,5 mm`, which in braces is the value 1 of the entry before and a key `5 mm`."""
    if not (isinstance(before, YamlScalar) and isinstance(before.value, int) and is_null(entry.value)):
        return ""
    hint = number_hint(f"{before.text},{entry.name}", unit=None)
    return f"write {hint}" if hint else ""


def _keys_of(schema: Json) -> set[str]:
    keys = {key for branch in branches(mapping(schema)) for key in mapping(branch.get("properties", {}))}
    return keys - COMMON_KEYS - {"name"}


def _is_empty(node: YamlNode) -> bool:
    return is_null(node) or (isinstance(node, YamlMap) and not node.entries)


def _may_be_entry(node: YamlNode, section: Json) -> bool:
    """Whether a section keyed by names has entries with all the keys of a map."""
    keys = {entry.name for entry in node} if isinstance(node, YamlMap) else set()
    entries = [mapping(part["additionalProperties"]) for part in branches(mapping(section)) if has_names(part)]
    known = {key for part in entries for branch in branches(part) for key in mapping(branch.get("properties", {}))}
    return bool(keys) and keys <= known
