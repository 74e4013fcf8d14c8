"""Unknown keys: what to write instead, or where they belong."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from typing import NamedTuple

from linkforge_compile.diagnostics import MAX_KEPT
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.diagnostics.fix import Edit, Fix, Replacement
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.hints import (
    known_key_hint,
    number_of_list_hint,
    other_key_hint,
    other_key_home,
)
from linkforge_compile.schema.json_schema import Json, Schema, branches, has_names, mapping
from linkforge_compile.schema.key_fixes import fix_of_key
from linkforge_compile.schema.nesting import as_path, under_key, without_map
from linkforge_compile.schema.number_texts import number_hint, numbers_with_comma
from linkforge_compile.schema.shapes import COMMON_KEYS, nested, shown, split_path
from linkforge_compile.schema.srdf_habits import srdf_hint
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, is_null

_MOST_LISTED = 10
"""The most keys of an object that a hint lists."""

_NOT_HOMES = {"defaults", "override"}
"""Fields whose keys change other parts, so that a misplaced key is not suggested there."""


class KeyHint(NamedTuple):
    """What to write instead of an unknown key: in words, by the candidates of a did-you-mean, and as edits."""

    words: str = ""
    near: Sequence[str] = ()
    fixes: tuple[Fix | None, ...] = ()
    around: str = ""
    """The key under which it belongs, with all others of the same mistake."""


def group_unknown_keys(node: YamlMap, schema: Schema) -> Iterator[tuple[Sequence[YamlEntry], KeyHint]]:
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
        if before and (comma := _decimal_comma_hint(before.value, entry)):
            yield [entry], KeyHint(comma, fixes=_decimal_comma_fixes(before.value, entry))
        else:
            groups.setdefault(_group(entry, node, schema), []).append(entry)
    for group, entries in groups.items():
        if group in known:
            fix = under_key(group, entries, node) if node.get(group) is None else None
            yield entries, KeyHint(_home_hint(group, entries, node), fixes=(fix,))
            continue
        hint, more, owner = _hint(entries[0], node, schema), len(entries) - 1, str(schema["title"])
        if fix := fix_of_key(owner, entries, node, known):
            hint = hint._replace(fixes=(fix,))
        elif more and hint.around:
            hint = hint._replace(fixes=(under_key(hint.around, entries, node),))
        if more and not number_of_list_hint(owner, entries[0].name):
            hint = hint._replace(words=f"{hint.words} ({more} more like it here)")
        yield entries, hint


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
    homes = [] if known_key_hint(owner, name) or _is_other_number(name, known) else _homes(entry, known)
    if len(homes) == 1:
        return homes[0]
    if find_like_space(entry):
        return " "
    if _table_hint(entry, schema):
        return f"{name}:"
    hint = _hint(entry, node, schema)
    # If no key of the map is known, the whole map is misplaced.
    is_misplaced = hint.words and not hint.near and node.entries.keys().isdisjoint(known)
    return hint.words.replace(name, "…") if is_misplaced and name else f"{name}:"


def _home_hint(home: str, entries: Sequence[YamlEntry], node: YamlMap) -> str:
    """Return how to write keys that belong under another key."""
    written = ", ".join(f"{entry.name}: {shown(entry.value)}" for entry in entries)
    if home == "mesh" and isinstance(file := node.get(home), YamlScalar):
        return f"write 'mesh: {{file: {shown(file)}, {written}}}'"
    if node.get(home) is None:
        return f"write '{home}: {{{written}}}'"
    others = alternatives([f"'{entry.name}'" for entry in entries[1:]], "and") if len(entries) > 1 else ""
    return f"it belongs under '{home}'" + (f", as {others}" if others else "")


def _hint(entry: YamlEntry, node: YamlMap, schema: Schema) -> KeyHint:
    """Return the hint for an unknown key; its words or its candidates are mostly empty."""
    owner, name = str(schema["title"]), entry.name
    known = mapping(schema.get("properties", {}))
    if words := _table_hint(entry, schema):
        return KeyHint(words, fixes=(as_path(steps, entry),) if (steps := _steps(name, known)) else ())
    if (placed := _place_hint(entry, node, known)).words:
        return placed
    if nearest(name, known):
        return KeyHint("", [*known])
    if words := other_key_hint(owner, name):
        around = other_key_home(owner)
        return KeyHint(words, fixes=(under_key(around, [entry], node),) if around else (), around=around)
    if owner == "a parameter" and node.entries.keys().isdisjoint(known):
        fix = under_key("default", [entry], node)
        return KeyHint("write a map that is its value under 'default'", fixes=(fix,), around="default")
    if owner == "an override" and _is_empty(entry.value):
        return KeyHint(f"write it in its section, such as 'links: {{{name}: …}}'")
    own = [key for key in known if key not in COMMON_KEYS]
    if not 0 < len(own) <= _MOST_LISTED:
        return KeyHint()
    return KeyHint(f"its keys are {alternatives(own, 'and')}" if len(own) > 1 else f"its key is {own[0]}")


def _table_hint(entry: YamlEntry, schema: Schema) -> str:
    """Return the hint of the table, or for a path in one key: `limits/effort`."""
    owner, name = str(schema["title"]), entry.name
    if hint := number_of_list_hint(owner, name) or known_key_hint(owner, name) or srdf_hint(owner, entry):
        return hint
    steps = _steps(name, mapping(schema.get("properties", {})))
    return f"write '{nested(steps, '…')}'" if steps else ""


def _steps(name: str, known: Mapping[str, Json]) -> Sequence[str]:
    """Return the keys of a path that is written as one; none for any other key."""
    first, *steps = split_path(name)
    return [first, *steps] if first in known and steps and all(steps) else ()


def _place_hint(entry: YamlEntry, node: YamlMap, known: Mapping[str, Json]) -> KeyHint:
    """Return where a key belongs or what to write for it, by the keys of its value; an empty one if that is unclear."""
    if _is_other_number(entry.name, known):
        return KeyHint()
    if homes := _homes(entry, known):
        return KeyHint("it belongs under " + alternatives([f"'{home}'" for home in homes]))
    parts = {name: part for name, part in known.items() if name not in _NOT_HOMES}
    sections = [name for name, part in parts.items() if _may_be_entry(entry.value, part)]
    # The file that uses a mount sets its parent.
    if sections := [name for name in sections if name != "mount" or entry.value.child("parent") is None]:
        words = "write " + alternatives([f"'{name}: {{{entry.name}: …}}'" for name in sections])
        return KeyHint(words, fixes=tuple(under_key(name, [entry], node) for name in sections))
    inner = entry.value.entries if isinstance(entry.value, YamlMap) else {}
    if inner and all(name in known and name not in COMMON_KEYS for name in inner):
        fix = without_map(entry, node) if node.entries.keys().isdisjoint(inner) else None
        return KeyHint("write its entries without this map around them", fixes=(fix,))
    entries = [one.value for one in inner.values() if not _is_empty(one.value)]
    sections = [name for name, part in parts.items() if entries and all(_may_be_entry(one, part) for one in entries)]
    # A mount has the keys of a joint, but is never written under another key.
    candidates = [name for name in sections if name != "mount"]
    renamed = (Replacement(entry.name, name).within(entry.key.span) for name in candidates if node.get(name) is None)
    words = "write " + alternatives([f"'{name}'" for name in candidates]) if candidates else ""
    return KeyHint(words, fixes=tuple(renamed))


def _homes(entry: YamlEntry, known: Mapping[str, Json]) -> list[str]:
    """Return the fields of an object that have a key of this name; none for a misspelt field with keys of its own."""
    if entry.name in COMMON_KEYS or entry.name == "name":
        return []
    if isinstance(entry.value, YamlMap) and entry.value.entries and (intended := nearest(entry.name, known)):
        own = (mapping(kind.get("properties", {})) for kind in branches(mapping(known[intended])))
        if any(entry.value.entries.keys() <= keys.keys() for keys in own):
            return []
    parts = ((home, branches(mapping(part))) for home, part in known.items() if home not in _NOT_HOMES)
    return [home for home, kinds in parts if any(entry.name in mapping(kind.get("properties", {})) for kind in kinds)]


def _is_other_number(name: str, known: Mapping[str, Json]) -> bool:
    """Whether a key is known in its plural or singular."""
    return f"{name}s" in known or name.removesuffix("s") in known


def _decimal_comma_hint(before: YamlNode, entry: YamlEntry) -> str:
    """Return how to write `1,5 mm`, which in braces is the value 1 of the entry before and a key `5 mm`."""
    if not (isinstance(before, YamlScalar) and isinstance(before.value, int) and is_null(entry.value)):
        return ""
    hint = number_hint(f"{before.text},{entry.name}", unit=None)
    return f"write {hint}" if hint else ""


def _decimal_comma_fixes(before: YamlNode, entry: YamlEntry) -> tuple[Fix, ...]:
    """Return the fixes that write both parts of a number as one, for each reading of its comma."""
    begin, end = before.span, entry.value.span
    readings = numbers_with_comma(f"{before.span.text},{entry.name}")
    if begin.file is not end.file:
        return ()
    place = Span(begin.file, *begin.start, *max(entry.key.span.end, end.end))
    return tuple(Fix(f"write '{number}'", (Edit(place, number),)) for number in readings)


def _is_empty(node: YamlNode) -> bool:
    return is_null(node) or (isinstance(node, YamlMap) and not node.entries)


def _may_be_entry(node: YamlNode, section: Json) -> bool:
    """Whether a section keyed by names has entries with all the keys of a map."""
    keys = {entry.name for entry in node} if isinstance(node, YamlMap) else set()
    entries = [mapping(part["additionalProperties"]) for part in branches(mapping(section)) if has_names(part)]
    known = {key for part in entries for branch in branches(part) for key in mapping(branch.get("properties", {}))}
    return bool(keys) and keys <= known
