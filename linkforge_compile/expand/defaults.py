"""Merge the `defaults` of a file into its links, joints and sensors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkforge_compile.diagnostics.codes.modules import REPEATED_DEFAULT
from linkforge_compile.diagnostics.codes.schema import WRONG_KIND
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.expand_tree import expand_part
from linkforge_compile.expand.long_forms import excluded_keys, is_set, long_form, long_object
from linkforge_compile.expand.values import describe_node
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null

_SECTIONS: Mapping[str, str] = {"links": "link", "joints": "joint", "sensors": "sensor"}
"""By section, the key of `defaults` for its entries."""

_MOTION_KEYS = ("axis", "limits", "dynamics", "mimic", "safety_controller", "calibration")

_KEYS_NOT_FOR: Mapping[str, tuple[str, ...]] = {
    "fixed": _MOTION_KEYS,
    "floating": _MOTION_KEYS,
    "planar": _MOTION_KEYS[1:],
}
"""By joint type, the defaults that it does not get: it may not have them, or has no single motion for their units."""


def compute_defaults(file: YamlMap, evaluator: Evaluator) -> YamlMap | None:
    """Return the computed `defaults` of a file that has some; None after a reported error."""
    section, shape = file.entries["defaults"].value, shapes().under("defaults")
    keys: list[YamlScalar] = []
    section = _without_for(section, shape, keys)
    evaluator.sink.report_all(REPEATED_DEFAULT.at(key.span) for key in keys)
    computed = expand_part(section, evaluator, shape, "defaults")
    if computed is None or isinstance(computed, YamlMap):
        return computed
    if not (isinstance(computed, YamlFault) or is_null(computed)):
        found = describe_node(computed)
        evaluator.sink.report(WRONG_KIND.at(computed.span, field="'defaults'", expected="a map", found=found))
    return None


def with_defaults(tree: YamlMap, defaults: YamlMap) -> YamlMap:
    """Return a file's tree with its computed defaults merged into every link, joint and sensor.

    An entry's own value overrides the default: maps are merged, lists are not, and a key that excludes others removes
    their defaults.
    """
    for name, kind in _SECTIONS.items():
        section, default = tree.get(name), defaults.get(kind) or _faulty_default(kind, defaults)
        if isinstance(section, YamlMap) and isinstance(default, YamlMap):
            tree = tree.with_value(name, _merge_section(section, default, shapes().under(name)))
    links = tree.get("links")
    if isinstance(links, YamlMap):
        tree = tree.with_value("links", links.mapped(lambda link: _with_shape_defaults(link, defaults)))
    return tree


def _faulty_default(kind: str, defaults: YamlMap) -> YamlMap | None:
    """Return the faulty defaults whose keys look like a kind, as its default, so that entries know of them."""
    faulty = defaults.only(lambda one: isinstance(one.value, YamlFault) and nearest(one.name, [kind]) is not None)
    return faulty if len(faulty) else None


def _merge_section(section: YamlMap, default: YamlMap, shape: Shape) -> YamlMap:
    def merged(entry: YamlEntry) -> YamlNode:
        value = entry.value if is_set(entry.value) else YamlMap({}, entry.key.span)
        if not isinstance(value, YamlMap):
            return value
        return merge(_applicable(default, value, shape), value, shape.under(entry.name))

    return section.mapped(merged)


def _applicable(default: YamlMap, entry: YamlMap, section: Shape) -> YamlMap:
    """Return the part of a default that an entry may have."""
    kind = entry.get("type") or default.get("type")
    if section is shapes().under("joints") and isinstance(kind, YamlScalar):
        return default.without(*_KEYS_NOT_FOR.get(kind.text, ()))
    if section is shapes().under("links"):
        return default.without(*_keys_needing_shapes(default, entry))
    return default


def _keys_needing_shapes(default: YamlMap, link: YamlMap) -> Iterator[str]:
    """Yield defaults that a link without shapes cannot have: a copy of visuals, and an inertial to compute."""
    visual = link.get("visual") or default.get("visual")
    collision, inertial = default.get("collision"), default.get("inertial")
    is_copy = isinstance(collision, YamlScalar)
    if visual is None and is_copy:
        yield "collision"
    has_shapes = visual is not None or (link.get("collision") or (None if is_copy else collision)) is not None
    is_computed = isinstance(inertial, YamlMap) and inertial.get("inertia") is None
    if not has_shapes and is_computed and link.get("inertial") is None:
        yield "inertial"


def _with_shape_defaults(entry: YamlEntry, defaults: YamlMap) -> YamlNode:
    """Return a link with the defaults of visuals and collisions in each that it has."""
    link, link_shape = entry.value, shapes().under("links").under(entry.name)
    for key in ("visual", "collision"):
        default = defaults.get(key)
        if not isinstance(link, YamlMap) or not isinstance(default, YamlMap):
            continue
        if isinstance(link.get(key), YamlScalar):
            link = long_object(link, link_shape)  # the copies of `collision: visual` get the default of collisions
        value = link.get(key)
        if isinstance(value, YamlMap | YamlList):
            link = link.with_value(key, _merge_each(value, default, link_shape.under(key)))
    return link


def _merge_each(value: YamlMap | YamlList, default: YamlMap, shape: Shape) -> YamlNode:
    item = shape.item or shape
    if isinstance(value, YamlMap):
        return merge(default, value, item)
    return YamlList(tuple(merge(default, one, item) if isinstance(one, YamlMap) else one for one in value), value.span)


def merge(default: YamlNode, value: YamlNode, shape: Shape) -> YamlNode:
    """Return a value with the default for what it leaves out."""
    if not is_set(value):
        return default
    if isinstance(value, YamlList) and shape.item:
        return value
    below, above = long_form(default, shape), long_form(value, shape)
    if shape.item and isinstance(below, YamlList) and isinstance(above, YamlList) and len(below) == len(above) == 1:
        return YamlList((merge(below.items[0], above.items[0], shape.item),), value.span)
    if not isinstance(below, YamlMap) or not isinstance(above, YamlMap):
        return value
    excluded = excluded_keys(above, shape)
    entries = dict(above.entries)
    for entry in below:
        if is_set(above.get(entry.name)):
            own = above.entries[entry.name]
            merged = merge(entry.value, own.value, shape.under(entry.name))
            is_merged = isinstance(merged, YamlMap) and isinstance(entry.value, YamlMap)
            entries[entry.name] = YamlEntry(own.key, merged, None if is_merged else entry)
        elif entry.name not in excluded:
            entries[entry.name] = entry
    faults = {one.name: one.value for one in below if isinstance(one.value, YamlFault)}
    return YamlMap({one.name: _with_faults(faults, one) for one in entries.values()} if faults else entries, above.span)


def _with_faults(faults: Mapping[str, YamlFault], entry: YamlEntry) -> YamlEntry:
    """Return an entry with the faulty defaults that may belong into its map, which excuse what it lacks."""
    if not isinstance(entry.value, YamlMap):
        return entry
    ours = {name: value for name, value in faults.items() if entry.name in value.keys or nearest(name, [entry.name])}
    added = {name: YamlEntry(YamlScalar(name, name, value.span), value) for name, value in ours.items()}
    return YamlEntry(entry.key, YamlMap({**entry.value.entries, **added}, entry.value.span), entry.replaced)


def _without_for(node: YamlNode, shape: Shape, found: list[YamlScalar]) -> YamlNode:
    """Return a node without the `for` of objects, whose keys are added to `found`."""
    match node:
        case YamlList() if shape.item:
            item = shape.item
            return YamlList(tuple(_without_for(one, item, found) for one in node), node.span)
        case YamlMap():
            if shape.is_object and "for" in node.entries:
                found.append(node.entries["for"].key)
                node = node.without("for")
            return node.mapped(lambda one: _without_for(one.value, shape.under(one.name), found))
    return node
