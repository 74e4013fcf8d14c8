"""Apply overrides to one use of a module: its tree, what refers to deleted links, and its own `modules`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from linkforge_compile.diagnostics import DeletedNames, Note
from linkforge_compile.expand.assembly import joint_name_of
from linkforge_compile.expand.modules import ModuleEntry, with_fields
from linkforge_compile.expand.normal_form import with_frames_as_joints
from linkforge_compile.expand.override import SECTIONS, Override, apply_patch, deletes, names_in_section
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar

_SEMANTIC_SECTIONS = ("groups", "virtual_joints", "end_effectors")


@dataclass(frozen=True)
class ModuleBody:
    """The content of one use of a file before its modules are read; `removed` are the names deleted so far."""

    tree: YamlMap
    entries: tuple[ModuleEntry, ...]
    removed: DeletedNames

    def with_overrides(self, overrides: Iterable[Override]) -> ModuleBody:
        """Return the body with overrides applied in order; their parts for nested modules go to the entries."""
        body = self
        for override in overrides:
            body = body._with_override(override)
        return body

    def _with_override(self, override: Override) -> ModuleBody:
        own, nested = _split_nested(override)
        modules = YamlMap({entry.name: _section_entry(entry) for entry in self.entries}, self.tree.span)
        before = with_frames_as_joints(_with_section(self.tree, "modules", modules))
        patched = apply_patch(own, before, self.removed)
        patched = _without_links(patched, {*names_in_section(before, "links")} - {*names_in_section(patched, "links")})
        section = patched.get("modules")
        left = section.entries if isinstance(section, YamlMap) else {}
        entries = tuple(
            _with_nested(
                _patched_entry(entry, left[entry.name].value, modules.entries[entry.name].value, override), nested
            )
            for entry in self.entries
            if entry.name in left
        )
        names = dict(_deleted_names(before, patched, own.patch))
        gone = [(entry, names[entry.name]) for entry in self.entries if entry.name in names]
        names |= {joint_name_of(entry.name, entry.ref.node): note for entry, note in gone}
        removed = DeletedNames(names, {entry.prefix: note for entry, note in gone}) | self.removed
        return ModuleBody(_without_key(patched, "modules"), entries, removed)


def _split_nested(override: Override) -> tuple[Override, Mapping[str, Override]]:
    """Return an override without those of nested modules, and those by the name of the module."""
    section = override.patch.get("modules")
    if not isinstance(section, YamlMap):
        return override, {}
    nested, rest = {}, {}
    for entry in section:
        fields = entry.value
        rest[entry.name] = entry
        if isinstance(fields, YamlMap):
            rest[entry.name] = YamlEntry(entry.key, _without_key(fields, "override"))
            if isinstance(inner := fields.get("override"), YamlMap):
                nested[entry.name] = replace(override, patch=inner)
    patch = _with_section(override.patch, "modules", YamlMap(rest, section.span))
    return replace(override, patch=patch), nested


def _section_entry(entry: ModuleEntry) -> YamlEntry:
    """Return a module as an entry of `modules`, including `with`."""
    fields = entry.ref.node
    key = YamlScalar(entry.name, entry.name, entry.ref.span)
    assert isinstance(fields, YamlScalar | YamlList | YamlMap | YamlFault), "an entry of `modules` is YAML"
    if not isinstance(fields, YamlMap) or not entry.arguments.entries:
        return YamlEntry(key, fields)
    return YamlEntry(key, _with_section(fields, "with", YamlMap(entry.arguments.entries, fields.span)))


def _patched_entry(entry: ModuleEntry, fields: YamlNode, before: YamlNode, override: Override) -> ModuleEntry:
    """Return a module with the patched fields of its entry of `modules`."""
    if fields is before or not isinstance(fields, YamlMap):
        return entry
    section = fields.get("with")
    arguments = replace(entry.arguments, entries=section.entries if isinstance(section, YamlMap) else {})
    return with_fields(replace(entry, arguments=arguments), _without_key(fields, "with"), override.sink)


def _with_nested(entry: ModuleEntry, nested: Mapping[str, Override]) -> ModuleEntry:
    if entry.name not in nested:
        return entry
    return replace(entry, overrides=(*entry.overrides, nested[entry.name]))


def _deleted_names(before: YamlMap, after: YamlMap, patch: YamlMap) -> Iterator[tuple[str, Note]]:
    """Yield each name that a patch has removed, with a note that shows where it is deleted."""
    yield from _deleted_in(before, after, patch, SECTIONS)
    semantic, left, semantic_patch = (tree.get("semantic") for tree in (before, after, patch))
    if isinstance(semantic, YamlMap) and isinstance(semantic_patch, YamlMap):
        left = left if isinstance(left, YamlMap) else YamlMap({}, after.span)
        yield from _deleted_in(semantic, left, semantic_patch, _SEMANTIC_SECTIONS)


def _deleted_in(
    before: YamlMap, after: YamlMap, patch: YamlMap, sections: tuple[str, ...]
) -> Iterator[tuple[str, Note]]:
    for section in sections:
        entries, left = before.get(section), names_in_section(after, section)
        for entry in entries if isinstance(entries, YamlMap) else ():
            if entry.name in left:
                continue
            child = _text(entry.value, "child") if section in ("joints", "mount") else None
            if where := _deletion(patch, section, entry.name):
                yield entry.name, Note(f"'{entry.name}' is deleted by this override", where)
            elif child and (where := _deletion(patch, "links", child)):
                yield entry.name, Note(f"to delete link '{child}' deletes '{entry.name}', the joint to it", where)
            else:
                yield entry.name, Note(f"'{entry.name}' is deleted by this override", patch.span)


def _deletion(patch: YamlMap, section: str, name: str) -> Span | None:
    """Return where a patch deletes an entry or its whole section, None if it does not."""
    whole = patch.entries.get(section)
    deletion = whole.value.entries.get(name) if whole and isinstance(whole.value, YamlMap) else whole
    return deletion.key.span if deletion and deletes(deletion.value) else None


def _without_links(tree: YamlMap, links: set[str]) -> YamlMap:
    """Return a tree without what refers to deleted links: joints to them, Gazebo blocks, collision pairs, spheres."""
    if not links:
        return tree
    sections = dict(tree.entries)
    gazebo, semantic = tree.get("gazebo"), tree.get("semantic")
    gone = set(links)
    for name in ("joints", "mount"):
        if isinstance(joints := tree.get(name), YamlMap):
            kept = [entry for entry in joints if _text(entry.value, "child") not in links]
            gone |= joints.entries.keys() - {entry.name for entry in kept}
            sections[name] = YamlEntry(sections[name].key, _map_of(kept, joints.span))
    if isinstance(gazebo, YamlList | YamlMap):
        blocks = gazebo.items if isinstance(gazebo, YamlList) else (gazebo,)
        left = tuple(block for block in blocks if _text(block, "reference") not in gone)
        sections["gazebo"] = YamlEntry(sections["gazebo"].key, YamlList(left, gazebo.span))
    if isinstance(semantic, YamlMap):
        sections["semantic"] = YamlEntry(sections["semantic"].key, _semantic_without(semantic, links))
    return YamlMap(sections, tree.span)


def _semantic_without(semantic: YamlMap, links: set[str]) -> YamlMap:
    parts = dict(semantic.entries)
    for name in ("disabled_collisions", "enabled_collisions", "link_sphere_approximations"):
        part = semantic.get(name)
        if isinstance(part, YamlMap):
            kept = [entry for entry in part if entry.name not in links]
            if name != "link_sphere_approximations":
                kept = [YamlEntry(entry.key, _pairs_without(entry.value, links)) for entry in kept]
            parts[name] = YamlEntry(parts[name].key, _map_of(kept, part.span))
    return YamlMap(parts, semantic.span)


def _pairs_without(pairs: YamlNode, links: set[str]) -> YamlNode:
    if not isinstance(pairs, YamlMap):
        return pairs
    return _map_of([entry for entry in pairs if entry.name not in links], pairs.span)


def _map_of(entries: list[YamlEntry], span: Span) -> YamlMap:
    return YamlMap({entry.name: entry for entry in entries}, span)


def _without_key(node: YamlMap, key: str) -> YamlMap:
    return YamlMap({name: entry for name, entry in node.entries.items() if name != key}, node.span)


def _with_section(node: YamlMap, name: str, section: YamlMap) -> YamlMap:
    key = node.entries[name].key if name in node.entries else YamlScalar(name, name, section.span)
    return YamlMap({**node.entries, name: YamlEntry(key, section)}, node.span)


def _text(node: YamlNode, key: str) -> str | None:
    value = node.child(key)
    return value.text if isinstance(value, YamlScalar) else None
