"""Planning groups: their chains lead somewhere, and states and end effectors fit them as MoveIt sees it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.checks.circles import told_circles
from linkforge_compile.checks.references import Use, own_positions
from linkforge_compile.checks.tree import parent_joints, way_up
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Gaps
from linkforge_compile.diagnostics.codes.model import (
    CHAIN_ACROSS,
    CHAIN_UPWARD,
    GROUP_CIRCLE,
    OWN_PARENT_GROUP,
    PARENT_LINK_OUTSIDE_GROUP,
    STATE_OUTSIDE_GROUP,
    STATE_OUTSIDE_LIMITS,
    STATE_VALUE_COUNT,
)

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import Chain, PlanningGroup, VirtualJoint

VALUES_IN_A_STATE: dict[str, tuple[int, str]] = {
    JointType.FIXED: (0, "no value"),
    JointType.REVOLUTE: (1, "1 value"),
    JointType.CONTINUOUS: (1, "1 value"),
    JointType.PRISMATIC: (1, "1 value"),
    JointType.PLANAR: (3, "3 values: x, y and angle"),
    JointType.FLOATING: (7, "7 values: x, y, z and a quaternion"),
}
"""What MoveIt takes for a joint in a state; it counts more than the degrees of freedom."""

WITHIN_LIMITS: dict[str, str] = {JointType.REVOLUTE: "rad", JointType.PRISMATIC: "m"}
"""The joints whose limits bound their position, and its unit."""

ROUNDING = 1e-4
"""How far a state may pass a limit [rad] or [m]: 1.5708 for a quarter turn is no mistake."""


def check_group_circles(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A group may contain groups, but not itself, not even by way of others.

    MoveIt drops every group of such a circle. Take one of the subgroups out.
    """
    subgroups = {
        group.name: [
            Use(name, f"planning group '{group.name}'", group.source, ("subgroups", place))
            for place, name in enumerate(group.subgroups)
        ]
        for group in robot.semantic.groups
        if group.subgroups
    }
    yield from told_circles(subgroups, GROUP_CIRCLE)


