"""Convert short forms to long ones, so that `defaults` and `override` handle one form of each object."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar

SHORT_FORMS: Mapping[str, str] = {
    "an origin": "xyz",
    "a box": "size",
    "a sphere": "radius",
    "a mesh": "file",
    "a color": "rgba",
    "a module's joint": "name",
    "a collision pair": "reason",
    "a sphere approximation": "spheres",
}
"""By the title of an object, the key whose value may be written in place of the whole object."""

GEOMETRIES = ("box", "cylinder", "sphere", "capsule", "mesh")

CHOICES: Mapping[str, tuple[str, ...]] = {
    "a visual": GEOMETRIES,
    "a collision": GEOMETRIES,
    "an inertial": ("mass", "density"),
}
"""By the title of an object, keys that exclude each other: setting one removes the others."""


def is_set(node: YamlNode | None) -> bool:
    """Whether a node exists and is not null."""
    return node is not None and not (isinstance(node, YamlScalar) and node.value is None)


def lists_objects(shape: Shape) -> bool:
    """Whether a list of objects may be written at a place, so that a single object means a list of one."""
    return shape.item is not None and shape.item.is_object and not shape.has_names


def long_form(node: YamlNode, shape: Shape) -> YamlNode:
    """Return a node in its long form; what is inside of it is not converted.

    A single object in place of a list becomes a list of one, `origin: [..]` becomes `{xyz: [..]}`, and a list of
    names in place of a map becomes a map of empty entries.
    """
    if not is_set(node) or isinstance(node, YamlFault):
        return node
    if isinstance(node, YamlMap):
        return YamlList((node,), node.span) if lists_objects(shape) else node
    if shape.is_object and shape.title in SHORT_FORMS:
        return YamlMap({SHORT_FORMS[shape.title]: _entry(SHORT_FORMS[shape.title], node)}, node.span)
    if shape.has_names and isinstance(node, YamlList):
        names = [item for item in node if isinstance(item, YamlScalar)]
        if len(names) == len(node):
            return YamlMap({name.text: YamlEntry(name, YamlScalar("", None, name.span)) for name in names}, node.span)
    return node


def long_object(node: YamlMap, shape: Shape) -> YamlMap:
    """Return an object without short forms that refer to its other keys, such as `collision: visual`."""
    return _OBJECTS[shape.title](node) if shape.title in _OBJECTS else node


def with_frames_as_joints(tree: YamlMap) -> YamlMap:
    """Return a file's tree with each frame replaced by a link and a fixed joint, after those of the file.

    A faulty frame stays, as does one with the name of another link or joint, so that it is reported as a frame. A
    faulty section stays as well.
    """
    frames = tree.get("frames")
    if not isinstance(frames, YamlMap):
        return tree
    links, joints, left = _section(tree, "links"), _section(tree, "joints"), {}
    for entry in frames:
        joint = _joint_of(entry)
        if joint is None or entry.name in links or joint.name in joints:
            left[entry.name] = entry
        else:
            links[entry.name] = YamlEntry(entry.key, YamlMap({}, entry.key.span))
            joints[joint.name] = joint
    sections = {"links": links, "joints": joints, "frames": left}
    spans = {name: section.span if (section := tree.get(name)) else frames.span for name in sections}
    made = {
        name: _entry(name, YamlMap(entries, spans[name]))
        for name, entries in sections.items()
        if entries and not isinstance(tree.get(name), YamlFault)
    }
    return YamlMap({**{name: entry for name, entry in tree.entries.items() if name != "frames"}, **made}, tree.span)


def _joint_of(frame: YamlEntry) -> YamlEntry | None:
    """Return the joint of a frame as an entry, None if the frame is not a map or has no parent."""
    fields = frame.value
    if not isinstance(fields, YamlMap) or not isinstance(fields.get("parent"), YamlScalar):
        return None
    key = fields.get("joint")
    if key is None:
        key = YamlScalar(f"{frame.name}_joint", f"{frame.name}_joint", frame.key.span)
    if not isinstance(key, YamlScalar):
        return None
    kept = {name: entry for name in ("parent", "origin") if (entry := fields.entries.get(name))}
    type_ = _entry("type", YamlScalar("fixed", "fixed", frame.key.span))
    return YamlEntry(key, YamlMap({"type": type_, **kept, "child": _entry("child", frame.key)}, fields.span))


def _with_copied_collision(link: YamlMap) -> YamlMap:
    """Return a link with the shapes of its visuals in place of `collision: visual`."""
    collision, visual = link.entries.get("collision"), link.get("visual")
    if not (collision and visual and isinstance(collision.value, YamlScalar) and collision.value.text == "visual"):
        return link
    visuals = visual if isinstance(visual, YamlList) else YamlList((visual,), visual.span)
    copied = YamlList(tuple(_without_look(each) for each in visuals), collision.value.span)
    return YamlMap({**link.entries, "collision": YamlEntry(collision.key, copied)}, link.span)


def _without_look(visual: YamlNode) -> YamlNode:
    if not isinstance(visual, YamlMap):
        return visual
    kept = {name: entry for name, entry in visual.entries.items() if name in {"origin", *GEOMETRIES}}
    return YamlMap(kept, visual.span)


def _with_listed_chain(group: YamlMap) -> YamlMap:
    """Return a group with its `chain` as the first of its `chains`."""
    chain, chains = group.entries.get("chain"), group.get("chains")
    if chain is None:
        return group
    listed = chain.value
    if isinstance(chains, YamlList):
        first = listed.items if isinstance(listed, YamlList) else (listed,)
        listed = YamlList((*first, *chains), listed.span)
    kept = {name: entry for name, entry in group.entries.items() if name not in {"chain", "chains"}}
    return YamlMap({"chains": _entry("chains", listed), **kept}, group.span)


_OBJECTS: Mapping[str, Callable[[YamlMap], YamlMap]] = {
    "a link": _with_copied_collision,
    "a group": _with_listed_chain,
}
"""By the title of an object, what `long_object` does with it."""


def _section(tree: YamlMap, name: str) -> dict[str, YamlEntry]:
    section = tree.get(name)
    return dict(section.entries) if isinstance(section, YamlMap) else {}


def _entry(name: str, value: YamlNode) -> YamlEntry:
    return YamlEntry(YamlScalar(name, name, value.span), value)


# Gazebo tags have keys of their own, and an import puts some under `properties` instead.

_GAZEBO_BLOCKS = ("a gazebo block", "a robot's gazebo block")
_PROPERTIES = "properties"


def with_tags_as_patched(block: YamlMap, patch: YamlMap, shape: Shape) -> YamlMap:
    """Return a Gazebo block with each tag that a patch sets where the patch has it, as a key or under `properties`.

    Otherwise the block would have the tag twice. Anything but a Gazebo block is returned unchanged.
    """
    if shape.title not in _GAZEBO_BLOCKS:
        return block
    entries = dict(block.entries)
    properties, patched = _section(block, _PROPERTIES), _section(patch, _PROPERTIES)
    keys = {_gazebo_tag(name): name for name in entries if _is_tag_key(shape, name)}
    for name in patch.entries:
        if _is_tag_key(shape, name) and (moved := properties.pop(_gazebo_tag(name), None)):
            entries[name] = YamlEntry(YamlScalar(name, name, moved.key.span), moved.value)
    for tag in patched.keys() & keys.keys():
        moved = entries.pop(keys[tag])
        properties[tag] = YamlEntry(YamlScalar(tag, tag, moved.key.span), moved.value)
    return YamlMap(_with_properties(entries, properties, block), block.span)


def _with_properties(
    entries: dict[str, YamlEntry], properties: dict[str, YamlEntry], block: YamlMap
) -> dict[str, YamlEntry]:
    section = block.entries.get(_PROPERTIES)
    if section is not None and not isinstance(section.value, YamlMap):
        return entries
    others = {name: entry for name, entry in entries.items() if name != _PROPERTIES}
    if not properties:
        return others
    key = section.key if section else YamlScalar(_PROPERTIES, _PROPERTIES, block.span)
    span = section.value.span if section else block.span
    return {**others, _PROPERTIES: YamlEntry(key, YamlMap(properties, span))}


def _is_tag_key(shape: Shape, name: str) -> bool:
    return name != _PROPERTIES and shape.under(name) is not FREE


def _gazebo_tag(key: str) -> str:
    """Return the tag of a key, which has capitals in place of underscores: `max_vel` is `maxVel`."""
    return re.sub(r"_([a-z])", lambda found: found[1].upper(), key)
