"""What an override deletes: names with the notes that explain them, and what goes with deleted links."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.grouping import join_names
from linkforge_compile.expand.override import SECTIONS, deletes, names_in_section
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

_SEMANTIC_SECTIONS = ("groups", "virtual_joints", "end_effectors")


def deleted_names(before: YamlMap, after: YamlMap, patch: YamlMap) -> Iterator[tuple[str, Note]]:
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
            child, parent = (
                _text(entry.value, end) if section in ("joints", "mount") else None for end in ("child", "parent")
            )
            if where := _deletion(patch, section, entry.name):
                way_out = _way_out(entry.name, after) if section == "links" else ""
                yield entry.name, Note(f"'{entry.name}' is deleted by this override{way_out}", where)
            elif child and (where := _deletion(patch, "links", child)):
                yield entry.name, Note(f"to delete link '{child}' deletes '{entry.name}', the joint to it", where)
            elif parent and (where := _deletion(patch, "links", parent)):
                yield (
                    entry.name,
                    Note(f"to delete the root '{parent}' deletes '{entry.name}', the joint from it", where),
                )
            else:
                yield entry.name, Note(f"'{entry.name}' is deleted by this override", patch.span)


def _way_out(link: str, after: YamlMap) -> str:
    """Return what to write for the joints that hang on a deleted link, "" for none."""
    names = [name for name, entry in names_in_section(after, "joints").items() if _text(entry.value, "parent") == link]
    if not names:
        return ""
    delete, reattach = (f"joints: {{{names[0]}: {change}}}" for change in ("null", "{parent: …}"))
    joints = f"joint{'s' if len(names) > 1 else ''} {join_names(names)}"
    return f", and {joints} below it {'are' if len(names) > 1 else 'is'} not; write '{delete}' or '{reattach}' as well"


def _deletion(patch: YamlMap, section: str, name: str) -> Span | None:
    """Return where a patch deletes an entry or its whole section, None if it does not."""
    whole = patch.entries.get(section)
    deletion = whole.value.entries.get(name) if whole and isinstance(whole.value, YamlMap) else whole
    return deletion.key.span if deletion and deletes(deletion.value) else None


def without_links(tree: YamlMap, links: set[str]) -> YamlMap:
    """Return a tree without what refers to deleted links: joints to them, Gazebo blocks, collision pairs, spheres.

    If they are all that is above a link, its fixed joint goes too, and it is the root.
    """
    if not links:
        return tree
    sections = dict(tree.entries)
    gazebo, semantic = tree.get("gazebo"), tree.get("semantic")
    gone = set(links)
    joint_to_root = _joint_to_new_root(tree, links)
    for name in ("joints", "mount"):
        if isinstance(joints := tree.get(name), YamlMap):
            kept = [
                entry for entry in joints if _text(entry.value, "child") not in links and entry.name != joint_to_root
            ]
            gone |= joints.entries.keys() - {entry.name for entry in kept}
            sections[name] = YamlEntry(sections[name].key, _map_of(kept, joints.span))
    if isinstance(gazebo, YamlList | YamlMap):
        blocks = gazebo.items if isinstance(gazebo, YamlList) else (gazebo,)
        left = tuple(block for block in blocks if _text(block, "reference") not in gone)
        sections["gazebo"] = YamlEntry(sections["gazebo"].key, YamlList(left, gazebo.span))
    if isinstance(semantic, YamlMap):
        sections["semantic"] = YamlEntry(sections["semantic"].key, _semantic_without(semantic, links))
    return YamlMap(sections, tree.span)


def _joint_to_new_root(tree: YamlMap, deleted: set[str]) -> str | None:
    """Return the fixed joint that alone joins deleted links to the others, if it leads down from the deleted ones."""
    joints = [*names_in_section(tree, "joints").values(), *names_in_section(tree, "mount").values()]
    ends = [(_text(joint.value, "parent"), _text(joint.value, "child")) for joint in joints]
    between = [
        joint for joint, (parent, child) in zip(joints, ends, strict=True) if (parent in deleted) != (child in deleted)
    ]
    if len(between) != 1 or _text(between[0].value, "parent") not in deleted:
        return None
    return between[0].name if _text(between[0].value, "type") == "fixed" else None


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


def _text(node: YamlNode, key: str) -> str | None:
    value = node.child(key)
    return value.text if isinstance(value, YamlScalar) else None
