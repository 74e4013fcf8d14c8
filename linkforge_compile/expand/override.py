"""Apply the patch of an `override` to a module's expanded tree, in which short forms are long and frames joints."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from linkforge_compile.diagnostics import Code, DeletedNames, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import (
    EMPTY_OVERRIDE,
    MOUNT_IS_NO_JOINT,
    NO_SUCH_POSITION,
    NOTHING_TO_DELETE,
    NOTHING_TO_OVERRIDE,
    PATCH_OF_SEVERAL,
    POSITIONS_AND_KEYS,
    SAME_AS_BEFORE,
)
from linkforge_compile.diagnostics.entry_fixes import move_entry
from linkforge_compile.diagnostics.enumerations import MOST_LISTED, listed
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.long_forms import (
    excluded_keys,
    is_set,
    lists_objects,
    long_form,
    long_object,
)
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expressions import Fault, Value
from linkforge_compile.expressions.operators import AXES
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.nesting import as_path
from linkforge_compile.schema.shapes import FREE, Shape, nested, shapes, split_path
from linkforge_compile.source import Change, SourceRef, TracedSpan
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Quantity

SECTIONS = (
    *("links", "joints", "modules", "mount", "materials", "sensors", "transmissions", "ros2_control", "controllers"),
)
"""The sections whose entries have names that overrides refer to."""

_GAZEBO_BLOCKS = ("a gazebo block", "a robot's gazebo block")
_PROPERTIES = "properties"


@dataclass(frozen=True)
class Override:
    """What one file changes in a module: `patch` is computed in that file's scope, `sink` receives its faults."""

    patch: YamlMap
    sink: Diagnostics


def report_empty(node: YamlNode, shape: Shape, sink: Diagnostics, key: YamlScalar | None = None) -> None:
    """Report every value of a written override that is left empty, which is not even `null`; `key` is its key."""
    field = key.text if key else "module"
    if isinstance(node, YamlScalar) and node.value is None and not node.text and not shape.is_plain:
        sink.report(EMPTY_OVERRIDE.at(node.span, field=field).with_fix(_null_after(key)))
    elif isinstance(node, YamlMap):
        if not node.entries:
            sink.report(EMPTY_OVERRIDE.at(node.span, field=field).replacing("", "null"))
        for entry in node:
            if entry.name not in WORDS or shape.is_plain:
                report_empty(entry.value, shape.under(entry.name), sink, entry.key)


def _null_after(key: YamlScalar | None) -> Fix | None:
    """Return the fix that writes `null` after a key; None if its colon is not next to it."""
    if key is None or key.span.file.line(key.span.line)[key.span.end_column - 1 :][:1] != ":":
        return None
    after = key.span.within(len(key.span.text or ""), 1)
    return Fix("write 'null'", (Edit(after, ": null"),))


def apply_patch(override: Override, tree: YamlMap, deleted: DeletedNames) -> YamlMap:
    """Return a module's tree with the patch of an override applied; faulty parts are reported and not applied.

    `deleted` explains names that are missing in the tree.
    """
    return _Patcher(override.sink, deleted, tree, override.patch).patch_map(tree, override.patch, shapes())


def deletes(node: YamlNode) -> bool:
    """Whether a value in a patch is a written `null`, which deletes what it patches."""
    return isinstance(node, YamlScalar) and node.value is None and bool(node.text)


