"""A macro of a xacro file as a module: its joint to a link that is not its own becomes the `mount` of the module.

Of several such joints none can be the mount. They stay as they are, with the link above as that of another file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import MACRO_PLACES_ITSELF, MACRO_SETS_FIELD
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET
from linkforge_compile.expand.long_forms import with_frames_as_joints
from linkforge_compile.expand.modules import ModuleEntry
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.macro_roles import ORIGIN
from linkforge_compile.load.xacro import XacroUse
from linkforge_compile.load.xacro_macro import MacroEntry, MacroResult, call_macro
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar


def open_macro(
    use: XacroUse, macro: YamlScalar, entry: ModuleEntry, loader: Loader, sink: Diagnostics
) -> tuple[SpecFile | None, ModuleEntry]:
    """Return what a call of a macro makes, None after a reported error, and the entry with what attaches it."""
    fields = entry.ref.node
    assert isinstance(fields, YamlMap), "it has a key `macro`"
    parent, has_prefix = fields.get("parent"), fields.get("prefix") is not None
    parent = parent if isinstance(parent, YamlScalar) else None
    call = MacroEntry(entry.name, macro, parent, fields.get("origin"), entry.prefix, has_prefix)
    result = call_macro(use, call, loader, sink)
    if result is None:
        return None, entry
    entry = replace(entry, prefix=result.prefix)
    tree, joints = _without_joints_at(result.parent.text, result.spec.tree)
    if result.placed and (origin := fields.get("origin")) is not None:
        tree = _with_placed_joints(result.placed, tree, origin)
    if not joints:
        return replace(result.spec, tree=tree), entry
    if parent is None and not result.is_stand_in:
        fields = fields.with_value("parent", result.parent)
    _report_unused_origin(entry, joints, result, macro, sink)
    if fields.get("parent") is None and (len(joints) > 1 or _own_origin(joints, result)):
        what, note = f"'parent' of module '{entry.name}' has", Note("this joint attaches it", joints[-1].key.span)
        sink.report(PARAMETER_NOT_SET.at(macro.span, what=what, remedy="'parent: LINK'", notes=[note]))
        return None, entry
    if len(joints) > 1:
        tree = _with_joints_at(result.parent, joints, tree, result, fields.get("origin"))
        entry = replace(entry, ref=replace(entry.ref, node=fields), shared_link=result.parent.text)
        return replace(result.spec, tree=tree), entry
    fields = _with_own_origin(fields, joints, result)
    mount = YamlMap({one.name: YamlEntry(one.key, _without_ends(one.value)) for one in joints}, tree.span)
    return replace(result.spec, tree=tree.with_value("mount", mount)), replace(
        entry, ref=replace(entry.ref, node=fields)
    )


def _report_unused_origin(
    entry: ModuleEntry, joints: Sequence[YamlEntry], result: MacroResult, macro: YamlScalar, sink: Diagnostics
) -> None:
    origin = entry.ref.node.get("origin") if isinstance(entry.ref.node, YamlMap) else None
    is_used = bool(result.placed) or (result.placed is None and len(joints) == 1)
    if origin is None or is_used:
        return
    if given := result.origin:
        sink.report(MACRO_SETS_FIELD.at(given.where, field=ORIGIN, name=entry.name, parameter=ORIGIN))
        return
    note = Note("this joint attaches it", joints[0].key.span)
    sink.report(MACRO_PLACES_ITSELF.at(origin.span, macro=macro.text, notes=[note]))


def _with_own_origin(fields: YamlMap, joints: Iterable[YamlEntry], result: MacroResult) -> YamlMap:
    """Return the fields of an entry with the origin that the macro gives its joint, if it is not that of the entry."""
    if all(result.is_placed(one.name) for one in joints):
        return fields
    own = _own_origin(joints, result)
    return fields.with_value("origin", own) if own else fields.without("origin")


def _own_origin(joints: Iterable[YamlEntry], result: MacroResult) -> YamlNode | None:
    """Return the origin of the first joint that does not have that of the entry."""
    own = next((one.value for one in joints if not result.is_placed(one.name)), None)
    return own.get("origin") if isinstance(own, YamlMap) else None


def _with_placed_joints(names: frozenset[str], tree: YamlMap, origin: YamlNode) -> YamlMap:
    """Return the tree of a robot in which some of its joints have another origin."""
    if not names <= tree.section("joints").keys():
        # An empty link with a fixed joint was read as a frame.
        tree = with_frames_as_joints(tree)
    joints = tree.section("joints").values()
    placed = (one._replace(value=_with_origin(one, origin)) if one.name in names else one for one in joints)
    return tree.with_value("joints", _section(placed, tree)) if joints else tree


def _with_joints_at(
    parent: YamlScalar, joints: Iterable[YamlEntry], tree: YamlMap, result: MacroResult, origin: YamlNode | None
) -> YamlMap:
    """Return the tree of a robot with joints at a link, which is added; the entry's origin is that of some joints."""
    placed = (one._replace(value=_with_origin(one, origin)) if result.is_placed(one.name) else one for one in joints)
    link = YamlEntry(parent, YamlMap({}, parent.span))
    links = _section([link, *tree.section("links").values()], tree)
    return tree.with_value("links", links).with_value(
        "joints", _section([*placed, *tree.section("joints").values()], tree)
    )


def _with_origin(joint: YamlEntry, origin: YamlNode | None) -> YamlNode:
    if not isinstance(joint.value, YamlMap):
        return joint.value
    return joint.value.with_value("origin", origin) if origin else joint.value.without("origin")


def _without_joints_at(parent: str, tree: YamlMap) -> tuple[YamlMap, list[YamlEntry]]:
    """Return the tree of a robot without the joints to a link that is not its own, and these."""
    if parent in tree.section("links"):
        return tree, []
    # An empty link with a fixed joint was read as a frame.
    tree, frames = _without_entries_at(parent, "frames", tree)
    if frames:
        others = tree.get("frames")
        one_way = with_frames_as_joints(tree.with_value("frames", _section(frames, tree)))
        tree = one_way.with_value("frames", others) if others else one_way
    return _without_entries_at(parent, "joints", tree)


def _without_entries_at(parent: str, section: str, tree: YamlMap) -> tuple[YamlMap, list[YamlEntry]]:
    entries = [*tree.section(section).values()]
    found = [one for one in entries if isinstance(one.value, YamlMap) and one.value.text("parent") == parent]
    left = [one for one in entries if one not in found]
    if not found:
        return tree, []
    return (tree.with_value(section, _section(left, tree)) if left else tree.without(section)), found


def _section(entries: Iterable[YamlEntry], tree: YamlMap) -> YamlMap:
    return YamlMap({one.name: one for one in entries}, tree.span)


def _without_ends(joint: YamlNode) -> YamlNode:
    return joint.without("parent", "origin") if isinstance(joint, YamlMap) else joint
