"""Short forms made long, so that `defaults` and `override` meet one shape of each thing however it was written."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkforge_compile.schema.shapes import Shape
from linkforge_compile.source import Span
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
"""The key that stands for a whole object where its value is written in the object's place, by the object's title."""

GEOMETRIES = ("box", "cylinder", "sphere", "capsule", "mesh")

CHOICES: Mapping[str, tuple[str, ...]] = {
    "a visual": GEOMETRIES,
    "a collision": GEOMETRIES,
    "an inertial": ("mass", "density"),
}
"""Keys of which an object says one: to write one takes the others away."""


def is_said(node: YamlNode | None) -> bool:
    """Whether anything is written at a node that may be absent or null."""
    return node is not None and not (isinstance(node, YamlScalar) and node.value is None)


def lists_objects(shape: Shape) -> bool:
    """Whether a list of objects may stand at a place, so that one object means a list of one."""
    return shape.item is not None and shape.item.is_object and not shape.has_names


def long_form(node: YamlNode, shape: Shape) -> YamlNode:
    """Return a node with its own short form made long; what is in it stays as it is.

    One object where a list may stand is a list of one, `origin: [..]` is `{xyz: [..]}`, a list of names where a map
    of them may stand is a map of empty entries.
    """
    if not is_said(node) or isinstance(node, YamlFault):
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
    """Return an object without the short forms of which only all of it can tell the meaning, such as a copy."""
    return _OBJECTS[shape.title](node) if shape.title in _OBJECTS else node


def with_frames_as_joints(tree: YamlMap) -> YamlMap:
    """Return a file's tree with each frame turned into its link and its fixed joint, behind the file's own.

    A frame that is at fault, or has the name of something else, stays: it is told of as a frame. So does a section
    that is at fault, and is lost as a whole: what is missing for that is told once.
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
    """Return the entry of a frame's joint, None where the frame is no map or has no parent."""
    said = frame.value
    if not isinstance(said, YamlMap) or not isinstance(said.get("parent"), YamlScalar):
        return None
    named = said.get("joint")
    if named is None:
        key = YamlScalar(f"{frame.name}_joint", f"{frame.name}_joint", frame.key.span)
    elif isinstance(named, YamlScalar):
        key = named
    else:
        return None
    ends = {name: entry for name in ("parent", "origin") if (entry := said.entries.get(name))}
    fields = {"type": _word("type", "fixed", frame.key.span), **ends, "child": _entry("child", frame.key)}
    return YamlEntry(key, YamlMap(fields, said.span))


def _with_copied_collision(link: YamlMap) -> YamlMap:
    """Return a link with `collision: visual` as the shapes that it means."""
    collision, visual = link.entries.get("collision"), link.get("visual")
    if not (collision and visual and isinstance(collision.value, YamlScalar) and collision.value.text == "visual"):
        return link
    shapes = visual if isinstance(visual, YamlList) else YamlList((visual,), visual.span)
    copied = YamlList(tuple(_shape_alone(shape) for shape in shapes), collision.value.span)
    return YamlMap({**link.entries, "collision": YamlEntry(collision.key, copied)}, link.span)


def _shape_alone(visual: YamlNode) -> YamlNode:
    if not isinstance(visual, YamlMap):
        return visual
    kept = {name: entry for name, entry in visual.entries.items() if name in {"origin", *GEOMETRIES}}
    return YamlMap(kept, visual.span)


def _with_listed_chain(group: YamlMap) -> YamlMap:
    """Return a group with its `chain` as its `chains`, or the first of them."""
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
"""Makes an object's parts long that refer to its other parts, by its title."""


def _section(tree: YamlMap, name: str) -> dict[str, YamlEntry]:
    section = tree.get(name)
    return dict(section.entries) if isinstance(section, YamlMap) else {}


def _entry(name: str, value: YamlNode) -> YamlEntry:
    return YamlEntry(YamlScalar(name, name, value.span), value)


def _word(name: str, word: str, where: Span) -> YamlEntry:
    return _entry(name, YamlScalar(word, word, where))
