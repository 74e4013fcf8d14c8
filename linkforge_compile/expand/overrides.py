"""`override`: the patch of a module over its expanded tree, in which short forms are long and frames are joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from linkforge_compile.diagnostics import Code, DeletedNames, Diagnostics, Note
from linkforge_compile.diagnostics.codes.repetition import (
    EMPTY_OVERRIDE,
    MOUNT_IS_NO_JOINT,
    NO_SUCH_POSITION,
    NOTHING_TO_DELETE,
    NOTHING_TO_OVERRIDE,
    PATCH_OF_SEVERAL,
    POSITIONS_AND_KEYS,
    SAME_AS_BEFORE,
)
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.gazebo_tags import with_tags_as_patched
from linkforge_compile.expand.normal_form import (
    CHOICES,
    is_said,
    lists_objects,
    long_form,
    long_object,
    with_frames_as_joints,
)
from linkforge_compile.schema.repetition import WORDS
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.schema.words import alternatives
from linkforge_compile.source import Change, Span, TracedSpan
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Quantity, parse_quantity

_SHOWN_NAMES = 8

_AXES: Mapping[str, tuple[int, int, int]] = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


@dataclass(frozen=True)
class Override:
    """What one file changes in a module: `patch` is computed in that file's scope, `sink` takes what is wrong there."""

    patch: YamlMap
    sink: Diagnostics

    def applied(self, tree: YamlMap, missing: DeletedNames) -> YamlMap:
        """Return a module's tree as this override leaves it; `missing` says why names are not there.

        Whatever hangs on a link that is deleted goes with it: the joint to it, the Gazebo blocks about either, its
        collision pairs and its spheres.
        """
        whole = with_frames_as_joints(tree)
        patched = _Patch(self.sink, missing, whole).map(whole, self.patch, shapes(), "the module")
        return _without_links(patched, set(_names(whole, "links")) - set(_names(patched, "links")))

    def deleted(self, before: YamlMap, after: YamlMap) -> Iterator[tuple[str, Note]]:
        """Yield the names that are gone, each with the place that deletes it."""
        whole = with_frames_as_joints(before)
        yield from _deleted(whole, after, self.patch, _SECTIONS)
        semantic, left, patch = (tree.get("semantic") for tree in (whole, after, self.patch))
        if isinstance(semantic, YamlMap) and isinstance(patch, YamlMap):
            left = left if isinstance(left, YamlMap) else YamlMap({}, after.span)
            yield from _deleted(semantic, left, patch, _SEMANTIC_SECTIONS)


def refuse_empty(node: YamlNode, shape: Shape, sink: Diagnostics, field: str = "module") -> None:
    """Report every value of an override, as it is written, that says nothing: not even `null`."""
    if isinstance(node, YamlScalar) and node.value is None and not node.text and not shape.is_plain:
        sink.report(EMPTY_OVERRIDE.at(node.span, field=field))
    elif isinstance(node, YamlMap):
        if not node.entries:
            sink.report(EMPTY_OVERRIDE.at(node.span, field=field))
        for entry in node:
            if entry.name not in WORDS or shape.is_plain:
                refuse_empty(entry.value, shape.under(entry.name), sink, entry.name)


