"""Elements of SRDF that a spec has as a translation of their XML: the entry to write instead."""

from __future__ import annotations

from collections.abc import Sequence

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

LIST_SECTIONS = {"passive_joints": "name", "no_default_collision_links": "link"}
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
    form, elements = _ENTRIES.get(str(section)), _elements(value)
    return form.format_map(_attributes(elements[0])) if form and elements else ""


def srdf_hint(owner: str, entry: YamlEntry) -> str:
    """Return what to write for a tag of SRDF and its element or elements, "" for other owners, keys and values."""
    section = _SECTIONS.get(entry.name)
    elements = _elements(entry.value) if owner == "a semantic part" and section else ()
    if section is None or not elements:
        return ""
    attributes, more = _attributes(elements[0]), ", …" if len(elements) > 1 else ""
    if attribute := LIST_SECTIONS.get(section):
        return f"write '{section}: [{attributes[attribute]}{more}]'"
    first = srdf_entry(section, entry.value) or "{name}: …".format_map(attributes)
    return f"write '{section}: {{{first}{more}}}'"


def _elements(value: YamlNode) -> Sequence[YamlMap]:
    """Return the maps with an attribute that identifies an element, of a list or one alone; () for other values."""
    elements = [*value] if isinstance(value, YamlList) else [value]
    maps = [each for each in elements if isinstance(each, YamlMap)]
    is_element = maps and maps[0] is elements[0] and not maps[0].entries.keys().isdisjoint(_IDENTIFIERS)
    return maps if is_element else ()


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


def srdf_section_of(tag: str) -> str:
    """Return the section of `semantic` for a tag of SRDF, "" for any other key."""
    return _SECTIONS.get(tag, "")


def srdf_entries(section: str, value: YamlNode) -> Sequence[str]:
    """Return the entries, or the items, of a section for an element of SRDF or a list of them.

    () for elements that lack an attribute or have it twice, and for what is not written on one line.
    """
    maps = _elements(value)
    is_whole = not isinstance(value, YamlList) or len(maps) == len(value)
    if not is_whole or not all(_has_plain_values(each) for each in maps):
        return ()
    try:
        if attribute := LIST_SECTIONS.get(section):
            return [_written(each, attribute) for each in maps]
        return _merged([_steps(section, each) for each in maps])
    except KeyError:
        return ()


def _has_plain_values(element: YamlMap) -> bool:
    return all(entry.value.span.text is not None for entry in element)


def _written(element: YamlMap, attribute: str, default: str = "") -> str:
    """Return the value of an attribute as it is written; raise KeyError without one."""
    value = element.get(attribute)
    if value is None and not default:
        raise KeyError(attribute)
    return default if value is None else value.span.text or ""


def _steps(section: str, element: YamlMap) -> tuple[str, str, str]:
    """Return the two keys of an element in its section, and what is under them; the second is "" for none."""
    match section:
        case "group_states":
            return _written(element, "group"), _written(element, "name"), _state(element)
        case "disabled_collisions" | "enabled_collisions":
            return _written(element, "link1"), _written(element, "link2"), _written(element, "reason", "User")
        case "joint_properties":
            property_name, value = _written(element, "property_name"), _written(element, "value")
            return _written(element, "joint_name"), property_name, value
        case "link_sphere_approximations":
            spheres = _written(element, "sphere")
            return _written(element, "link"), "", spheres if spheres.startswith("[") else f"[{spheres}]"
    rest = [f"{entry.name}: {entry.value.span.text}" for entry in element if entry.name != "name"]
    return _written(element, "name"), "", f"{{{', '.join(rest)}}}"


def _state(element: YamlMap) -> str:
    """Return the positions of a state by joint."""
    joints = element.get("joint") or element.get("joints")
    items = [*joints] if isinstance(joints, YamlList) else [joints]
    if isinstance(joints, YamlMap) and joints.get("name") is None:
        return joints.span.text or ""
    maps = [each for each in items if isinstance(each, YamlMap)]
    if len(maps) < len(items):
        raise KeyError("joint")
    positions = [f"{_written(each, 'name')}: {_written(each, 'value')}" for each in maps]
    return f"{{{', '.join(positions)}}}"


def _merged(steps: Sequence[tuple[str, str, str]]) -> Sequence[str]:
    """Return one entry for each first key; raise KeyError for a key that is there twice."""
    inner: dict[str, dict[str, str]] = {}
    for first, second, value in steps:
        if second in inner.setdefault(first, {}):
            raise KeyError(second)
        inner[first][second] = value
    return [
        f"{first}: {each['']}" if "" in each else f"{first}: {{{', '.join(f'{k}: {v}' for k, v in each.items())}}}"
        for first, each in inner.items()
    ]