class _Patcher:
    """Applies one patch to one tree."""

    def __init__(self, sink: Diagnostics, deleted: DeletedNames, module: YamlMap, patch: YamlMap) -> None:
        """`module` is the whole tree, where a name may be that is missing in one section."""
        self._sink = sink
        self._deleted = deleted
        self._module = module
        self._patch = patch

    def patch_map(self, base: YamlMap, patch: YamlMap, shape: Shape) -> YamlMap:
        """Return an object or a map of names with its patch applied."""
        base, patch = long_object(base, shape), long_object(patch, shape)
        base = with_tags_as_patched(base, patch, shape)
        entries = dict(base.entries)
        changes: list[Change] = []
        missing: list[YamlEntry] = []
        for change in patch:
            name, value = change.name, change.value
            if shape.has_names and name not in base.entries and not shape.is_raw(name):
                missing.append(change)
            elif deletes(value):
                if entries.pop(name, None) is None:
                    self._sink.report(NOTHING_TO_DELETE.at(change.key.span, field=name))
                changes.append(Change(name, value.span))
            elif is_set(value) and not isinstance(entries.get(name, change).value, YamlFault):
                changes += self._patch_entry(entries, change, shape)
        # A base entry whose name is faulty may be any of the missing ones.
        if missing and not any("$(" in name for name in base.entries):
            for change in missing:
                self._report_missing(change, base, shape)
        for name in excluded_keys(patch, shape):
            entries.pop(name, None)
        return YamlMap(entries, TracedSpan.overridden(base.span, tuple(changes)))

    def _patch_entry(self, entries: dict[str, YamlEntry], change: YamlEntry, shape: Shape) -> list[Change]:
        """Patch one entry; return the change unless the entry's value records it in itself."""
        name, value, old = change.name, change.value, entries.get(change.name)
        new = self._patch_node(old.value if old else None, value, shape.under(name), name)
        is_merged = old is not None and isinstance(old.value, YamlMap) and isinstance(new, YamlMap)
        replaced = None if old is None or is_merged or not is_set(old.value) else old
        entries[name] = YamlEntry(old.key if old else change.key, new, replaced)
        is_replaced = not isinstance(new, YamlList) or isinstance(value, YamlList)
        return [Change(name, value.span)] if is_replaced and not is_merged and not new.span.changes else []

    def _patch_node(self, base: YamlNode | None, patch: YamlNode, shape: Shape, field: str) -> YamlNode:
        """Return the value of a key with its patch applied; `base` is None for a key that is not set."""
        base = base if base is not None and is_set(base) else None
        if isinstance(patch, YamlMap) and shape.item and any(entry.name.isdecimal() for entry in patch):
            return self._patch_positions(base, patch, shape, field)
        if isinstance(patch, YamlMap) and lists_objects(shape):
            return self._patch_single_item(base, patch, shape, field)
        # A list replaces the base, even if it could be read as a map of names.
        new = patch if isinstance(patch, YamlList) and shape.has_names else long_form(patch, shape)
        old = None if base is None else long_form(base, shape)
        if isinstance(new, YamlMap) and not shape.is_plain:
            # Entries of a map that does not exist are missing, which is reported.
            return self.patch_map(old if isinstance(old, YamlMap) else YamlMap({}, new.span), new, shape)
        if isinstance(new, YamlMap) and isinstance(old, YamlMap):
            return self.patch_map(old, new, shape)
        # A computed value may be another one in another variant.
        constants = () if old is None or _is_computed(old) or _is_computed(patch) else (old, new)
        values = [plain_value(one) for one in constants]
        comparable = [_comparable(value, field, shape) for value in values if not isinstance(value, Fault)]
        if len(comparable) == 2 and comparable[0] == comparable[1]:
            self._sink.report(SAME_AS_BEFORE.at(patch.span, field=field))
        return new

    def _patch_single_item(self, base: YamlNode | None, patch: YamlMap, shape: Shape, field: str) -> YamlNode:
        assert shape.item, "lists only"
        items = _items(base, shape)
        if len(items) > 1:
            self._sink.report(PATCH_OF_SEVERAL.at(patch.span, field=field, length=len(items)))
            return base or patch
        old = items[0] if items and isinstance(items[0], YamlMap) else YamlMap({}, patch.span)
        return YamlList((self.patch_map(old, patch, shape.item),), patch.span)

    def _patch_positions(self, base: YamlNode | None, patch: YamlMap, shape: Shape, field: str) -> YamlNode:
        """Return a list with patches applied by position, counted before any item is deleted."""
        assert shape.item, "lists only"
        items: list[YamlNode | None] = list(_items(base, shape))
        changes: list[Change] = []
        length = f"{len(items)} item" if len(items) == 1 else f"{len(items)} items"
        for change in patch:
            if not change.name.isdecimal():
                self._report(POSITIONS_AND_KEYS, change, field=field)
            elif int(change.name[:9]) >= len(items):
                self._report(NO_SUCH_POSITION, change, field=field, length=length)
            elif deletes(change.value):
                items[int(change.name)] = None
                changes.append(Change(change.name, change.value.span))
            elif is_set(change.value):
                place = int(change.name)
                items[place] = self._patch_node(items[place], change.value, shape.item, field)
        span = TracedSpan.overridden(base.span if base else patch.span, tuple(changes))
        return YamlList(tuple(item for item in items if item is not None), span)

    def _report_missing(self, change: YamlEntry, base: YamlMap, shape: Shape) -> None:
        """Report an entry that does not exist, unless its own name is faulty."""
        name = change.name
        if "$(" in name:
            return
        hint = _nesting_hint(name, base, shape)
        if hint and isinstance(change.value, YamlFault):
            return  # the schema reported it with the same hint
        if name in self._module.section("mount") and shape is shapes().under("joints"):
            self._report(MOUNT_IS_NO_JOINT, change, fix=self._moved("joints", change, "mount"))
            return
        notes = self._deleted.notes(name)
        fix = as_path(steps, change) if (steps := _path_in_name(name, base, shape)) else None
        own = next((section for section in SECTIONS if shape is shapes().under(section)), None)
        other = next((section for section in SECTIONS if own and name in self._module.section(section)), None)
        if own and other and not (notes or hint):
            hint = f"; write '{other}: {{{name}: …}}', for it is one of the {shapes().under(other).things}"
            fix = self._moved(own, change, other)
        hint = "" if notes else hint or self._names_hint(name, base)
        near = () if notes or hint else base.entries
        self._report(NOTHING_TO_OVERRIDE, change, fix=fix, near=near, notes=notes, owner=shape.things, hint=hint)

    def _moved(self, section: str, change: YamlEntry, to: str) -> Fix | None:
        """Return the fix that writes a change in another section of the override."""
        is_only = len(self._patch.section(section)) == 1
        return move_entry(SourceRef(self._patch), section, change.name, to, is_only=is_only)

    def _names_hint(self, name: str, base: YamlMap) -> str:
        """Return the existing names if none of them is similar to a missing one."""
        if not 0 < len(base.entries) <= MOST_LISTED or nearest(name, base.entries):
            return ""
        return f"; there {'is' if len(base.entries) == 1 else 'are'} {listed([*base.entries], 'and')}"

    def _report(
        self,
        code: Code,
        change: YamlEntry,
        *,
        fix: Fix | None = None,
        near: Mapping[str, object] | tuple[()] = (),
        notes: list[Note] | None = None,
        **facts: object,
    ) -> None:
        fault = code.at(change.key.span, near=near, notes=notes or (), name=change.name, **facts)
        self._sink.report(fault.with_fix(fix))