class _Patch:
    """One patch over one tree; what is wrong with it is reported where it stands, and the tree left as it was there."""

    def __init__(self, sink: Diagnostics, missing: DeletedNames, whole: YamlMap) -> None:
        """`whole` is the module, where a name may be that is missed in one of its sections."""
        self._sink = sink
        self._missing = missing
        self._whole = whole

    def map(self, base: YamlMap, patch: YamlMap, shape: Shape, field: str) -> YamlMap:
        """Return an object or a map of names as its patch leaves it."""
        base, patch = long_object(base, shape), long_object(patch, shape)
        base = with_tags_as_patched(base, patch, shape)
        entries = dict(base.entries)
        changes: list[Change] = []
        missing: list[YamlEntry] = []
        for change in patch:
            name, value = change.name, change.value
            if shape.has_names and name not in base.entries and not shape.is_raw(name):
                missing.append(change)
            elif _is_written_null(value):
                self._delete(entries, change)
                changes.append(Change(name, value.span))
            elif is_said(value) and not isinstance(entries.get(name, change).value, YamlFault):
                old = entries.get(name)
                new = self._node(old.value if old else None, value, shape.under(name), name)
                is_merged = old is not None and isinstance(old.value, YamlMap) and isinstance(new, YamlMap)
                replaced = None if old is None or is_merged or not is_said(old.value) else old
                entries[name] = YamlEntry(old.key if old else change.key, new, replaced)
                # What was patched by its keys or by position keeps in itself what changed.
                is_whole = not isinstance(new, YamlList) or isinstance(value, YamlList)
                if is_whole and not is_merged and not new.span.changes:
                    changes.append(Change(name, value.span))
        # An entry whose name is at fault may be any of them.
        if missing and not any("$(" in name for name in base.entries):
            for change in missing:
                self._tell_missing(change, base, shape)
        chosen = [name for name in CHOICES.get(shape.title, ()) if is_said(patch.get(name))]
        for rival in CHOICES.get(shape.title, ()) if chosen else ():
            if rival not in chosen:
                entries.pop(rival, None)
        return YamlMap(entries, TracedSpan.overridden(base.span, tuple(changes)))

    def _node(self, base: YamlNode | None, patch: YamlNode, shape: Shape, field: str) -> YamlNode:
        """Return what stands under a key as its patch leaves it; None for a key that says nothing so far."""
        said = base if base is not None and is_said(base) else None
        if isinstance(patch, YamlMap) and shape.item and any(entry.name.isdecimal() for entry in patch):
            return self._by_position(said, patch, shape, field)
        if isinstance(patch, YamlMap) and lists_objects(shape):
            return self._list_of_one(said, patch, shape, field)
        # A list takes the place of what was there, also where a map of names might stand.
        new = patch if isinstance(patch, YamlList) and shape.has_names else long_form(patch, shape)
        old = None if said is None else long_form(said, shape)
        if isinstance(new, YamlMap) and not shape.is_plain:
            # Entries of a map that is not there are not there either, which is to be told.
            return self.map(old if isinstance(old, YamlMap) else YamlMap({}, new.span), new, shape, field)
        if isinstance(new, YamlMap) and isinstance(old, YamlMap):
            return self.map(old, new, shape, field)
        if old is not None and _is_same(*(_plain(one, field, shape) for one in (old, new))):
            self._sink.report(SAME_AS_BEFORE.at(patch.span, field=field))
        return new

    def _list_of_one(self, base: YamlNode | None, patch: YamlMap, shape: Shape, field: str) -> YamlNode:
        assert shape.item, "asked of lists only"
        items = _items(base, shape)
        if len(items) > 1:
            self._sink.report(PATCH_OF_SEVERAL.at(patch.span, field=field, length=len(items)))
            return base or patch
        old = items[0] if items and isinstance(items[0], YamlMap) else YamlMap({}, patch.span)
        return YamlList((self.map(old, patch, shape.item, field),), patch.span)

    def _by_position(self, base: YamlNode | None, patch: YamlMap, shape: Shape, field: str) -> YamlNode:
        """Return a list with the items patched that a map names by position, counted before any is deleted."""
        assert shape.item, "asked of lists only"
        items: list[YamlNode | None] = list(_items(base, shape))
        changes: list[Change] = []
        length = f"{len(items)} item" if len(items) == 1 else f"{len(items)} items"
        for change in patch:
            if not change.name.isdecimal():
                self._report(POSITIONS_AND_KEYS, change, field=field)
            elif int(change.name[:9]) >= len(items):
                self._report(NO_SUCH_POSITION, change, field=field, length=length)
            elif _is_written_null(change.value):
                items[int(change.name)] = None
                changes.append(Change(change.name, change.value.span))
            elif is_said(change.value):
                place = int(change.name)
                items[place] = self._node(items[place], change.value, shape.item, field)
        span = TracedSpan.overridden(base.span if base else patch.span, tuple(changes))
        return YamlList(tuple(item for item in items if item is not None), span)

    def _delete(self, entries: dict[str, YamlEntry], change: YamlEntry) -> None:
        if change.name in entries:
            del entries[change.name]
        else:
            self._sink.report(NOTHING_TO_DELETE.at(change.key.span, field=change.name))

    def _tell_missing(self, change: YamlEntry, base: YamlMap, shape: Shape) -> None:
        """Report an entry that is not there; silent where its own name is at fault."""
        name = change.name
        if "$(" in name:
            return
        way = _way(name, base, shape)
        if way and isinstance(change.value, YamlFault):
            return  # its fault says how the way is written
        if name in _names(self._whole, "mount") and shape is shapes().under("joints"):
            self._report(MOUNT_IS_NO_JOINT, change)
            return
        notes = self._missing.notes(name)
        hint = "" if notes else way or self._hint(name, base, shape)
        near = () if notes or hint else base.entries
        self._report(NOTHING_TO_OVERRIDE, change, near=near, notes=notes, owner=shape.things, hint=hint)

    def _hint(self, name: str, base: YamlMap, shape: Shape) -> str:
        """Return where a missing name is, or which names there are, where none of them is like it."""
        for section in _SECTIONS if any(shape is shapes().under(section) for section in _SECTIONS) else ():
            if name in _names(self._whole, section):
                return f"; write '{section}: {{{name}: …}}', for it is one of the {shapes().under(section).things}"
        if not 0 < len(base.entries) <= _SHOWN_NAMES or nearest(name, base.entries):
            return ""
        names = [f"'{other}'" for other in base.entries]
        return f"; there {'is' if len(names) == 1 else 'are'} {alternatives(names, 'and')}"

    def _report(
        self,
        code: Code,
        change: YamlEntry,
        *,
        near: Mapping[str, object] | tuple[()] = (),
        notes: list[Note] | None = None,
        **facts: object,
    ) -> None:
        self._sink.report(code.at(change.key.span, near=near, notes=notes or (), name=change.name, **facts))


