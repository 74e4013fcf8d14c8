"""Read the entries of `modules`, and apply overrides to one use of a module."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.diagnostics import DeletedNames, Diagnostics
from linkforge_compile.diagnostics.codes.modules import (
    MODULE_FIELD,
    MODULE_WITHOUT_FILE,
    MODULES_NOT_MAP,
    NOT_A_MODULE,
)
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.arguments import Arguments
from linkforge_compile.expand.deletions import deleted_names, report_lost, without_links
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.expand_tree import expand_entries, expand_node, expand_part
from linkforge_compile.expand.instance import joint_name_of
from linkforge_compile.expand.long_forms import with_frames_as_joints
from linkforge_compile.expand.override import Override, apply_patch, report_empty
from linkforge_compile.expand.values import describe_node
from linkforge_compile.load.loader import SpecFile
from linkforge_compile.schema.shapes import FREE, Shape, shapes
from linkforge_compile.source import ModuleUse, SourceRef, Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar


@dataclass(frozen=True)
class ModuleEntry:
    """One entry: `ref` is it without `with` and `override`, `use` the file name, None for none.

    `arguments` are those of `with`. If `is_named` is false, the name or the prefix is faulty, so that the final names
    in the module are unknown. `overrides` apply in order. `shared_link` is as for `Instance`.
    `repetition` has the values of its `for` as text, which tell copies of one name apart.
    """

    name: str
    ref: SourceRef
    use: YamlScalar | None = None
    prefix: str = ""
    is_named: bool = True
    arguments: Arguments = field(default_factory=Arguments)
    overrides: tuple[Override, ...] = ()
    shared_link: str | None = None
    repetition: str = ""

    @property
    def copy_in_file(self) -> tuple[Span, str, str]:
        """What tells it apart from every other entry of its file, and from other copies of the same `for`."""
        return self.ref.span, self.name, self.repetition


def read_modules(spec: SpecFile, evaluator: Evaluator, include_stack: tuple[ModuleUse, ...]) -> Iterator[ModuleEntry]:
    """Yield the entries of `modules`, repeated as they say; one without a name for an unreadable section."""
    section = spec.tree.get("modules")
    shape = shapes().under("modules")
    computed = expand_node(section, evaluator, shape, key="modules") if isinstance(section, YamlScalar) else section
    if isinstance(computed, YamlMap):
        for inner, entry in expand_entries(computed, evaluator, shape if computed is section else FREE):
            read = _read_entry(entry, inner, spec.part_at(entry.key.span).folder, include_stack)
            yield read if inner is evaluator else replace(read, repetition=repr(inner.scope.own_values))
    elif computed is not None and not (isinstance(computed, YamlScalar) and computed.value is None):
        if not isinstance(computed, YamlFault):
            evaluator.sink.report(MODULES_NOT_MAP.at(computed.span, found=describe_node(computed)))
        yield ModuleEntry("", SourceRef(YamlFault(computed.span), None, include_stack), is_named=False)


def _read_entry(
    entry: YamlEntry, evaluator: Evaluator, folder: Path | None, include_stack: tuple[ModuleUse, ...]
) -> ModuleEntry:
    """Read an entry of a file in `folder`; faulty parts are reported and left out."""
    written = entry.value
    # A faulty entry keeps its key as written, since its names may be those of the faulty `for`.
    key = None if isinstance(written, YamlFault) else evaluator.key(entry.key)
    name = key.text if key else entry.name
    body = expand_node(written, evaluator, _entry_shape(), key=name) if isinstance(written, YamlScalar) else written
    if isinstance(body, YamlScalar) and body.value is None:
        body = YamlMap({}, entry.key.span)
    if not isinstance(body, YamlMap):
        if not isinstance(body, YamlFault):
            evaluator.sink.report(NOT_A_MODULE.at(body.span, name=name, found=describe_node(body)))
        return ModuleEntry(name, SourceRef(YamlFault(body.span), entry.key, include_stack), is_named=False)
    fields = expand_node(body.without("with", "override"), evaluator, _entry_shape())
    assert isinstance(fields, YamlMap), "a map that is computed is a map"
    arguments = _arguments(body, name, evaluator, folder)
    # What is computed holds no further expressions.
    arguments = arguments if body is written else replace(arguments, evaluator=None)
    override = _override(body.get("override"), name, evaluator)
    if key is None:
        # Names derived from the faulty name, such as that of the joint, are not checked.
        fault = SourceRef(YamlFault(body.span), entry.key, include_stack)
        return ModuleEntry(name, fault, is_named=False, arguments=arguments)
    read = ModuleEntry(
        name,
        SourceRef(fields, entry.key, include_stack),
        is_named=not isinstance(override, YamlFault),
        arguments=arguments,
        overrides=() if override is None or isinstance(override, YamlFault) else (override,),
    )
    return with_fields(read, fields, evaluator.sink)


def _entry_shape() -> Shape:
    return shapes().under("modules").under("")


def with_fields(entry: ModuleEntry, fields: YamlMap, sink: Diagnostics) -> ModuleEntry:
    """Return an entry with other fields, without `with` and `override`; faulty ones are reported."""
    use = _scalar_field(fields, "use", "a file name", entry.name, sink)
    prefix = _scalar_field(fields, "prefix", "text", entry.name, sink)
    faulty_keys = [entry.name for entry in fields if isinstance(entry.value, YamlFault)]
    # A faulty key, already reported, may be a misspelled `use`.
    if use is None and not faulty_keys:
        sink.report(MODULE_WITHOUT_FILE.at(entry.ref.span, name=entry.name))
    may_rename = any(nearest(name, ("prefix", "override")) for name in faulty_keys)
    return replace(
        entry,
        ref=replace(entry.ref, node=fields),
        use=use if isinstance(use, YamlScalar) else None,
        prefix=prefix.text if isinstance(prefix, YamlScalar) else f"{entry.name}_",
        is_named=entry.is_named and not isinstance(prefix, YamlFault) and not may_rename,
    )


def _override(written: YamlNode | None, name: str, evaluator: Evaluator) -> Override | YamlFault | None:
    if written is None:
        return None
    shape = _entry_shape().under("override")
    report_empty(written, shape, evaluator.sink)
    patch = expand_part(written, evaluator, shape, "override")
    if isinstance(patch, YamlMap):
        return Override(patch, evaluator.sink)
    if patch is None or isinstance(patch, YamlFault):
        return patch
    if isinstance(patch, YamlScalar) and patch.value is None:
        return None
    return _report_field(patch, "override", name, "a map of what to change in the module", evaluator.sink)


def _scalar_field(
    fields: YamlMap, field: str, expected: str, name: str, sink: Diagnostics
) -> YamlScalar | YamlFault | None:
    node = fields.get(field)
    if node is None or isinstance(node, YamlScalar | YamlFault):
        return node
    return _report_field(node, field, name, expected, sink)


def _arguments(body: YamlMap, name: str, evaluator: Evaluator, folder: Path | None) -> Arguments:
    """Return the arguments of `with`, with the keys computed, and the values if `with` is itself an expression."""
    written = body.get("with")
    computed = expand_node(written, evaluator) if isinstance(written, YamlScalar) else written
    none = Arguments(folder=folder, evaluator=evaluator if computed is written else None)
    if computed is None or (isinstance(computed, YamlScalar) and computed.value is None):
        return none
    if not isinstance(computed, YamlMap):
        if not isinstance(computed, YamlFault):
            _report_field(computed, "with", name, "a map of parameters", evaluator.sink)
        return replace(none, is_partial=True)
    entries: dict[str, YamlEntry] = {}
    is_partial = False
    for entry in computed:
        key = evaluator.key(entry.key)
        if key is None:
            is_partial = True
        elif key.text in entries:
            evaluator.report_same_key(key, entries[key.text])
        else:
            entries[key.text] = YamlEntry(key, entry.value)
    return replace(none, entries=entries, is_partial=is_partial)


def _report_field(node: YamlNode, field: str, name: str, expected: str, sink: Diagnostics) -> YamlFault:
    found = describe_node(node)
    sink.report(MODULE_FIELD.at(node.span, field=field, name=name, expected=expected, found=found))
    return YamlFault(node.span)


def apply_override(
    override: Override, tree: YamlMap, entries: tuple[ModuleEntry, ...], removed: DeletedNames
) -> tuple[YamlMap, tuple[ModuleEntry, ...], DeletedNames]:
    """Return the tree of one use of a file, its modules and the names removed so far, with an override applied.

    The parts of the override for nested modules go to their entries.
    """
    own, nested = _split_nested(override)
    modules = YamlMap({entry.name: _section_entry(entry) for entry in entries}, tree.span)
    before = with_frames_as_joints(tree.with_value("modules", modules))
    changed = apply_patch(own, before, removed)
    patched = without_links(changed, {*before.section("links")} - {*changed.section("links")})
    report_lost(changed, patched, own.patch, override.sink)
    left = patched.section("modules")
    patched_entries = (
        _patched_entry(entry, left[entry.name].value, modules.entries[entry.name].value, override)
        for entry in entries
        if entry.name in left
    )
    kept = tuple(replace(one, overrides=(*one.overrides, *nested.get(one.name, ()))) for one in patched_entries)
    names = dict(deleted_names(before, patched, own.patch))
    gone = [(entry, names[entry.name]) for entry in entries if entry.name in names]
    names |= {joint_name_of(entry.name, entry.ref.node): note for entry, note in gone}
    deleted = DeletedNames(names, {entry.prefix: note for entry, note in gone})
    return patched.without("modules"), kept, deleted | removed


def _split_nested(override: Override) -> tuple[Override, Mapping[str, tuple[Override, ...]]]:
    """Return an override without those of nested modules, and those by the name of the module."""
    section = override.patch.get("modules")
    if not isinstance(section, YamlMap):
        return override, {}
    maps = {entry.name: entry.value for entry in section if isinstance(entry.value, YamlMap)}
    patches = {name: fields.get("override") for name, fields in maps.items()}
    nested = {name: (replace(override, patch=one),) for name, one in patches.items() if isinstance(one, YamlMap)}
    rest = section.mapped(lambda one: maps[one.name].without("override") if one.name in maps else one.value)
    return replace(override, patch=override.patch.with_value("modules", rest)), nested


def _section_entry(entry: ModuleEntry) -> YamlEntry:
    """Return a module as an entry of `modules`, including `with`."""
    fields = entry.ref.node
    assert isinstance(fields, YamlScalar | YamlList | YamlMap | YamlFault), "an entry of `modules` is YAML"
    if isinstance(fields, YamlMap) and entry.arguments.entries:
        fields = fields.with_value("with", YamlMap(entry.arguments.entries, fields.span))
    return YamlEntry(YamlScalar(entry.name, entry.name, entry.ref.span), fields)


def _patched_entry(entry: ModuleEntry, fields: YamlNode, before: YamlNode, override: Override) -> ModuleEntry:
    """Return a module with the patched fields of its entry of `modules`."""
    if fields is before or not isinstance(fields, YamlMap):
        return entry
    arguments = replace(entry.arguments, entries=fields.section("with"))
    return with_fields(replace(entry, arguments=arguments), fields.without("with"), override.sink)
