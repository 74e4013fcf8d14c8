"""What several specs would declare alike, in one file that they include."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.symbols import symbols_of
from linkforge_compile.migration.template import FileDraft, Spec
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode
from linkforge_compile.syntax.writer import write

_SECTIONS = {"data": "data", "variable": "variables", "material": "materials"}
"""The sections that can be shared, by the role of their names."""

_NAMES = ("parameters", "data", "variables")
"""The sections whose names expressions use."""

_NOWHERE = ("", 0)
_Key = tuple[str, str, str, tuple[str, int]]
"""A section, a name in it, what it declares, and where the xacro has the property: two may have one name and value."""


@dataclass
class _Declared:
    """A spec, and what of it another one may declare, too."""

    spec: Spec
    entries: Mapping[_Key, YamlEntry]
    loops: frozenset[str]
    """The names that `for` gives in it."""

    @staticmethod
    def of(spec: Spec) -> _Declared:
        places = {(_SECTIONS.get(one.role), name): one.place for one, name in spec.names.items()}
        entries: dict[_Key, YamlEntry] = {}
        for section in _SECTIONS.values():
            for entry in spec.tree.section(section).values():
                place = places.get((section, entry.name), _NOWHERE)
                if section != "variables" or place != _NOWHERE:
                    text = write(map_of({entry.name: entry.value}, entry.value.span))
                    entries[section, entry.name, text, place if section == "variables" else _NOWHERE] = entry
        return _Declared(spec, entries, _loops(spec.tree))

    def is_free(self, key: _Key) -> bool:
        """Whether a name means nothing else in the spec."""
        section, name, *_ = key
        sections = ("materials",) if section == "materials" else _NAMES
        tree = self.spec.tree
        return key in self.entries or not (any(name in tree.section(one) for one in sections) or name in self.loops)

    def is_alone(self, key: _Key, shared: Collection[_Key]) -> bool:
        """Whether a value that the spec declares needs nothing but what is shared as well."""
        section, name, text, _ = key
        if section == "materials":
            return "$(" not in text
        names = {one[:2] for one in shared}
        values = [
            one.value for one, own in self.spec.names.items() if own == name and _SECTIONS.get(one.role) == section
        ]
        needed = [one for value in values for one in symbols_of(value or ())]
        return bool(values) and all((_SECTIONS.get(one.role), self.spec.names.get(one)) in names for one in needed)


def with_shared(specs: Mapping[FileDraft, Spec], file: str) -> tuple[Mapping[FileDraft, Spec], Spec | None]:
    """Return specs without what several of them declare alike, and the file that they include for it, if any."""
    declared = {draft: _Declared.of(spec) for draft, spec in specs.items()}
    robot = next(one for draft, one in declared.items() if not draft.is_module)
    shared = _shared([*declared.values()], robot)
    if not shared:
        return specs, None
    entries: dict[str, dict[str, YamlEntry]] = {section: {} for section in _SECTIONS.values()}
    comments: dict[YamlNode, str] = {}
    for one in declared.values():
        for (section, name, *_), entry in one.entries.items():
            if (section, name) in {key[:2] for key in shared} and name not in entries[section]:
                entries[section][name] = entry
                comments |= one.spec.comments
    where = next(iter(specs.values())).tree.span
    body = {section: YamlMap(found, where) for section, found in entries.items() if found}
    tree = map_of({"linkforge": scalar("1", where, is_text=False), **body}, where)
    made = {draft: _including(one.spec, shared & one.entries.keys(), file) for draft, one in declared.items()}
    return made, Spec("", tree, {}, {}, comments=comments)


def _shared(declared: Sequence[_Declared], robot: _Declared) -> set[_Key]:
    """Return what several specs declare; the robot would gain a material that it only includes."""
    counts = Counter(key for one in declared for key in one.entries)
    found = {key for key, count in counts.items() if count > 1}
    while True:
        users = [one for one in declared if found & one.entries.keys()]
        refused = {
            key
            for key in found
            if not all(one.is_free(key) for one in users)
            or (key[0] == "materials" and robot in users and key not in robot.entries)
            or not all(one.is_alone(key, found) for one in users if key in one.entries)
        }
        if not refused:
            return found
        found -= refused


def _loops(node: YamlNode | None) -> frozenset[str]:
    """Return the names that `for` gives."""
    if isinstance(node, YamlList):
        return frozenset().union(*map(_loops, node))
    if not isinstance(node, YamlMap):
        return frozenset()
    return frozenset(node.section("for")).union(*(_loops(entry.value) for entry in node))


def _including(spec: Spec, keys: Collection[_Key], file: str) -> Spec:
    """Return a spec that includes a file in the place of what it declares."""
    if not keys:
        return spec
    entries: dict[str, YamlEntry] = {}
    for entry in spec.tree:
        left = entry.value
        if entry.name in _SECTIONS.values() and isinstance(left, YamlMap):
            left = left.without(*(name for section, name, *_ in keys if section == entry.name))
        if not isinstance(left, YamlMap) or len(left):
            entries[entry.name] = YamlEntry(entry.key, left)
        if entry.name == "name":
            where = left.span
            entries["include"] = YamlEntry(scalar("include", where), YamlList((scalar(file, where),), where))
    return replace(spec, tree=YamlMap(entries, spec.tree.span))