def _items(base: YamlNode | None, shape: Shape) -> tuple[YamlNode, ...]:
    """Return the items of a list, or the single object that is written for a list of one."""
    # A list of names stays a list, even if it could be read as a map of names.
    whole = base if base is None or isinstance(base, YamlList) else long_form(base, shape)
    return whole.items if isinstance(whole, YamlList) else ()


def _nesting_hint(name: str, base: YamlMap, shape: Shape) -> str:
    """Return how to write a path such as `elbow/limits` that was written as a name; "" for any other name."""
    steps = _path_in_name(name, base, shape)
    return f"; write '{nested(steps, '…')}'" if steps else ""


def _path_in_name(name: str, base: YamlMap, shape: Shape) -> Sequence[str]:
    """Return the keys of a path that was written as a name; none for any other name."""
    first, *steps = split_path(name)
    is_path = steps and first in base.entries and steps[0] in shape.under(first).keys
    return [first, *steps] if is_path else ()


def _comparable(value: Value, field: str, shape: Shape) -> Value:
    """Return a value with its axis as numbers and its numbers in SI units, so that equal values compare equal.

    A quantity stays one if its dimension is not that of the field, or if the field's depends on other fields, as a
    joint's velocity depends on the joint's type.
    """
    match value:
        case bool():
            return (str(value),)  # Python takes it for 0 or 1
        case str() if field == "axis" and (letter := value.lstrip("-")) in AXES:
            length = 1 if value == letter else -1
            return tuple(length if name == letter else 0 for name in AXES)
        case Quantity() if shape.is_free_part or shape.is_text:
            return str(value)
        case Quantity() if value.dimension.si_unit == shape.unit:
            return value.value
        case tuple():
            return tuple(_comparable(item, field, shape.item or shape) for item in value)
        case Mapping():
            return {name: _comparable(item, name, FREE) for name, item in value.items()}
    return value


def _is_computed(node: YamlNode) -> bool:
    """Return whether a scalar, or an item of a list or value of a map, was written as an expression."""
    if isinstance(node, YamlList):
        return any(map(_is_computed, node.items))
    if isinstance(node, YamlMap):
        return any(_is_computed(entry.value) for entry in node)
    return "$(" in (node.span.text or "")


def with_tags_as_patched(block: YamlMap, patch: YamlMap, shape: Shape) -> YamlMap:
    """Return a Gazebo block with each tag that a patch sets where the patch has it, as a key or under `properties`.

    Otherwise the block would have the tag twice. Anything but a Gazebo block is returned unchanged.
    """
    if shape.title not in _GAZEBO_BLOCKS:
        return block
    entries = dict(block.entries)
    properties, patched = dict(block.section(_PROPERTIES)), patch.section(_PROPERTIES)
    keys = {_gazebo_tag(name): name for name in entries if _is_tag_key(shape, name)}
    for name in patch.entries:
        if _is_tag_key(shape, name) and (moved := properties.pop(_gazebo_tag(name), None)):
            entries[name] = YamlEntry(YamlScalar(name, name, moved.key.span), moved.value)
    for tag in patched.keys() & keys.keys():
        moved = entries.pop(keys[tag])
        properties[tag] = YamlEntry(YamlScalar(tag, tag, moved.key.span), moved.value)
    changed, section = YamlMap(entries, block.span), block.entries.get(_PROPERTIES)
    if section is not None and not isinstance(section.value, YamlMap):
        return changed
    changed = changed.without(_PROPERTIES)
    span = section.value.span if section else block.span
    return changed.with_value(_PROPERTIES, YamlMap(properties, span)) if properties else changed


def _is_tag_key(shape: Shape, name: str) -> bool:
    return name != _PROPERTIES and shape.under(name) is not FREE


def _gazebo_tag(key: str) -> str:
    """Return the tag of a key, which has capitals in place of underscores: `max_vel` is `maxVel`."""
    return re.sub(r"_([a-z])", lambda found: found[1].upper(), key)
