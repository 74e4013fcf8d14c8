"""One entry of `modules`, computed in the scope of the file that holds it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import MODULE_FIELD, MODULE_WITHOUT_FILE, NOT_A_MODULE, SAME_KEY
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.arguments import Arguments
from linkforge_compile.expand.evaluate_tree import TreeEvaluator
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.expand.overrides import Override


@dataclass(frozen=True)
class ModuleEntry:
    """What an entry says: `ref` is the entry without `with`, `use` None where no file is named.

    `arguments` are those of `with`, computed with `tree`, or already where it is None. Where the name or the
    prefix is at fault (not `is_named`), nobody knows the final names of what is in the module. `overrides` change
    the module, one after the other.
    """

    name: str
    ref: SourceRef
    use: YamlScalar | None = None
    prefix: str = ""
    is_named: bool = True
    arguments: Arguments = field(default_factory=Arguments)
    tree: TreeEvaluator | None = None
    overrides: tuple[Override, ...] = ()


def read_entry(entry: YamlEntry, tree: TreeEvaluator, folder: Path | None, trail: tuple[Span, ...]) -> ModuleEntry:
    """Read an entry of a file that lies in `folder`; what is at fault is reported and as if it were not there."""
    written = entry.value
    # The key of what is faulty stays as it is: its names may be those of the fault itself.
    key = None if isinstance(written, YamlFault) else tree.key(entry.key)
    name = key.text if key else entry.name
    body = tree.node(written, module_shape(), key=name) if isinstance(written, YamlScalar) else written
    if isinstance(body, YamlScalar) and body.value is None:
        body = YamlMap({}, entry.key.span)
    if not isinstance(body, YamlMap):
        if not isinstance(body, YamlFault):
            tree.sink.report(NOT_A_MODULE.at(body.span, name=name, found=found(body)))
        return ModuleEntry(name, SourceRef(YamlFault(body.span), entry.key, trail), is_named=False)
    rest = YamlMap({key: inner for key, inner in body.entries.items() if key not in {"with", "override"}}, body.span)
    fields = tree.node(rest, module_shape())
    assert isinstance(fields, YamlMap), "a map that is computed is a map"
    arguments, is_computed = _arguments(body, name, tree, folder)
    override = _override(body.get("override"), name, tree)
    if key is None:
        # What its name would have made, such as that of its joint, is not judged.
        fault = SourceRef(YamlFault(body.span), entry.key, trail)
        return ModuleEntry(name, fault, is_named=False, arguments=arguments, tree=None if is_computed else tree)
    read = ModuleEntry(
        name,
        SourceRef(fields, entry.key, trail),
        is_named=not isinstance(override, YamlFault),
        arguments=arguments,
        tree=None if is_computed or body is not written else tree,
        overrides=() if override is None or isinstance(override, YamlFault) else (override,),
    )
    return with_fields(read, fields, tree.sink)


def module_shape() -> Shape:
    """Return the shape of an entry of `modules`."""
    return shapes().under("modules").under("")


def with_fields(entry: ModuleEntry, fields: YamlMap, sink: Diagnostics) -> ModuleEntry:
    """Return an entry that says these fields, all of it but `with` and `override`; what is at fault is reported."""
    use = _text(fields, "use", "a file name", entry.name, sink)
    prefix = _text(fields, "prefix", "text", entry.name, sink)
    # A key that nobody knows may have been meant for it, which was reported.
    if use is None and not any(isinstance(field.value, YamlFault) for field in fields):
        sink.report(MODULE_WITHOUT_FILE.at(entry.ref.span, name=entry.name))
    return replace(
        entry,
        ref=replace(entry.ref, node=fields),
        use=use if isinstance(use, YamlScalar) else None,
        prefix=prefix.text if isinstance(prefix, YamlScalar) else f"{entry.name}_",
        is_named=entry.is_named and not isinstance(prefix, YamlFault) and not _is_misspelt(fields),
    )


def _is_misspelt(fields: YamlMap) -> bool:
    """Whether a key that nobody knows was meant for what decides about the names in the module."""
    faulty = (entry.name for entry in fields if isinstance(entry.value, YamlFault))
    return any(nearest(name, ("prefix", "override")) for name in faulty)


def _override(written: YamlNode | None, name: str, tree: TreeEvaluator) -> Override | YamlFault | None:
    if written is None:
        return None
    from linkforge_compile.expand.overrides import Override, refuse_empty

    shape = module_shape().under("override")
    refuse_empty(written, shape, tree.sink)
    patch = tree.part(written, shape, "override")
    if isinstance(patch, YamlMap):
        return Override(patch, tree.sink)
    if patch is None or isinstance(patch, YamlFault) or (isinstance(patch, YamlScalar) and patch.value is None):
        return patch if isinstance(patch, YamlFault) else None
    expected = "a map of what to change in the module"
    tree.sink.report(MODULE_FIELD.at(patch.span, field="override", name=name, expected=expected, found=found(patch)))
    return YamlFault(patch.span)


def _text(fields: YamlMap, field: str, expected: str, name: str, sink: Diagnostics) -> YamlScalar | YamlFault | None:
    """Return a field that is text, None where nothing is said."""
    node = fields.get(field)
    if isinstance(node, YamlList | YamlMap):
        sink.report(MODULE_FIELD.at(node.span, field=field, name=name, expected=expected, found=found(node)))
        return YamlFault(node.span)
    return node


def _arguments(body: YamlMap, name: str, tree: TreeEvaluator, folder: Path | None) -> tuple[Arguments, bool]:
    """Return what `with` gives, and whether it is computed already."""
    written = body.get("with")
    if written is None:
        return Arguments(folder=folder), False
    given = tree.node(written) if isinstance(written, YamlScalar) else written
    if isinstance(given, YamlScalar) and given.value is None:
        return Arguments(folder=folder), False
    if not isinstance(given, YamlMap):
        if not isinstance(given, YamlFault):
            expected = "a map of parameters"
            tree.sink.report(
                MODULE_FIELD.at(given.span, field="with", name=name, expected=expected, found=found(given))
            )
        return Arguments(folder=folder, is_partial=True), False
    return _computed_keys(given, tree, folder), given is not written


def _computed_keys(given: YamlMap, tree: TreeEvaluator, folder: Path | None) -> Arguments:
    entries: dict[str, YamlEntry] = {}
    is_partial = False
    for entry in given:
        key = tree.key(entry.key)
        if key is None:
            is_partial = True
        elif key.text in entries:
            notes = [Note("the first is here", entries[key.text].key.span)]
            tree.sink.report(SAME_KEY.at(key.span, name=key.text, notes=notes))
        else:
            entries[key.text] = YamlEntry(key, entry.value)
    return Arguments(entries, folder, is_partial=is_partial)


def found(node: YamlNode) -> str:
    """Return what stands at a node as messages quote it."""
    if isinstance(node, YamlScalar):
        return f"'{node.text}'"
    return "a list" if isinstance(node, YamlList) else "a map"
