"""Elements of SRDF that a spec has as a translation of their XML: the entry to write instead."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.schema.shapes import shown
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode

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

LIST_SECTIONS = {"passive_joints": "name", "no_default_collision_links": "link"}
"""Sections that are lists, and the attribute of an element that is the item."""

_BY_NAME = {"virtual_joints", "groups", "end_effectors"}
"""Sections whose entries are under the names of elements."""

_IDENTIFIERS = {"name", "link", "link1", "joint_name"}
"""Attributes of which each element of SRDF has one."""

_LONGEST = 60
"""Characters of the value of an entry that a message shows in full."""

_Read: TypeAlias = Callable[[str, YamlNode | None], str]
"""Returns the text of an attribute by its name and its value, None for an absent one."""


def srdf_section_of(tag: str) -> str:
    """Return the section of `semantic` for a tag of SRDF, "" for any other key."""
    return _SECTIONS.get(tag, "")


def srdf_hint(owner: str, entry: YamlEntry) -> str:
    """Return what to write for a tag of SRDF and its element or elements, "" for other owners, keys and values."""
    section = srdf_section_of(entry.name)
    elements = _elements(entry.value) if owner == "a semantic part" and section else ()
    if not elements:
        return ""
    inner = _shown_entry(section, elements[0]) + (", …" if len(elements) > 1 else "")
    return f"write '{section}: [{inner}]'" if section in LIST_SECTIONS else f"write '{section}: {{{inner}}}'"


def srdf_entry(section: str | int, value: YamlNode) -> str:
    """Return the entry of a section for an element of SRDF, or for the first of a list: `arm: {home: {elbow: 0}}`.

    An absent attribute is its name in capitals. "" for any other value, and for sections whose entries are under the
    names of elements.
    """
    is_other = section in _SECTIONS.values() and section not in _BY_NAME and section not in LIST_SECTIONS
    elements = _elements(value) if is_other else ()
    return _shown_entry(str(section), elements[0]) if elements else ""


def srdf_entries(section: str, value: YamlNode) -> Sequence[str]:
    """Return the entries, or the items, of a section for an element of SRDF or a list of them.

    () for elements that lack an attribute or have it twice, and for what is not written on one line.
    """
    maps = _elements(value)
    is_whole = not isinstance(value, YamlList) or len(maps) == len(value)
    if not is_whole or any(entry.value.span.text is None for each in maps for entry in each):
        return ()
    inner: dict[str, dict[str, str]] = {}
    try:
        for each in maps:
            first, second, text = _steps(section, each, _written)
            if second in inner.setdefault(first, {}):
                return ()
            inner[first][second] = text
    except KeyError:
        return ()
    return [_entry(first, each) for first, each in inner.items()]


def _elements(value: YamlNode) -> Sequence[YamlMap]:
    """Return the maps with an attribute that identifies an element, of a list or one alone; () for other values."""
    elements = [*value] if isinstance(value, YamlList) else [value]
    maps = [each for each in elements if isinstance(each, YamlMap)]
    is_element = maps and maps[0] is elements[0] and not maps[0].entries.keys().isdisjoint(_IDENTIFIERS)
    return maps if is_element else ()


def _written(name: str, value: YamlNode | None) -> str:
    """Return an attribute as it is written; raise KeyError for an absent one."""
    if value is None:
        raise KeyError(name)
    return value.span.text or ""


def _shown(name: str, value: YamlNode | None) -> str:
    """Return an attribute as messages show it; an absent one is its name in capitals."""
    return name.upper() if value is None else shown(value)


def _shown_entry(section: str, element: YamlMap) -> str:
    first, second, text = _steps(section, element, _shown)
    return _entry(first, {second: text if len(text) <= _LONGEST else f"{text[0]}…{text[-1]}"})


def _entry(first: str, inner: Mapping[str, str]) -> str:
    """Return the entry, or the item, of a key with the texts under its second keys."""
    text = inner[""] if "" in inner else f"{{{', '.join(f'{second}: {value}' for second, value in inner.items())}}}"
    return f"{first}: {text}" if text else first


def _steps(section: str, element: YamlMap, read: _Read) -> tuple[str, str, str]:
    """Return the two keys of an element in its section, and what is under them, "" for none of them."""

    def of(name: str) -> str:
        return read(name, element.get(name))

    match section:
        case "group_states":
            return of("group"), of("name"), _state(element.get("joint") or element.get("joints"), read)
        case "disabled_collisions" | "enabled_collisions":
            return of("link1"), of("link2"), of("reason") if element.get("reason") else "User"
        case "joint_properties":
            return of("joint_name"), of("property_name"), of("value")
        case "link_sphere_approximations":
            spheres = of("sphere")
            return of("link"), "", spheres if spheres.startswith("[") else f"[{spheres}]"
    if section in LIST_SECTIONS:
        return of(LIST_SECTIONS[section]), "", ""
    rest = [f"{entry.name}: {read(entry.name, entry.value)}" for entry in element if entry.name != "name"]
    return of("name"), "", f"{{{', '.join(rest)}}}"


def _state(joints: YamlNode | None, read: _Read) -> str:
    """Return the positions of a state by joint."""
    items = [*joints] if isinstance(joints, YamlList) else [joints]
    positions = []
    for item in items:
        if isinstance(item, YamlMap) and item.get("name") is None:
            positions += [f"{read('joint', entry.key)}: {read('position', entry.value)}" for entry in item]
        else:
            name, value = (item.get("name"), item.get("value")) if isinstance(item, YamlMap) else (None, None)
            positions.append(f"{read('joint', name)}: {read('position', value)}")
    return f"{{{', '.join(positions)}}}"
