"""The joints of planning groups, as MoveIt reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down, walk_up
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.formats.single_axis import SINGLE

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.srdf import Chain, PlanningGroup


def actuated_joints(robot: Robot) -> tuple[Joint, ...]:
    """Return the joints with one position that no other joint moves."""
    return tuple(joint for joint in robot.joints if joint.type in SINGLE and not joint.mimic)


def joints_by_group(robot: Robot) -> dict[str, tuple[Joint, ...]]:
    """Return the actuated joints of each planning group, from the root to the tips."""
    if not robot.has_semantic:
        return {}
    groups = {group.name: group for group in robot.semantic.groups}
    parents, actuated = parent_joints(robot.joints), actuated_joints(robot)
    roots = [link.name for link in robot.links if link.name not in parents]
    places = {joint.name: place for place, joint in enumerate(walk_down(roots, child_joints(robot.joints)))}
    by_group = {}
    for name in groups:
        members = frozenset(_names(name, groups, parents, ()))
        joints = (joint for joint in actuated if joint.name in members)
        by_group[name] = tuple(sorted(joints, key=lambda joint: places.get(joint.name, len(places))))
    return by_group


def _names(
    name: str, groups: Mapping[str, PlanningGroup], parents: Mapping[str, Joint], around: tuple[str, ...]
) -> Iterator[str]:
    """Yield the names of the joints of a group; a group that contains itself adds nothing."""
    group = groups.get(name)
    if group is None or name in around:
        return
    yield from group.joints
    yield from (parents[link].name for link in group.links if link in parents)
    for chain in group.chains:
        yield from _between(chain, parents)
    for subgroup in group.subgroups:
        yield from _names(subgroup, groups, parents, (*around, name))


def _between(chain: Chain, parents: Mapping[str, Joint]) -> Iterator[str]:
    """Yield the joints from one link to another.

    Unless the chain leads down from its base link, MoveIt adds the joint above the link where both ways up meet.
    """
    above = {child: joint.parent for child, joint in parents.items()}
    up, down = (list(walk_up(link, above)) for link in (chain.base_link, chain.tip_link))
    meeting = next((link for link in up if link in down), None)
    shared = set(up) & set(down) - {meeting if meeting != chain.base_link else None}
    yield from (parents[link].name for link in (*up, *down) if link not in shared and link in parents)
