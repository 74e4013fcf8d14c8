"""`defaults`: what the links, joints and sensors of one file have where they say nothing themselves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.repetition import REPEATED_DEFAULT
from linkforge_compile.diagnostics.codes.schema import WRONG_KIND
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.module_entry import found
from linkforge_compile.expand.normal_form import CHOICES, is_said, long_form, long_object
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null

if TYPE_CHECKING:
    from linkforge_compile.expand.evaluate_tree import TreeEvaluator

_SECTIONS: Mapping[str, str] = {"links": "link", "joints": "joint", "sensors": "sensor"}
"""The default for the entries of each section."""

_OF_MOTION = ("axis", "limits", "dynamics", "mimic", "safety_controller", "calibration")

_NOT_FOR: Mapping[str, tuple[str, ...]] = {
    "fixed": _OF_MOTION,
    "floating": _OF_MOTION,
    "planar": _OF_MOTION[1:],
}
"""What a joint of a type does not get: it may not have it, or has no one motion that its units could be of."""


def defaults_of(file: YamlMap, tree: TreeEvaluator) -> YamlMap | None:
    """Return the defaults of a file that has some, computed; None where they are no map."""
    written = file.get("defaults")
    assert written is not None, "the file has some"
    filling = tree.part(_without_repetition(written, tree.sink), shapes().under("defaults"), "defaults")
    if filling is None or isinstance(filling, YamlMap):
        return filling
    if not (isinstance(filling, YamlFault) or is_null(filling)):
        tree.sink.report(WRONG_KIND.at(filling.span, field="'defaults'", expected="a map", found=found(filling)))
    return None


def _without_repetition(defaults: YamlNode, sink: Diagnostics) -> YamlNode:
    """Return `defaults` as written without any `for`, each of which is reported."""
    shape = shapes().under("defaults")
    for key in _keys_of_for(defaults, shape):
        sink.report(REPEATED_DEFAULT.at(key.span))
    return _without_for(defaults, shape) if any(_keys_of_for(defaults, shape)) else defaults


def with_defaults(tree: YamlMap, defaults: YamlMap) -> YamlMap:
    """Return a file's tree with its computed defaults in every link, joint and sensor; both are left as they are.

    An entry's own word goes first: maps merge, a list is as the entry has it, one of a choice leaves the others out.
    """
    sections = dict(tree.entries)
    for name, kind in _SECTIONS.items():
        section, default = tree.get(name), defaults.get(kind) or _misspelt(kind, defaults)
        if isinstance(section, YamlMap) and isinstance(default, YamlMap):
            shape = shapes().under(name)
            sections[name] = YamlEntry(sections[name].key, _filled(section, default, shape))
    links = sections["links"].value if "links" in sections else None
    if isinstance(links, YamlMap):
        sections["links"] = YamlEntry(sections["links"].key, _with_shapes_filled(links, defaults))
    return YamlMap(sections, tree.span)


def _misspelt(kind: str, defaults: YamlMap) -> YamlMap | None:
    """Return what is left of the defaults of a kind where its key is at fault: just that, for each entry to know."""
    lost = {one.name: one for one in defaults if isinstance(one.value, YamlFault) and nearest(one.name, [kind])}
    return YamlMap(lost, defaults.span) if lost else None


def _filled(section: YamlMap, default: YamlMap, shape: Shape) -> YamlMap:
    entries = {}
    for entry in section:
        said = entry.value if is_said(entry.value) else YamlMap({}, entry.key.span)
        if isinstance(said, YamlMap):
            said = over(_fit(default, said, shape), said, shape.under(entry.name))
        entries[entry.name] = YamlEntry(entry.key, said)
    return YamlMap(entries, section.span)


def _fit(default: YamlMap, entry: YamlMap, section: Shape) -> YamlMap:
    """Return of a default what an entry may have."""
    left_out: tuple[str, ...] = ()
    kind = entry.get("type") or default.get("type")
    if section is shapes().under("joints") and isinstance(kind, YamlScalar):
        left_out = _NOT_FOR.get(kind.text, ())
    if section is shapes().under("links"):
        left_out = tuple(_needing_shapes(default, entry))
    return YamlMap({name: one for name, one in default.entries.items() if name not in left_out}, default.span)


def _needing_shapes(default: YamlMap, link: YamlMap) -> Iterator[str]:
    """Yield what a default cannot give to a link without visual and collision: a copy, and an inertial to compute."""
    visual = link.get("visual") or default.get("visual")
    collision, inertial = default.get("collision"), default.get("inertial")
    copies = isinstance(collision, YamlScalar)
    if visual is None and copies:
        yield "collision"
    bare = visual is None and (link.get("collision") or (None if copies else collision)) is None
    if bare and isinstance(inertial, YamlMap) and inertial.get("inertia") is None and link.get("inertial") is None:
        yield "inertial"


def _with_shapes_filled(links: YamlMap, defaults: YamlMap) -> YamlMap:
    """Return the links with the defaults of visuals and collisions in each that is written."""
    made = {}
    for entry in links:
        link = entry.value
        for key in ("visual", "collision"):
            shape = shapes().under("links").under(entry.name).under(key)
            default, said = defaults.get(key), link.get(key) if isinstance(link, YamlMap) else None
            if isinstance(default, YamlMap) and isinstance(link, YamlMap) and isinstance(said, YamlScalar):
                # A copy of the visuals takes the default of collisions as if it were written out.
                link = long_object(link, shapes().under("links").under(entry.name))
                said = link.get(key)
            if isinstance(default, YamlMap) and isinstance(link, YamlMap) and isinstance(said, YamlMap | YamlList):
                filled = _each_filled(said, default, shape)
                link = YamlMap({**link.entries, key: YamlEntry(link.entries[key].key, filled)}, link.span)
        made[entry.name] = YamlEntry(entry.key, link)
    return YamlMap(made, links.span)


def _each_filled(said: YamlMap | YamlList, default: YamlMap, shape: Shape) -> YamlNode:
    item = shape.item or shape
    if isinstance(said, YamlMap):
        return over(default, said, item)
    return YamlList(tuple(over(default, one, item) if isinstance(one, YamlMap) else one for one in said), said.span)


def over(default: YamlNode, said: YamlNode, shape: Shape) -> YamlNode:
    """Return what is said with the default in its gaps."""
    if not is_said(said):
        return default
    if isinstance(said, YamlList) and shape.item:
        return said
    below, above = long_form(default, shape), long_form(said, shape)
    if shape.item and isinstance(below, YamlList) and isinstance(above, YamlList) and len(below) == len(above) == 1:
        return YamlList((over(below.items[0], above.items[0], shape.item),), said.span)
    if not isinstance(below, YamlMap) or not isinstance(above, YamlMap):
        return said
    chosen = [name for name in CHOICES.get(shape.title, ()) if is_said(above.get(name))]
    rivals = CHOICES.get(shape.title, ()) if chosen else ()
    entries = dict(above.entries)
    for entry in below:
        if not is_said(above.get(entry.name)):
            if entry.name not in rivals:
                entries[entry.name] = entry
        else:
            own = above.entries[entry.name]
            value = over(entry.value, own.value, shape.under(entry.name))
            is_merged = isinstance(value, YamlMap) and isinstance(entry.value, YamlMap)
            entries[entry.name] = YamlEntry(own.key, value, None if is_merged else entry)
    lost = {one.name: one.value for one in below if isinstance(one.value, YamlFault)}
    return YamlMap({one.name: _knowing(lost, one) for one in entries.values()} if lost else entries, above.span)


def _knowing(lost: Mapping[str, YamlFault], entry: YamlEntry) -> YamlEntry:
    """Return an entry with the faulty defaults in its map that may have been for it: what it lacks is in those."""
    if not isinstance(entry.value, YamlMap):
        return entry
    ours = {name: value for name, value in lost.items() if entry.name in value.keys or nearest(name, [entry.name])}
    faults = {name: YamlEntry(YamlScalar(name, name, value.span), value) for name, value in ours.items()}
    return YamlEntry(entry.key, YamlMap({**entry.value.entries, **faults}, entry.value.span), entry.replaced)


def _keys_of_for(node: YamlNode, shape: Shape) -> Iterator[YamlScalar]:
    match node:
        case YamlList():
            for item in node:
                yield from _keys_of_for(item, shape.item) if shape.item else ()
        case YamlMap():
            for entry in node:
                if entry.name == "for" and shape.is_object:
                    yield entry.key
                else:
                    yield from _keys_of_for(entry.value, shape.under(entry.name))


def _without_for(node: YamlNode, shape: Shape) -> YamlNode:
    match node:
        case YamlList() if shape.item:
            item = shape.item
            return YamlList(tuple(_without_for(one, item) for one in node), node.span)
        case YamlMap():
            kept = [entry for entry in node if not (entry.name == "for" and shape.is_object)]
            made = {one.name: YamlEntry(one.key, _without_for(one.value, shape.under(one.name))) for one in kept}
            return YamlMap(made, node.span)
    return node
