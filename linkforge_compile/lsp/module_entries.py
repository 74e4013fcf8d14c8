"""The entries of `modules` as they are written: those that are used, and those that a `when` leaves out."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.expand import Instance
from linkforge_compile.paths import follow
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, has_expression


class UsedEntry(NamedTuple):
    """A module and its entry as written, in `modules` or in an override of one; `prefix` has those of the uses around.

    The names in `override` are those of the module's file.
    """

    module: Instance
    prefix: str
    fields: YamlMap

    @property
    def override(self) -> YamlMap | None:
        return _map(self.fields.get("override"))


class UnusedEntry(NamedTuple):
    """An entry whose file is not read, since its `when` does not hold; `prefix` is what its names would begin with."""

    entry: YamlEntry
    path: Path
    prefix: str


def used_entries(instance: Instance, prefix: str) -> Iterator[UsedEntry]:
    """Yield the entries of a file, whose names have a prefix, with what their overrides change of nested modules."""
    entries = {entry.key.span: entry.value for entry in _modules_of(instance).values()}
    for module in instance.modules:
        fields = _map(entries.get(module.entry.span)) if module.entry else None
        if fields is not None:
            yield from _with_nested(module, prefix + module.prefix, fields)


def unused_entries(instance: Instance, prefix: str) -> Iterator[UnusedEntry]:
    """Yield the entries of a file that make no module, where their name, file and prefix are plain text."""
    used = {module.entry.span for module in instance.modules if module.entry}
    for entry in _modules_of(instance).values():
        fields = _map(entry.value)
        if fields is None or instance.spec is None or entry.key.span in used:
            continue
        folder, use = instance.spec.part_at(entry.key.span).folder, fields.text("use")
        own = fields.text("prefix")
        own = f"{entry.name}_" if own is None else own
        if folder and use and not any(map(has_expression, (use, own))) and "://" not in use:
            yield UnusedEntry(entry, follow(folder, use), prefix + own)


def unused_files(instance: Instance | None) -> Iterator[Path]:
    """Yield the files of all entries of a robot that make no module."""
    for use in instance.with_modules if instance else ():
        yield from (unused.path for unused in unused_entries(use, ""))


def _modules_of(instance: Instance) -> dict[str, YamlEntry]:
    is_spec = instance.spec is not None and not instance.spec.file.is_xml
    return dict(instance.spec.tree.section("modules")) if instance.spec and is_spec else {}


def _with_nested(module: Instance, prefix: str, fields: YamlMap) -> Iterator[UsedEntry]:
    entry = UsedEntry(module, prefix, fields)
    yield entry
    nested = entry.override.section("modules") if entry.override else {}
    for inner in module.modules:
        changed = _map(nested[inner.name].value) if inner.name in nested else None
        if changed is not None:
            yield from _with_nested(inner, prefix + inner.prefix, changed)


def _map(node: YamlNode | None) -> YamlMap | None:
    return node if isinstance(node, YamlMap) else None