def check_chains(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """The chain of a group leads from its `base_link` down to its `tip_link`.

    With the two swapped MoveIt takes the joints between them and the one above as well, and kinematics solvers
    find no chain. Between two branches (from one hand to the other, say) it takes the joints of both: that is
    allowed, but solvers for a single arm refuse it.
    """
    above = parent_joints(robot)
    for group in robot.semantic.groups:
        for chain in group.chains:
            meeting = _meeting_link(chain, robot, above)
            if meeting is None or meeting == chain.base_link:
                continue
            code, end = (CHAIN_UPWARD, "base_link") if meeting == chain.tip_link else (CHAIN_ACROSS, "tip_link")
            use = Use(group.name, f"planning group '{group.name}'", chain.source or group.source, (end,))
            yield use.told(code, base=chain.base_link, tip=chain.tip_link, meeting=meeting)


def check_group_states(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A state gives positions to joints of its group, within their limits.

    MoveIt ignores the value of a joint that is not in the group, and one with the wrong count of numbers; to a
    pose outside the limits it never plans. Correct the value, or the group.
    """
    semantic = robot.semantic
    links = group_links(robot)
    virtual = {joint.name: joint for joint in semantic.virtual_joints}
    for state in semantic.group_states:
        for name, key in own_positions(state).items():
            values = state.joint_values[name]
            joint = robot.joints.get(name) or virtual.get(name)
            if joint is None:
                continue
            use = Use(name, f"state '{state.name}' of group '{state.group}'", state.source, (str(key),))
            members = links.get(state.group)
            if members is not None and _moved_link(joint) not in members:
                yield use._replace(path=(key,)).told(
                    STATE_OUTSIDE_GROUP, joint=name, group=state.group, state=state.name
                )
            elif isinstance(values, tuple):
                yield from _faults_of_values(use, joint, values)


def _faults_of_values(use: Use, joint: Joint | VirtualJoint, values: tuple[object, ...]) -> Iterator[Diagnostic]:
    count, expected = VALUES_IN_A_STATE.get(joint.type, (len(values), ""))
    if len(values) != count:
        yield use.told(STATE_VALUE_COUNT, joint=joint.name, type=joint.type, expected=expected, found=len(values))
    elif isinstance(joint, Joint) and joint.limits and joint.type in WITHIN_LIMITS:
        lower, upper, position = joint.limits.lower, joint.limits.upper, values[0]
        if not isinstance(position, int | float):
            return
        if (lower is not None and position < lower - ROUNDING) or (upper is not None and position > upper + ROUNDING):
            bounds = [f"{way} {bound:.6g}" for way, bound in (("from", lower), ("to", upper)) if bound is not None]
            span = " ".join((*bounds, WITHIN_LIMITS[joint.type]))
            yield use.told(STATE_OUTSIDE_LIMITS, joint=joint.name, range=span, found=f"{position:.6g}")


def check_end_effectors(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """The parent group of an end effector is another group, and holds its parent link.

    Otherwise MoveIt ignores the parent group and takes the smallest group that holds the link, or none. The base
    link of a chain is not in its group, the tip link is.
    """
    links = group_links(robot)
    for effector in robot.semantic.end_effectors:
        if not effector.parent_group:
            continue
        members = links.get(effector.parent_group)
        if effector.parent_group == effector.group:
            use = Use(effector.group, f"end effector '{effector.name}'", effector.source, ("parent_group",))
            yield use.told(OWN_PARENT_GROUP, group=effector.group)
        elif members is not None and effector.parent_link not in members and robot.has_link(effector.parent_link):
            use = Use(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield use.told(PARENT_LINK_OUTSIDE_GROUP, link=effector.parent_link, group=effector.parent_group)


def group_links(robot: Robot) -> Mapping[str, frozenset[str]]:
    """Return the links that each group moves, which says its joints as well: a link hangs on one joint.

    Without the groups that name something unknown, and without any while they contain one another in a circle.
    """
    from graphlib import CycleError, TopologicalSorter

    groups = {group.name: group for group in reversed(tuple(robot.semantic.groups))}
    try:
        order = tuple(TopologicalSorter({name: group.subgroups for name, group in groups.items()}).static_order())
    except CycleError:
        return {}
    above = parent_joints(robot)
    moved = {joint.name: joint.child_link for joint in robot.semantic.virtual_joints}
    moved.update((joint.name, joint.child) for joint in robot.joints)
    links: dict[str, frozenset[str]] = {}
    for name in order:
        group = groups.get(name)
        own = _own_links(group, robot, above, moved) if group else None
        if group and own is not None and links.keys() >= set(group.subgroups):
            links[name] = own.union(*(links[subgroup] for subgroup in group.subgroups))
    return links


def _own_links(
    group: PlanningGroup, robot: Robot, above: Mapping[str, Joint], moved: Mapping[str, str]
) -> frozenset[str] | None:
    links = {*group.links, *(moved.get(joint, "") for joint in group.joints)}
    for chain in group.chains:
        meeting = _meeting_link(chain, robot, above)
        if meeting is None:
            return None
        for end in (chain.base_link, chain.tip_link):
            way = way_up(end, above)
            links.update(way[: way.index(meeting)])
        if meeting != chain.base_link:
            links.add(meeting)  # as MoveIt does
    return frozenset(links) if all(map(robot.has_link, links)) else None


def _meeting_link(chain: Chain, robot: Robot, above: Mapping[str, Joint]) -> str | None:
    """Return the lowest link that both ends are or hang on; None if there is none or an end is unknown."""
    if not (robot.has_link(chain.base_link) and robot.has_link(chain.tip_link)):
        return None
    above_base = frozenset(way_up(chain.base_link, above))
    return next((link for link in way_up(chain.tip_link, above) if link in above_base), None)


def _moved_link(joint: Joint | VirtualJoint) -> str:
    return joint.child if isinstance(joint, Joint) else joint.child_link
