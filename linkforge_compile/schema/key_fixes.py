"""Fixes of keys that the table of hints knows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.diagnostics.fix import Edit, Fix, Replacement
from linkforge_compile.schema.hints import LIST_OF_NUMBERS, likely_key
from linkforge_compile.schema.json_schema import Json
from linkforge_compile.schema.nesting import in_place, section_of, without_map
from linkforge_compile.schema.number_texts import numbers_in_row
from linkforge_compile.schema.srdf_habits import LIST_SECTIONS, srdf_entries, srdf_section_of
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlScalar

_WITHOUT_MAP = ("geometry", "image")
"""Keys of other formats around keys that are the same here."""


def fix_of_key(owner: str, entries: Sequence[YamlEntry], node: YamlMap, known: Mapping[str, Json]) -> Fix | None:
    """Return the fix for neighbours in a map with the same mistake in their keys; None where that needs a choice."""
    entry = entries[0]
    if numbers := LIST_OF_NUMBERS.get((owner, entry.name)):
        return _as_list(numbers, entries, node)
    if owner == "a semantic part" and (section := srdf_section_of(entry.name)):
        return _as_section(section, entry, node)
    new = likely_key(owner, entry.name)
    if new and new in known and node.get(new) is None:
        return Replacement("", new).within(entry.key.span) if entry.key.span.text == entry.name else None
    if entry.name in _WITHOUT_MAP and isinstance(entry.value, YamlMap):
        is_free = node.entries.keys().isdisjoint(entry.value.entries) and entry.value.entries.keys() <= known.keys()
        texts = _texts(entry.value, {})
        return (without_map(entry, node) or (in_place(texts, [entry], node) if texts else None)) if is_free else None
    new_texts = _OTHER[entry.name](entry) if entry.name in _OTHER else ()
    keys = [text.partition(":")[0] for text in new_texts]
    is_right = keys and all(key in known and node.get(key) is None for key in keys)
    return in_place(new_texts, [entry], node) if is_right else None


def _as_list(numbers: tuple[str, Sequence[str]], entries: Sequence[YamlEntry], node: YamlMap) -> Fix | None:
    """Return the fix that writes numbers with keys of their own as one list, an absent one as 0."""
    key, order = numbers
    texts = {entry.name: entry.value.span.text for entry in entries}
    is_whole = len(texts) == len(node)
    if any(not text or "[" in text for text in texts.values()) or (key and node.get(key) is not None):
        return None
    wanted = order if key else [name for name in order if name in texts]
    if not {*texts} <= {*wanted} or (not key and not (is_whole and len(texts) >= 3)):
        return None
    values = f"[{', '.join(texts.get(name) or '0' for name in wanted)}]"
    if key:
        return in_place([f"{key}: {values}"], entries, node)
    span = node.span
    return None if span.file.is_xml or span.text is None else Fix(f"write '{values}'", (Edit(span, values),))


def _as_section(section: str, entry: YamlEntry, node: YamlMap) -> Fix | None:
    inner = srdf_entries(section, entry.value)
    if not inner:
        return None
    if section in LIST_SECTIONS:
        is_new = node.get(section) is None
        return in_place([f"{section}: [{', '.join(inner)}]"], [entry], node) if is_new else None
    return section_of(section, inner, entry, node)


def _texts(value: YamlMap, names: Mapping[str, str]) -> Sequence[str]:
    """Return the entries of a map with other names; () if one is not on one line."""
    texts = [f"{names.get(entry.name, entry.name)}: {entry.value.span.text}" for entry in value]
    return () if any(entry.value.span.text is None for entry in value) else texts


def _pose(entry: YamlEntry) -> Sequence[str]:
    """Return the six numbers of a pose in SDF as an origin."""
    match entry.value:
        case YamlList(items=items):
            numbers: Sequence[str] = [item.span.text or "" for item in items]
        case YamlScalar(text=text):
            numbers = numbers_in_row(text)
        case _:
            return ()
    if len(numbers) != 6 or not all(numbers):
        return ()
    return [f"origin: {{xyz: [{', '.join(numbers[:3])}], rpy: [{', '.join(numbers[3:])}]}}"]


def _negated(entry: YamlEntry) -> Sequence[str]:
    text = entry.value.span.text or ""
    is_expression = text.startswith("$(") and text.endswith(")") and text.count("$(") == 1
    return [f"when: $(not ({text[2:-1]}))"] if is_expression else ()


def _plugin(entry: YamlEntry) -> Sequence[str]:
    """Return the only entry of `hardware`, its plugin."""
    value = entry.value
    plugin = value.get("plugin") if isinstance(value, YamlMap) and len(value) == 1 else None
    return [f"hardware_plugin: {plugin.span.text}"] if plugin is not None and plugin.span.text else ()


def _range(entry: YamlEntry) -> Sequence[str]:
    """Return the entries of `range` as keys of a lidar."""
    names = {name: f"range_{name}" for name in ("min", "max", "resolution")}
    is_range = isinstance(entry.value, YamlMap) and entry.value.entries.keys() <= names.keys()
    return _texts(entry.value, names) if is_range and isinstance(entry.value, YamlMap) else ()


_OTHER = {
    "hardware": _plugin,
    "pose": _pose,
    "range": _range,
    "transform": _pose,
    "unless": _negated,
    "xacro:unless": _negated,
}
