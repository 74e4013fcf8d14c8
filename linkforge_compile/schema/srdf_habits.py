"""Elements of SRDF that a spec has as a translation of their XML: the entry to write instead."""

from __future__ import annotations

from linkforge_compile.schema.shapes import shown
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

_SECTIONS = {
    # tag of SRDF, section of `semantic`
    "virtual_joint": "virtual_joints",
    "group": "groups",
    "group_state": "group_states",
    "end_effector": "end_effectors",
    "passive_joint": "passive_joints",
    "disable_collisions": "disabled_collisions",
    "enable_collisions": "enabled_collisions",
    "disable_default_collisions": "no_default_collision_links",
    "joint_property": "joint_properties",
    "link_sphere_approximation": "link_sphere_approximations",
}

_ENTRIES = {
    # section of `semantic` whose entries are not under the names of elements, its entry for their attributes
    "group_states": "{group}: {{{name}: {{{joint}}}}}",
    "disabled_collisions": "{link1}: {{{link2}: {reason}}}",
    "enabled_collisions": "{link1}: {{{link2}: {reason}}}",
    "joint_properties": "{joint_name}: {{{property_name}: {value}}}",
    "link_sphere_approximations": "{link}: […]",
}

_ITEMS = {"passive_joints": "name", "no_default_collision_links": "link"}
"""Sections that are lists, and the attribute of an element that is the item."""

_IDENTIFIERS = {"name", "link", "link1", "joint_name"}
"""Attributes of which each element of SRDF has one."""


class _Attributes(dict[str, str]):
    """The attributes of an element; an absent one is its name in capitals."""

    def __missing__(self, name: str) -> str:
        return name.upper()


def srdf_entry(section: str | int, value: YamlNode) -> str:
    """Return the entry of a section for an element of SRDF, or for the first of a list: `arm: {home: {elbow: 0}}`.

    "" for any other value, and for sections whose entries are under the names of elements.
    """
    form, element = _ENTRIES.get(str(section)), _element(value)
    return form.format_map(_attributes(element)) if form and element else ""


def srdf_hint(owner: str, entry: YamlEntry) -> str:
    """Return what to write for a tag of SRDF and its element or elements, "" for other owners, keys and values."""
    section, element = _SECTIONS.get(entry.name), _element(entry.value)
    if owner != "a semantic part" or section is None or element is None:
        return ""
    attributes = _attributes(element)
    if attribute := _ITEMS.get(section):
        return f"write '{section}: [{attributes[attribute]}]'"
    return f"write '{section}: {{{srdf_entry(section, element) or '{name}: …'.format_map(attributes)}}}'"


def _element(value: YamlNode) -> YamlMap | None:
    """Return a map with an attribute that identifies an element, or the first one of a list."""
    first = next(iter(value), None) if isinstance(value, YamlList) else value
    is_element = isinstance(first, YamlMap) and not first.entries.keys().isdisjoint(_IDENTIFIERS)
    return first if is_element and isinstance(first, YamlMap) else None


def _attributes(element: YamlMap) -> _Attributes:
    own = _Attributes((entry.name, shown(entry.value)) for entry in element if isinstance(entry.value, YamlScalar))
    own.setdefault("reason", "User")
    own["joint"] = _positions(element.get("joint") or element.get("joints"))
    return own


def _positions(joints: YamlNode | None) -> str:
    """Return the first joint of a state with its position."""
    first = next(iter(joints), None) if isinstance(joints, YamlList) else joints
    if not isinstance(first, YamlMap) or not first.entries:
        return "JOINT: POSITION"
    name, value = first.get("name"), first.get("value")
    if name is None or value is None:
        return ", ".join(f"{entry.name}: {shown(entry.value)}" for entry in first)
    more = ", …" if isinstance(joints, YamlList) and len(joints) > 1 else ""
    return f"{shown(name)}: {shown(value)}{more}"