def _items(base: YamlNode | None, shape: Shape) -> tuple[YamlNode, ...]:
    """Return the items of a list, or what stands for a list of one."""
    # A list of names counts as written, also where a map of them may stand.
    whole = base if base is None or isinstance(base, YamlList) else long_form(base, shape)
    return whole.items if isinstance(whole, YamlList) else ()


_SECTIONS = ("links", "joints", "modules", "mount", "materials", "sensors", "transmissions", "ros2_control")
_SEMANTIC_SECTIONS = ("groups", "virtual_joints", "end_effectors")


def _deleted(before: YamlMap, after: YamlMap, patch: YamlMap, sections: tuple[str, ...]) -> Iterator[tuple[str, Note]]:
    """Yield the names that sections have before and not after, each with the place in the patch that deletes it."""
    for section in sections:
        said, left = before.get(section), _names(after, section)
        for entry in said if isinstance(said, YamlMap) else ():
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
    """Return where a patch deletes an entry, or the whole section; None where it does neither."""
    whole = patch.entries.get(section)
    said = whole.value.entries.get(name) if whole and isinstance(whole.value, YamlMap) else whole
    return said.key.span if said and _is_written_null(said.value) else None


def _is_written_null(node: YamlNode) -> bool:
    return isinstance(node, YamlScalar) and node.value is None and bool(node.text)


def _plain(node: YamlNode, field: str, shape: Shape) -> YamlNode:
    """Return a node in the form in which two that mean the same are equal: an axis in numbers, numbers in SI units.

    A quantity of another dimension than a number without unit has here stays one, and equals no number; so it does
    where that depends on what is around it, as a joint's velocity does on the joint's type.
    """
    if shape.is_free_part or (shape.is_text and field != "axis"):
        return node
    match node:
        case YamlScalar(text=text) if field == "axis" and text.lstrip("-") in _AXES:
            sign = -1 if text.startswith("-") else 1
            numbers = tuple(sign * number for number in _AXES[text.lstrip("-")])
            return YamlList(tuple(YamlScalar(str(number), number, node.span) for number in numbers), node.span)
        case YamlScalar(value=str() as value) if quantity := parse_quantity(value):
            return _plain(YamlScalar(node.text, quantity, node.span), field, shape)
        case YamlScalar(value=Quantity(value=value, dimension=dimension)) if dimension.si_unit == shape.unit:
            return YamlScalar(node.text, value, node.span)
        case YamlList():
            return YamlList(tuple(_plain(item, field, shape.item or shape) for item in node), node.span)
    return node


def _is_same(one: YamlNode, other: YamlNode) -> bool:
    match one, other:
        case YamlScalar(), YamlScalar():
            return one.value == other.value and isinstance(one.value, bool) == isinstance(other.value, bool)
        case YamlList(), YamlList():
            return len(one) == len(other) and all(map(_is_same, one, other))
        case YamlMap(), YamlMap():
            return one.entries.keys() == other.entries.keys() and all(
                _is_same(entry.value, other.entries[entry.name].value) for entry in one
            )
    return False


# What goes with a link


def _without_links(tree: YamlMap, links: set[str]) -> YamlMap:
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
        about = tuple(block for block in blocks if _text(block, "reference") not in gone)
        sections["gazebo"] = YamlEntry(sections["gazebo"].key, YamlList(about, gazebo.span))
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


def _way(name: str, base: YamlMap, shape: Shape) -> str:
    """Return how a name is written that is the way into an entry: `elbow/limits`; "" for any other."""
    from linkforge_compile.schema.words import nested, split_path

    first, *steps = split_path(name)
    is_way = steps and first in base.entries and steps[0] in shape.under(first).keys
    return f"; write '{nested([first, *steps], '…')}'" if is_way else ""


def _names(tree: YamlMap, section: str) -> Mapping[str, object]:
    said = tree.get(section)
    return said.entries if isinstance(said, YamlMap) else {}


def _text(node: YamlNode, key: str) -> str | None:
    said = node.child(key)
    return said.text if isinstance(said, YamlScalar) else None
