"""Links, joints and states that are there under another name, and a robot with its references under the new one."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import NamedTuple, TypeAlias

from linkforge_compile.compare.likeness import likeness
from linkforge_compile.core.fields import Name, Reference, Spec, field_specs
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down
from linkforge_compile.core.models.joint import Joint, JointMimic
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.planning import GroupState
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import Part


class Renames(NamedTuple):
    """The new names of links and joints by the old ones, and those of states by group and old name."""

    links: Mapping[str, str]
    joints: Mapping[str, str]
    states: Mapping[tuple[str, str], str] = {}


def find_renames(before: Robot, after: Robot) -> Renames:
    """Return what is surely the same under another name.

    A link is where exactly one that is new hangs by the same joint on the same link (or that one's new name) and has
    the same body, and no other that is gone has a claim to it; a root where also the same joints hang on it. A joint
    is where it joins the same links in the same way. A state is where exactly one that is new has the same positions in
    the same group.
    """
    links = _renamed_links(before, after)
    ends = {(joint.parent, joint.child): joint for joint in after.joints if joint.name not in before.joints}
    joints = {}
    for joint in before.joints:
        other = ends.get((links.get(joint.parent, joint.parent), links.get(joint.child, joint.child)))
        if joint.name not in after.joints and other and likeness(joint, _NAMES) == likeness(other, _NAMES):
            joints[joint.name] = other.name
    renames = Renames(links, joints)
    held = (under_new_names(state, renames) for state in before.semantic.group_states)
    were = [state for state in held if isinstance(state, GroupState)]
    return renames._replace(states=_renamed_states(were, after.semantic.group_states))


def _renamed_states(before: Iterable[GroupState], after: Iterable[GroupState]) -> dict[tuple[str, str], str]:
    gone, new = _states_alike(before, without=after), _states_alike(after, without=before)
    renamed = ((rivals, new.get(alike, [])) for alike, rivals in gone.items())
    return {rivals[0]: heirs[0][1] for rivals, heirs in renamed if len(rivals) == len(heirs) == 1}


def _states_alike(
    states: Iterable[GroupState], *, without: Iterable[GroupState]
) -> Mapping[Hashable, Sequence[tuple[str, str]]]:
    """Return by what they are, their names aside, the groups and names of the states that the others do not have."""
    others = {(state.group, state.name) for state in without}
    found: dict[Hashable, list[tuple[str, str]]] = {}
    for state in states:
        if (state.group, state.name) not in others:
            found.setdefault(likeness(state, _NAMES), []).append((state.group, state.name))
    return found


_Alike: TypeAlias = dict[Hashable, list[str]]
"""The names of links by how they hang and what their bodies are, all names in it left aside."""


def _renamed_links(before: Robot, after: Robot) -> dict[str, str]:
    renamed: dict[str, str] = {}
    new = _by_parent(after, without=before)
    gone = _by_parent(before, without=after)
    for parent in (None, *_parents_first(before)):
        under = renamed.get(parent, parent) if parent is not None else None
        for alike, rivals in gone.get(parent, {}).items():
            heirs = new.get(under, {}).get(alike, ())
            if len(heirs) == len(rivals) == 1:
                renamed[rivals[0]] = heirs[0]
    return renamed


def _by_parent(robot: Robot, *, without: Robot) -> dict[str | None, _Alike]:
    """Return the links that the other robot does not have, by the names of their parents; None for roots."""
    found: dict[str | None, _Alike] = {}
    for link in robot.links:
        if link.name not in without.links:
            joint = robot.get_parent_joint(link.name)
            alike = likeness((joint or _hanging(robot, link), link), _NAMES)
            found.setdefault(joint.parent if joint else None, {}).setdefault(alike, []).append(link.name)
    return found


def _hanging(robot: Robot, root: Link) -> Sequence[Joint]:
    return tuple(robot.get_child_joints(root.name))


def _parents_first(robot: Robot) -> Iterator[str]:
    """Yield the links from the roots down, without those of a cycle that no root leads to."""
    above = parent_joints(robot.joints)
    roots = [link.name for link in robot.links if link.name not in above]
    yield from roots
    yield from (joint.child for joint in walk_down(roots, child_joints(robot.joints)))


_NAMES: Mapping[type, Collection[str]] = {
    Joint: ("name", "parent", "child"),
    JointMimic: ("joint",),
    Link: ("name",),
    Visual: ("name", "material"),
    Collision: ("name",),
    GroupState: ("name",),
}
"""The fields of links, joints and states that say not what these do, but what they and others are called."""


def under_new_names(value: object, renames: Renames) -> object:
    """Return a value in which every name of a renamed link or joint is the new one."""
    if not any(renames):
        return value
    if isinstance(value, tuple):
        return tuple(under_new_names(one, renames) for one in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    kind = type(value)
    specs = field_specs(kind) if issubclass(kind, Part | Link) else {}
    changes: dict[str, object] = {}
    for field in fields(value):
        held: object = getattr(value, field.name)
        new_names = _new_names(kind, specs.get(field.name), renames)
        new = under_new_names(held, renames) if new_names is None else _renamed(held, new_names)
        if new is not held and new != held:
            changes[field.name] = new
    if isinstance(value, GroupState) and (name := renames.states.get((value.group, value.name))):
        changes["name"] = name
    return replace(value, **changes) if changes else value


def _new_names(kind: type, spec: Spec | None, renames: Renames) -> Mapping[str, str] | None:
    """Return the new names, by the old ones, of what a field names; None for a field without names of these."""
    match spec:
        case Name():
            return {Link: renames.links, Joint: renames.joints}.get(kind)
        case Reference(to="link" | "frame"):
            return renames.links
        case Reference(to="joint"):
            return renames.joints
        case Reference(to="part"):
            return {**renames.joints, **renames.links}
    return None


def _renamed(held: object, new_names: Mapping[str, str]) -> object:
    """Return a name, names, or a mapping by names with the new ones."""
    match held:
        case str():
            return new_names.get(held, held)
        case tuple():
            return tuple(_renamed(name, new_names) for name in held)
        case Mapping():
            return {new_names.get(name, name): value for name, value in held.items()}
    return held
