"""The joints of planning groups, as MoveIt reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down, walk_up
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import Chain, PlanningGroup, VirtualJointType


def actuated_joints(robot: Robot) -> tuple[Joint, ...]:
    """Return the joints with one position that no other joint moves."""
    return tuple(joint for joint in robot.joints if joint.type in SINGLE_AXIS and not joint.mimic)


def joints_by_group(robot: Robot) -> dict[str, tuple[Joint, ...]]:
    """Return the actuated joints of each planning group, from the root to the tips."""
    actuated = frozenset(joint.name for joint in actuated_joints(robot))
    by_group = _all_joints_by_group(robot)
    return {name: tuple(joint for joint in joints if joint.name in actuated) for name, joints in by_group.items()}


def chain_groups(robot: Robot) -> frozenset[str]:
    """Return the names of the groups that are one chain of joints with one position each, as KDL's solver requires.

    As in MoveIt, fixed joints and those that mimic others are members, and between two members are only fixed joints.
    """
    if not robot.has_semantic:
        return frozenset()
    groups, above = {group.name: group for group in robot.semantic.groups}, _Above.each_link(robot)
    moving = {virtual.name for virtual in robot.semantic.virtual_joints if virtual.type != VirtualJointType.FIXED}
    actuated = frozenset(joint.name for joint in actuated_joints(robot))
    return frozenset(
        name
        for name, joints in _all_joints_by_group(robot).items()
        if not actuated.isdisjoint(joint.name for joint in joints)
        and all(joint.type in (*SINGLE_AXIS, JointType.FIXED) for joint in joints)
        and all(_precedes(upper, lower, above) for upper, lower in pairwise(joints))
        and moving.isdisjoint(_names(name, groups, above, ()))
    )


class _Above(NamedTuple):
    """The joint above each link, and the link above that one, by the name of the link."""

    joints: Mapping[str, Joint]
    links: Mapping[str, str]

    @classmethod
    def each_link(cls, robot: Robot) -> _Above:
        joints = parent_joints(robot.joints)
        return cls(joints, {child: joint.parent for child, joint in joints.items()})


def _precedes(upper: Joint, lower: Joint, above: _Above) -> bool:
    """Whether a joint is above another one, with only fixed joints between them."""
    between = (above.joints[link] for link in walk_up(lower.parent, above.links) if link in above.joints)
    return next((joint for joint in between if joint is upper or joint.type is not JointType.FIXED), None) is upper


def _all_joints_by_group(robot: Robot) -> dict[str, tuple[Joint, ...]]:
    """Return the joints of each planning group, with fixed ones and those that mimic others, the root's first."""
    if not robot.has_semantic:
        return {}
    groups = {group.name: group for group in robot.semantic.groups}
    above = _Above.each_link(robot)
    roots = [link.name for link in robot.links if link.name not in above.joints]
    places = {joint.name: place for place, joint in enumerate(walk_down(roots, child_joints(robot.joints)))}
    by_group = {}
    for name in groups:
        members = frozenset(_names(name, groups, above, ()))
        joints = (joint for joint in robot.joints if joint.name in members)
        by_group[name] = tuple(sorted(joints, key=lambda joint: places.get(joint.name, len(places))))
    return by_group


def faulty_groups(robot: Robot) -> frozenset[str]:
    """Return the planning groups that name a part which the robot does not have; checks have reported the name."""
    groups = {group.name: group for group in robot.semantic.groups} if robot.has_semantic else {}
    links = frozenset(link.name for link in robot.links)

    def is_faulty(group: PlanningGroup) -> bool:
        ends = (link for chain in group.chains for link in (chain.base_link, chain.tip_link))
        return not (
            links.issuperset((*group.links, *ends))
            and all(map(robot.has_joint, group.joints))
            and groups.keys() >= set(group.subgroups)
        )

    faulty = {name for name, group in groups.items() if is_faulty(group)}
    found = 0
    while faulty and found < len(faulty):
        found = len(faulty)
        faulty.update(name for name, group in groups.items() if not faulty.isdisjoint(group.subgroups))
    return frozenset(faulty)


def _names(name: str, groups: Mapping[str, PlanningGroup], above: _Above, around: tuple[str, ...]) -> Iterator[str]:
    """Yield the names of the joints of a group; a group that contains itself adds nothing."""
    group = groups.get(name)
    if group is None or name in around:
        return
    yield from group.joints
    yield from (above.joints[link].name for link in group.links if link in above.joints)
    for chain in group.chains:
        yield from _between(chain, above)
    for subgroup in group.subgroups:
        yield from _names(subgroup, groups, above, (*around, name))


def _between(chain: Chain, above: _Above) -> Iterator[str]:
    """Yield the joints from one link to another.

    Unless the chain leads down from its base link, MoveIt adds the joint above the link where both ways up meet.
    """
    up, down = (list(walk_up(link, above.links)) for link in (chain.base_link, chain.tip_link))
    meeting = next((link for link in up if link in down), None)
    shared = set(up) & set(down) - {meeting if meeting != chain.base_link else None}
    yield from (above.joints[link].name for link in (*up, *down) if link not in shared and link in above.joints)
