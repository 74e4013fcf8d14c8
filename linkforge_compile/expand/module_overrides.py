"""An override over one use of a file: over its tree, over its entries of `modules`, and through those to theirs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from linkforge_compile.diagnostics import DeletedNames
from linkforge_compile.expand.assembly import joint_name_of
from linkforge_compile.expand.module_entry import ModuleEntry, with_fields
from linkforge_compile.expand.overrides import Override
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar


@dataclass(frozen=True)
class Body:
    """What one use of a file holds before its modules are read; `removed` says of names why they are not there."""

    tree: YamlMap
    entries: tuple[ModuleEntry, ...]
    removed: DeletedNames

    def under(self, *overrides: Override) -> Body:
        """Return the same with overrides applied one by one; what they say of nested modules goes to their entries."""
        body = self
        for override in overrides:
            body = body._under(override)
        return body

    def _under(self, override: Override) -> Body:
        patch, nested = _without_nested(override)
        modules = YamlMap({entry.name: _as_written(entry) for entry in self.entries}, self.tree.span)
        whole = _with_section(self.tree, "modules", modules)
        patched = patch.applied(whole, self.removed)
        section = patched.get("modules")
        left = section.entries if isinstance(section, YamlMap) else {}
        entries = tuple(
            _nested(_patched(entry, left[entry.name].value, modules.entries[entry.name].value, override), nested)
            for entry in self.entries
            if entry.name in left
        )
        names = dict(patch.deleted(whole, patched))
        gone = [(entry, names[entry.name]) for entry in self.entries if entry.name in names]
        names |= {joint_name_of(entry.name, entry.ref.node): note for entry, note in gone}
        starts = {entry.prefix: note for entry, note in gone}
        removed = DeletedNames(names, starts) | self.removed
        tree = YamlMap({name: one for name, one in patched.entries.items() if name != "modules"}, patched.span)
        return Body(tree, entries, removed)


def _without_nested(override: Override) -> tuple[Override, Mapping[str, Override]]:
    """Return an override without those of nested modules, and those by the name of the module."""
    section = override.patch.get("modules")
    if not isinstance(section, YamlMap):
        return override, {}
    nested, left = {}, {}
    for entry in section:
        said = entry.value
        left[entry.name] = entry
        if isinstance(said, YamlMap):
            left[entry.name] = YamlEntry(entry.key, _without(said, "override"))
            if isinstance(inner := said.get("override"), YamlMap):
                nested[entry.name] = replace(override, patch=inner)
    patch = _with_section(override.patch, "modules", YamlMap(left, section.span))
    return replace(override, patch=patch), nested


def _as_written(entry: ModuleEntry) -> YamlEntry:
    """Return an entry as `modules` holds it, `with` included."""
    fields = entry.ref.node
    key = YamlScalar(entry.name, entry.name, entry.ref.span)
    assert isinstance(fields, YamlScalar | YamlList | YamlMap | YamlFault), "an entry of `modules` is YAML"
    if not isinstance(fields, YamlMap) or not entry.arguments.entries:
        return YamlEntry(key, fields)
    return YamlEntry(key, _with_section(fields, "with", YamlMap(entry.arguments.entries, fields.span)))


def _patched(entry: ModuleEntry, fields: YamlNode, before: YamlNode, override: Override) -> ModuleEntry:
    """Return an entry as the fields say that an override has left of it, `with` included."""
    if fields is before or not isinstance(fields, YamlMap):
        return entry
    given = fields.get("with")
    arguments = replace(entry.arguments, entries=given.entries if isinstance(given, YamlMap) else {})
    return with_fields(replace(entry, arguments=arguments), _without(fields, "with"), override.sink)


def _nested(entry: ModuleEntry, nested: Mapping[str, Override]) -> ModuleEntry:
    """Return an entry that hands on what an override says of the inside of its module."""
    if entry.name not in nested:
        return entry
    return replace(entry, overrides=(*entry.overrides, nested[entry.name]))


def _without(node: YamlMap, key: str) -> YamlMap:
    return YamlMap({name: entry for name, entry in node.entries.items() if name != key}, node.span)


def _with_section(node: YamlMap, name: str, section: YamlMap) -> YamlMap:
    key = node.entries[name].key if name in node.entries else YamlScalar(name, name, section.span)
    return YamlMap({**node.entries, name: YamlEntry(key, section)}, node.span)
