"""Convert short forms to long ones: objects, lists of one, maps of names, and frames, which are links and joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkforge_compile.schema.shapes import Shape
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

_CHOICES: Mapping[str, tuple[str, ...]] = {
    "a visual": GEOMETRIES,
    "a collision": GEOMETRIES,
    "an inertial": ("mass", "density"),
}
"""By the title of an object, keys that exclude each other."""


def is_set(node: YamlNode | None) -> bool:
    """Whether a node exists and is not null."""
    return node is not None and not (isinstance(node, YamlScalar) and node.value is None)


def excluded_keys(node: YamlMap, shape: Shape) -> tuple[str, ...]:
    """Return the keys that what is set in an object excludes: the other shapes of a visual with a box."""
    choices = _CHOICES.get(shape.title, ())
    excluded = tuple(name for name in choices if not is_set(node.get(name)))
    return excluded if len(excluded) < len(choices) else ()


def lists_objects(shape: Shape) -> bool:
    """Whether a list of objects may be written at a place, so that a single object is a list of one."""
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
        return YamlMap({}, node.span).with_value(SHORT_FORMS[shape.title], node)
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
    links, joints, left = dict(tree.section("links")), dict(tree.section("joints")), {}
    for entry in frames:
        joint = _joint_of(entry)
        if joint is None or entry.name in links or joint.name in joints:
            left[entry.name] = entry
        else:
            links[entry.name] = YamlEntry(entry.key, YamlMap({}, entry.key.span))
            joints[joint.name] = joint
    made = tree.without("frames")
    for name, entries in (("links", links), ("joints", joints), ("frames", left)):
        section = tree.get(name)
        if entries and not isinstance(section, YamlFault):
            made = made.with_value(name, YamlMap(entries, section.span if section else frames.span))
    return made


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
    joint = YamlMap({}, fields.span).with_value("type", YamlScalar("fixed", "fixed", frame.key.span))
    kept = {name: entry for name in ("parent", "origin") if (entry := fields.entries.get(name))}
    return YamlEntry(key, YamlMap({**joint.entries, **kept}, fields.span).with_value("child", frame.key))


def _with_copied_collision(link: YamlMap) -> YamlMap:
    """Return a link with the shapes of its visuals in place of `collision: visual`."""
    visual = link.get("visual")
    if visual is None or link.text("collision") != "visual":
        return link
    visuals = visual if isinstance(visual, YamlList) else YamlList((visual,), visual.span)
    look = {"origin", *GEOMETRIES}
    copied = tuple(one.only(lambda part: part.name in look) if isinstance(one, YamlMap) else one for one in visuals)
    return link.with_value("collision", YamlList(copied, link.entries["collision"].value.span))


def _with_listed_chain(group: YamlMap) -> YamlMap:
    """Return a group with its `chain` as the first of its `chains`."""
    chain, chains = group.entries.get("chain"), group.get("chains")
    if chain is None:
        return group
    listed = chain.value
    if isinstance(chains, YamlList):
        first = listed.items if isinstance(listed, YamlList) else (listed,)
        listed = YamlList((*first, *chains), listed.span)
    return group.without("chain", "chains").with_value("chains", listed)


_OBJECTS: Mapping[str, Callable[[YamlMap], YamlMap]] = {
    "a link": _with_copied_collision,
    "a group": _with_listed_chain,
}
"""By the title of an object, what `long_object` does with it."""
