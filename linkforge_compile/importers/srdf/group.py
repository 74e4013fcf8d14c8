"""Planning groups of SRDF, their states and end effectors."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.srdf.known import Known
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode

_NO_JOINTS = frozenset(("extra", "extra_attributes", "extra_inside", "for", "when"))
"""Keys of a state that no joint in it can be named."""


def subgroups_first(groups: Iterable[XmlElement]) -> list[XmlElement]:
    """Return groups so that each comes after those in it, as far as they are no cycle; of one name, as in the file."""
    from graphlib import CycleError, TopologicalSorter

    named: dict[str, list[XmlElement]] = {}
    for group in groups:
        named.setdefault(group.get("name") or "", []).append(group)
    inner: dict[str, Iterable[str]] = {}
    for name, same in named.items():
        parts = (part.get("name") for group in same for part in group.children if part.tag == "group")
        inner[name] = [part for part in parts if part in named][::-1]
    try:
        order: Iterable[str] = tuple(TopologicalSorter(inner).static_order())
    except CycleError:
        from networkx import DiGraph, dfs_postorder_nodes

        order = dfs_postorder_nodes(DiGraph(inner))
    return [group for name in order for group in named[name]]


def read_group(group: ElementReader, known: Known) -> YamlMap:
    """Read a planning group, whose name is taken."""
    chains = group.children("chain", lambda chain: _chain(chain, known))
    links = _members(group, "link", known.link)
    joints = _members(group, "joint", known.joint)
    subgroups = _members(group, "group", known.subgroup)
    if not (chains or links or joints or subgroups):
        raise group.cannot_represent("nothing in it is a member that the robot has")
    return group.map(
        **{"chain" if len(chains) == 1 else "chains": group.draft.one_or_list(chains)},
        links=links,
        joints=joints,
        subgroups=subgroups,
    )


def _chain(chain: ElementReader, known: Known) -> YamlMap:
    return chain.map(base_link=known.link(chain, "base_link"), tip_link=known.link(chain, "tip_link"))


def _members(group: ElementReader, tag: str, name_of: Callable[[ElementReader, str], YamlNode]) -> YamlList | None:
    def read(member: ElementReader) -> YamlNode:
        node = name_of(member, "name")
        member.require_used_up()
        return node

    members = group.children(tag, read)
    return group.draft.list_of(members, members[0].span) if members else None


def read_state(state: ElementReader, known: Known) -> YamlMap:
    """Read a state of a group, both of whose names are taken: positions by joint."""
    positions: dict[str, YamlNode | None] = {}

    def read(joint: ElementReader) -> YamlNode:
        name = known.joint(joint, "name")
        if name.text in positions:
            raise CannotRepresentError(f"joint '{name.text}' has a value already", name.span)
        if name.text in _NO_JOINTS:
            raise CannotRepresentError(f"'{name.text}' is a key of the language", name.span)
        node = _position(joint, known, name.text)
        joint.require_used_up()
        positions[name.text] = node
        return node

    state.children("joint", read)
    return state.map(**positions)


def _position(joint: ElementReader, known: Known, name: str) -> YamlNode:
    """Read a position: one number, or a list of them for several degrees of freedom."""
    count = len((joint.element.get("value") or "").split())
    if count == 1:
        return joint.required_number("value", known.measure(name))
    numbers = joint.numbers("value", count)
    if numbers is None:
        raise joint.cannot_represent("it has no 'value'")
    if not len(numbers):
        raise CannotRepresentError("value is empty", numbers.span)
    return numbers


def read_end_effector(effector: ElementReader, known: Known) -> YamlMap:
    """Read an end effector, whose name is taken."""
    has_parent = bool(effector.element.get("parent_group"))
    return effector.map(
        group=known.group(effector, "group"),
        parent_link=known.link(effector, "parent_link"),
        parent_group=known.group(effector, "parent_group") if has_parent else None,
    )
