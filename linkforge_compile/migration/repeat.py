"""Write uses of one module that differ in some values as one entry with `for`."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.importers.spec_draft import is_same
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

_MOST_FIELDS = 4
"""The most values in which uses may differ that are written as one."""

_SECTIONS = ("parent", "origin")


class Repeated(NamedTuple):
    """The entries of `modules`, the variables of those with `for`, and their keys by those that they have replaced."""

    modules: YamlMap
    variables: dict[str, YamlNode]
    moved: dict[YamlNode, YamlNode]


def repeated(modules: YamlMap, names: Collection[str], where: Span) -> Repeated:
    """Return the entries of `modules`, with those that follow one another and are alike as one.

    `names` are taken in the file.
    """
    taken = set(names)
    entries: dict[str, YamlEntry] = {}
    variables: dict[str, YamlNode] = {}
    moved: dict[YamlNode, YamlNode] = {}
    for group in _groups(list(modules)):
        made = _one_entry(group, taken, where) if len(group) > 1 else None
        if made is None:
            entries |= {entry.name: entry for entry in group}
            continue
        entry, name, items = made
        entries[entry.name] = entry
        variables[name] = items
        moved[group[0].key] = entry.key
        taken.add(name)
    return Repeated(YamlMap(entries, where), variables, moved)


def _groups(entries: list[YamlEntry]) -> Iterator[list[YamlEntry]]:
    group: list[YamlEntry] = []
    for entry in entries:
        if group and not _is_alike(group[0], entry):
            yield group
            group = []
        group.append(entry)
    if group:
        yield group


def _is_alike(one: YamlEntry, other: YamlEntry) -> bool:
    sides = [entry.value for entry in (one, other)]
    if not all(isinstance(side, YamlMap) for side in sides):
        return False
    keys = [side.entries.keys() for side in sides if isinstance(side, YamlMap)]
    return keys[0] == keys[1] and all(
        is_same(*(side.child(name) for side in sides)) for name in keys[0] if name not in (*_SECTIONS, "with")
    )


def _one_entry(
    group: Sequence[YamlEntry], taken: Collection[str], where: Span
) -> tuple[YamlEntry, str, YamlList] | None:
    """Return the entry for several, the name of a variable and its value; None if they differ in too much."""
    bodies = [entry.value for entry in group if isinstance(entry.value, YamlMap)]
    given = [body.section("with") for body in bodies]
    if any(one.keys() != given[0].keys() for one in given):
        return None
    differing = [name for name in given[0] if not _all_same([one[name].value for one in given])]
    others = [name for name in _SECTIONS if not _all_same([body.child(name) for body in bodies])]
    if len(differing) + len(others) > _MOST_FIELDS or {*differing} & {*others}:
        return None
    use = bodies[0].text("use") or ""
    item = use.partition(".")[0].replace("-", "_")
    name = f"{item}s"
    if name in taken or item in taken or not item.isidentifier():
        return None
    named = next((field for field in differing if _is_name(group, given, field)), None)
    key = named or "entry"
    rows: list[YamlNode] = []
    for entry, body, values in zip(group, bodies, given, strict=True):
        row: dict[str, YamlNode] = {} if named else {key: entry.key}
        row |= {field: values[field].value for field in differing}
        row |= {field: body.entries[field].value for field in others}
        rows.append(map_of(row, where))
    body = _with_items(bodies[0], item, differing, others)
    loop = map_of({"for": map_of({item: scalar(f"$({name})", where)}, where)}, where)
    entry = YamlEntry(scalar(f"$({item}.{key})", where), YamlMap({**loop.entries, **body.entries}, where))
    return entry, name, YamlList(tuple(rows), where)


def _with_items(body: YamlMap, item: str, differing: Sequence[str], others: Sequence[str]) -> YamlMap:
    """Return an entry with the fields of an item in the place of the values that differ."""

    def value_of(entry: YamlEntry, names: Sequence[str]) -> YamlNode:
        return scalar(f"$({item}.{entry.name})", entry.value.span) if entry.name in names else entry.value

    def section_of(entry: YamlEntry) -> YamlNode:
        if entry.name == "with" and isinstance(entry.value, YamlMap):
            return entry.value.mapped(lambda one: value_of(one, differing))
        return value_of(entry, others)

    return body.mapped(section_of)


def _is_name(group: Sequence[YamlEntry], given: Sequence[Mapping[str, YamlEntry]], field: str) -> bool:
    """Whether a value is the name of the entry in each of them."""
    values = [one[field].value for one in given]
    return all(
        isinstance(value, YamlScalar) and value.text == entry.name for entry, value in zip(group, values, strict=True)
    )


def _all_same(nodes: Sequence[YamlNode | None]) -> bool:
    return all(is_same(nodes[0], node) for node in nodes)
