"""Match the parts of two robots: those that were renamed, and the members of lists."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from itertools import groupby
from typing import NamedTuple, TypeAlias

from linkforge_compile.compare.fields import RawElement, match_key, specs_of
from linkforge_compile.core.fields import Name, Reference, Spec, key_fields
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down
from linkforge_compile.core.models.joint import Joint, JointMimic
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import Chain, GroupState
from linkforge_compile.core.models.srdf_collisions import CollisionPair, SrdfSphere
from linkforge_compile.core.part import Element, Inside


class Renames(NamedTuple):
    """The new names of links and joints by the old ones, and of states by group and old name."""

    links: Mapping[str, str]
    joints: Mapping[str, str]
    states: Mapping[tuple[str, str], str] = {}


class RemovedName(NamedTuple):
    """A public name that a newer robot lacks; `now` is the new name of the same part, None if there is none."""

    kind: str
    name: str
    now: str | None


class _PublicName(NamedTuple):
    """A name that launch files, controllers and programs may use; `kind` is what it names."""

    kind: str
    name: str


class RemovedPart(NamedTuple):
    """Removed names in one line: that of a part with its new name, or the interfaces of one owner."""

    kind: str
    text: str


_INTERFACE = " interface"


def removed_parts(removed: Iterable[RemovedName]) -> Iterator[RemovedPart]:
    """Yield the kind and name of each removed name, and the interfaces of a joint together."""
    for (kind, owner, now), names in groupby(removed, key=_owner):
        text = owner + (f", now {now}" if now else "")
        if kind.endswith(_INTERFACE):
            interfaces = [name.name.rpartition("/")[2] for name in names]
            text = f"{owner}: {', '.join(interfaces)}" + (f", now of {now}" if now else "")
        yield RemovedPart(kind, text)


def _owner(name: RemovedName) -> tuple[str, str, str | None]:
    if not name.kind.endswith(_INTERFACE):
        return name.kind, name.name, name.now
    return name.kind, name.name.rpartition("/")[0], name.now.rpartition("/")[0] if name.now else None


def removed_public_names(before: Robot, after: Robot, *, semantic: bool = True) -> tuple[RemovedName, ...]:
    """Return the public names of a robot that a newer one lacks, in the order of the robot before.

    Public are the names of links, joints, sensors and their topics, of hardware and its interfaces and, if
    `semantic`, of groups, their states and end effectors.
    """
    renames = find_renames(before, after)
    present = frozenset(_public_names(after, semantic=semantic))
    removed = [name for name in dict.fromkeys(_public_names(before, semantic=semantic)) if name not in present]
    return tuple(RemovedName(*name, _new_name(name, renames, present)) for name in removed)


def _new_name(name: _PublicName, renames: Renames, present: Collection[_PublicName]) -> str | None:
    if name.kind == "link":
        return renames.links.get(name.name)
    if name.kind == "group state":
        states = {f"{group}/{was}": f"{group}/{now}" for (group, was), now in renames.states.items()}
        return states.get(name.name)
    if name.kind not in ("joint", "command interface", "state interface"):
        return None
    owner, slash, interface = name.name.rpartition("/")
    joint = renames.joints.get(owner if slash else name.name)
    new = _PublicName(name.kind, f"{joint}/{interface}" if slash else f"{joint}")
    return new.name if new in present else None


def _public_names(robot: Robot, *, semantic: bool) -> Iterator[_PublicName]:
    yield from (_PublicName("link", link.name) for link in robot.links)
    yield from (_PublicName("joint", joint.name) for joint in robot.joints)
    for sensor in robot.sensors:
        yield _PublicName("sensor", sensor.name)
        if sensor.topic:
            yield _PublicName("topic", sensor.topic)
    for hardware in robot.ros2_controls:
        yield _PublicName("hardware", hardware.name)
        for commanded in (*hardware.joints, *hardware.gpios):
            for interface in commanded.command_interfaces:
                yield _PublicName("command interface", f"{commanded.name}/{interface}")
            for interface in commanded.state_interfaces:
                yield _PublicName("state interface", f"{commanded.name}/{interface}")
        for read in hardware.sensors:
            yield from (_PublicName("state interface", f"{read.name}/{one}") for one in read.state_interfaces)
    if semantic:
        yield from (_PublicName("group", group.name) for group in robot.semantic.groups)
        yield from (_PublicName("group state", f"{state.group}/{state.name}") for state in robot.semantic.group_states)
        yield from (_PublicName("end effector", end.name) for end in robot.semantic.end_effectors)


def find_renames(before: Robot, after: Robot) -> Renames:
    """Find the parts that are certainly the same under another name.

    A link is renamed to the only new link that the same joint attaches to the same parent (or to its new name) with
    the same body, if no other removed link matches it; a root needs the same child joints instead. A joint is renamed
    to a new joint that connects the same links in the same way. A state is renamed to the only new state with the same
    positions in the same group.
    """
    links = _find_renamed_links(before, after)
    ends = {(joint.parent, joint.child): joint for joint in after.joints if joint.name not in before.joints}
    joints = {}
    for joint in before.joints:
        other = ends.get((links.get(joint.parent, joint.parent), links.get(joint.child, joint.child)))
        if joint.name not in after.joints and other and match_key(joint, _NAMES) == match_key(other, _NAMES):
            joints[joint.name] = other.name
    renames = Renames(links, joints)
    renamed = (apply_renames(state, renames) for state in before.semantic.group_states)
    states = [state for state in renamed if isinstance(state, GroupState)]
    return renames._replace(states=_find_renamed_states(states, after.semantic.group_states))


def _find_renamed_states(before: Iterable[GroupState], after: Iterable[GroupState]) -> dict[tuple[str, str], str]:
    removed, added = _states_by_match_key(before, without=after), _states_by_match_key(after, without=before)
    pairs = ((old, added.get(key, [])) for key, old in removed.items())
    return {old[0]: new[0][1] for old, new in pairs if len(old) == len(new) == 1}


def _states_by_match_key(
    states: Iterable[GroupState], *, without: Iterable[GroupState]
) -> Mapping[Hashable, Sequence[tuple[str, str]]]:
    """Return the groups and names of the states that the other robot lacks, by their match keys."""
    others = {(state.group, state.name) for state in without}
    found: dict[Hashable, list[tuple[str, str]]] = {}
    for state in states:
        if (state.group, state.name) not in others:
            found.setdefault(match_key(state, _NAMES), []).append((state.group, state.name))
    return found


_LinksByKey: TypeAlias = dict[Hashable, list[str]]
"""Names of links by the match key of the link and the joint above it."""


def _find_renamed_links(before: Robot, after: Robot) -> dict[str, str]:
    renamed: dict[str, str] = {}
    added = _links_by_parent(after, without=before)
    removed = _links_by_parent(before, without=after)
    for parent in (None, *_parents_first(before)):
        new_parent = renamed.get(parent, parent) if parent is not None else None
        for key, old in removed.get(parent, {}).items():
            new = added.get(new_parent, {}).get(key, ())
            if len(new) == len(old) == 1:
                renamed[old[0]] = new[0]
    return renamed


def _links_by_parent(robot: Robot, *, without: Robot) -> dict[str | None, _LinksByKey]:
    """Return the links that the other robot lacks, by the names of their parents; None for roots."""
    found: dict[str | None, _LinksByKey] = {}
    for link in robot.links:
        if link.name not in without.links:
            joint = robot.get_parent_joint(link.name)
            key = match_key((joint or tuple(robot.get_child_joints(link.name)), link), _NAMES)
            found.setdefault(joint.parent if joint else None, {}).setdefault(key, []).append(link.name)
    return found


def _parents_first(robot: Robot) -> Iterator[str]:
    """Yield the links from the roots down, except cycles that no root leads to."""
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
"""Fields of links, joints and states to ignore when looking for the same part under another name."""


def apply_renames(value: object, renames: Renames) -> object:
    """Return a value in which every renamed link, joint and state has its new name."""
    if not any(renames):
        return value
    if isinstance(value, tuple):
        return tuple(apply_renames(item, renames) for item in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    specs = specs_of(type(value))
    changes: dict[str, object] = {}
    for field in fields(value):
        old: object = getattr(value, field.name)
        new_names = _new_names(type(value), specs.get(field.name), renames)
        new = apply_renames(old, renames) if new_names is None else _rename(old, new_names)
        if new is not old and new != old:
            changes[field.name] = new
    if isinstance(value, GroupState) and (name := renames.states.get((value.group, value.name))):
        changes["name"] = name
    return replace(value, **changes) if changes else value


def _new_names(kind: type, spec: Spec | None, renames: Renames) -> Mapping[str, str] | None:
    """Return the new names for a field of a class; None for a field without names of links or joints."""
    match spec:
        case Reference(to="link" | "frame"):
            return renames.links
        case Reference(to="joint"):
            return renames.joints
        case Reference(to="part"):
            return {**renames.joints, **renames.links}
        case Name() if kind is Link:
            return renames.links
        case Name() if kind is Joint:
            return renames.joints
    return None


def _rename(value: object, new_names: Mapping[str, str]) -> object:
    """Return a name, a tuple of names or a mapping by names with the new names."""
    match value:
        case str():
            return new_names.get(value, value)
        case tuple():
            return tuple(_rename(name, new_names) for name in value)
        case Mapping():
            return {new_names.get(name, name): item for name, item in value.items()}
    return value


class Pair(NamedTuple):
    """A member of two lists, None for the list that lacks it; `key` identifies it in a path."""

    key: str
    before: object | None
    after: object | None


def key_of_member(item: object) -> str:
    """Return the name that identifies a member of a list; empty if only the index does."""
    match item:
        case str():
            return str(item)
        case Visual() | Collision() | SrdfSphere():
            return ""
        case GazeboElement():
            return item.reference or "robot"
        case CollisionPair():
            return "/".join(item.key)
        case Chain():
            return f"{item.base_link}/{item.tip_link}"
        case Inside() | RawElement():
            return f"{item.tag}/{item.name}" if item.name else item.tag
        case Element() if fields := key_fields(type(item)):
            return "/".join(str(getattr(item, field)) for field in fields)
    name: str | None = getattr(item, "name", None)
    return name or ""


def pair_members(before: Iterable[object], after: Iterable[object]) -> Iterator[Pair]:
    """Yield the members in the order after, then the removed ones.

    Members with the same key are paired if they are equal, else by name, else by index.
    """
    were, are = _group_by_key(before), _group_by_key(after)
    for key, members in are.items():
        yield from _pairs_of_key(key, were.get(key, {}), members)
    for key, members in were.items():
        if key not in are:
            yield from _pairs_of_key(key, members, {})


def _group_by_key(items: Iterable[object]) -> dict[str, dict[int, object]]:
    """Return the members of each key, by their index among them."""
    found: dict[str, dict[int, object]] = {}
    for item in items:
        members = found.setdefault(key_of_member(item), {})
        members[len(members)] = item
    return found


def _pairs_of_key(key: str, before: Mapping[int, object], after: Mapping[int, object]) -> Iterator[Pair]:
    partners = find_partners(before, after)
    for index, item in after.items():
        yield Pair(_path_key(key, index), before.get(partners.get(index, -1)), item)
    paired = set(partners.values())
    for index, item in before.items():
        if index not in paired:
            yield Pair(_path_key(key, index), item, None)


def _path_key(key: str, index: int) -> str:
    return "/".join((*([key] if key else []), *([str(index)] if index or not key else [])))


def find_partners(before: Mapping[int, object], after: Mapping[int, object]) -> dict[int, int]:
    """Return the indices before by the indices after, for members of the same key."""
    if len(before) == len(after) == 1:
        return {0: 0}
    found: dict[int, int] = {}
    for criterion in _CRITERIA:
        paired = set(found.values())
        free: dict[Hashable, deque[int]] = {}
        for index, item in before.items():
            if index not in paired:
                free.setdefault(criterion(item), deque()).append(index)
        for index, item in after.items():
            if index not in found and (candidates := free.get(criterion(item))):
                found[index] = candidates.popleft()
    return found


def _name_or_identity(item: object) -> Hashable:
    name: str | None = getattr(item, "name", None)
    return id(item) if name is None else name


_CRITERIA: Sequence[Callable[[object], Hashable]] = (match_key, _name_or_identity, lambda _: None)
"""What members must share to be paired, the strictest first."""
