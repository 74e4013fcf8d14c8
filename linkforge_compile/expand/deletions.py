"""What an override deletes: names with the notes that explain them, and what goes with deleted links."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import CHANGE_OF_DELETED, DELETED_POSE
from linkforge_compile.diagnostics.entry_fixes import add_entry
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.diagnostics.grouping import join_names
from linkforge_compile.expand.override import SECTIONS, deletes
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.nodes import leaves_in
from linkforge_compile.units import Quantity, parse_quantity

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
    deleted = ((section, entry) for section in sections for entry in before.section(section).values())
    joints_below: defaultdict[str | None, list[str]] = defaultdict(list)
    for joint in after.section("joints").values():
        joints_below[_ends_of(joint)[1]].append(joint.name)
    for section, entry in deleted:
        if entry.name in after.section(section):
            continue
        child, parent = _ends_of(entry) if section in ("joints", "mount") else (None, None)
        if where := _deletion(patch, section, entry.name):
            way_out = _way_out(joints_below[entry.name]) if section == "links" else ""
            yield entry.name, Note(f"'{entry.name}' is deleted by this override{way_out}", where)
        elif child and (where := _deletion(patch, "links", child)):
            yield entry.name, Note(f"to delete link '{child}' deletes '{entry.name}', the joint to it", where)
        elif parent and (where := _deletion(patch, "links", parent)):
            yield entry.name, Note(f"to delete the root '{parent}' deletes '{entry.name}', the joint from it", where)
        else:
            yield entry.name, Note(f"'{entry.name}' is deleted by this override", patch.span)


def _way_out(names: list[str]) -> str:
    """Return what to write for the joints below a deleted link, "" for none."""
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


def report_lost(before: YamlMap, after: YamlMap, patch: YamlMap, sink: Diagnostics) -> None:
    """Report what `without_links` deletes against the intent of the author: changes of a joint, and its pose.

    The trees are those before and after it.
    """
    for section in ("joints", "mount"):
        left, changes = after.section(section), patch.section(section)
        for joint in before.section(section).values():
            if joint.name in left:
                continue
            child, parent = _ends_of(joint)
            is_to_child = child not in after.section("links")
            link = (child if is_to_child else parent) or ""
            where = _deletion(patch, "links", link) or patch.span
            if change := changes.get(joint.name):
                notes = [Note(f"'{link}' is deleted by this override", where)]
                way_out = "" if is_to_child else "; an 'origin' where the module is used moves the module"
                facts = {"name": joint.name, "link": link, "way_out": way_out}
                sink.report(CHANGE_OF_DELETED.at(change.key.span, notes=notes, **facts))
            elif not is_to_child and (origin := joint.value.child("origin")) and _is_moved(origin):
                notes = [Note("the pose is written here", origin.span)]
                sink.report(DELETED_POSE.at(where, name=joint.name, notes=notes).with_fix(_deleting(patch, joint.name)))


def _deleting(patch: YamlMap, joint: str) -> Fix | None:
    """Return the fix that deletes a joint in an override that deletes its link."""
    entry, ref = f"{joint}: null", SourceRef(patch)
    section = add_entry(ref, "joints", entry=entry)
    return section or add_entry(ref, entry=f"joints: {{{entry}}}", after="links")


def _is_moved(origin: YamlNode) -> bool:
    """Whether any number of a pose is not 0."""
    values = (leaf.value for leaf in leaves_in(origin) if isinstance(leaf, YamlScalar))
    quantities = (parse_quantity(value) if isinstance(value, str) else value for value in values)
    return any(value.value if isinstance(value, Quantity) else value for value in quantities)


def without_links(tree: YamlMap, links: set[str]) -> YamlMap:
    """Return a tree without what refers to deleted links: joints to them, Gazebo blocks, collision pairs, spheres.

    If they are all that is above a link, its fixed joint goes too, and it is the root.
    """
    if not links:
        return tree
    gone, joint_to_root = set(links), _joint_to_new_root(tree, links)
    for name in ("joints", "mount"):
        joints = tree.get(name)
        if isinstance(joints, YamlMap):
            kept = joints.only(lambda joint: _ends_of(joint)[0] not in links).without(joint_to_root)
            gone |= joints.entries.keys() - kept.entries.keys()
            tree = tree.with_value(name, kept)
    gazebo, semantic = tree.get("gazebo"), tree.get("semantic")
    if isinstance(gazebo, YamlList | YamlMap):
        blocks = gazebo.items if isinstance(gazebo, YamlList) else (gazebo,)
        left = (one for one in blocks if not (isinstance(one, YamlMap) and one.text("reference") in gone))
        tree = tree.with_value("gazebo", YamlList(tuple(left), gazebo.span))
    if not isinstance(semantic, YamlMap):
        return tree
    for name in ("disabled_collisions", "enabled_collisions", "link_sphere_approximations"):
        part = semantic.get(name)
        if isinstance(part, YamlMap):
            # The values of pairs are maps of links; those of spheres have other keys.
            of_others = part.without(*links)
            is_pairs = name != "link_sphere_approximations"
            others = of_others.mapped(lambda one: _without_names(one.value, links)) if is_pairs else of_others
            semantic = semantic.with_value(name, others)
    return tree.with_value("semantic", semantic)


def _joint_to_new_root(tree: YamlMap, deleted: set[str]) -> str:
    """Return the fixed joint that alone leads down to the others from deleted links with nothing above them.

    Otherwise "", which is the name of none.
    """
    above = {child: parent or "" for key in ("joints", "mount") for child, parent in map(_ends_of, _joints(tree, key))}

    known: dict[str | None, bool] = {None: True}

    def is_below_root(link: str | None) -> bool:
        path: list[str | None] = []
        while link not in known:
            known[link] = False  # of a link that is kept, and of those in a cycle
            path.append(link)
            link = above.get(link) if link in deleted else link
        known.update(dict.fromkeys(path, known[link]))
        return known[link]

    below = [(joint, *_ends_of(joint)) for joint in _joints(tree, "joints")]
    found = [
        one for one, child, parent in below if child not in deleted and parent in deleted and is_below_root(parent)
    ]
    return found[0].name if len(found) == 1 and _text_of(found[0], "type") == "fixed" else ""


def _joints(tree: YamlMap, section: str) -> Collection[YamlEntry]:
    return tree.section(section).values()


def _without_names(node: YamlNode, names: set[str]) -> YamlNode:
    return node.only(lambda entry: entry.name not in names) if isinstance(node, YamlMap) else node


def _ends_of(joint: YamlEntry) -> tuple[str | None, str | None]:
    """Return the child and the parent of a joint, None for one that is not written."""
    return _text_of(joint, "child"), _text_of(joint, "parent")


def _text_of(entry: YamlEntry, key: str) -> str | None:
    return entry.value.text(key) if isinstance(entry.value, YamlMap) else None
