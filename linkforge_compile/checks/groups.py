"""Planning groups: their chains lead somewhere, and end effectors fit them as MoveIt sees it."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.checks.cycles import report_cycles
from linkforge_compile.checks.link_sets import LinkSets, group_links
from linkforge_compile.checks.references import Use
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    CHAIN_ACROSS,
    CHAIN_UPWARD,
    GROUP_CIRCLE,
    GROUP_WITHOUT_JOINT,
    NO_ARM,
    OWN_PARENT_GROUP,
    PARENT_LINK_OUTSIDE_GROUP,
)


def check_group_circles(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
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
    yield from report_cycles(subgroups, GROUP_CIRCLE)


def check_chains(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The chain of a group leads from its `base_link` down to its `tip_link`.

    With the two swapped MoveIt takes the joints between them and the one above as well, and kinematics solvers
    find no chain. Between two branches (from one hand to the other, say) it takes the joints of both: that is
    allowed, but solvers for a single arm refuse it.
    """
    links = LinkSets(robot)
    for group in robot.semantic.groups:
        for chain in group.chains:
            meeting = links.meeting_link(chain)
            if meeting is None or meeting == chain.base_link:
                continue
            code, end = (CHAIN_UPWARD, "base_link") if meeting == chain.tip_link else (CHAIN_ACROSS, "tip_link")
            use = Use(group.name, f"planning group '{group.name}'", chain.source or group.source, (end,))
            yield use.told(code, base=chain.base_link, tip=chain.tip_link, meeting=meeting)


def check_empty_groups(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A planning group has a joint.

    MoveIt leaves out a group without one, with its states and end effectors: a chain from a link to itself, or
    subgroups that have none either. Add a joint, or a link, which stands for the joint that it hangs on.
    """
    moving = group_links(robot, LinkSets(robot))
    for group in robot.semantic.groups:
        if moving.get(group.name) == 0:
            yield Use(group.name, "", group.source).told(GROUP_WITHOUT_JOINT, group=group.name)


def check_end_effectors(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The parent group of an end effector is another group, and holds its parent link.

    Otherwise MoveIt ignores the parent group and takes the smallest group that holds the link, or none. The base
    link of a chain is not in its group, the tip link is.
    """
    effectors = robot.semantic.end_effectors
    if not effectors:
        return
    links = LinkSets(robot)
    moving = group_links(robot, links)
    for effector in effectors:
        if not effector.parent_group:
            continue
        members = moving.get(effector.parent_group)
        if effector.parent_group == effector.group:
            use = Use(effector.group, f"end effector '{effector.name}'", effector.source, ("parent_group",))
            yield use.told(OWN_PARENT_GROUP, group=effector.group)
        elif members and robot.has_link(effector.parent_link) and not members & links.bit(effector.parent_link):
            use = Use(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield use.told(PARENT_LINK_OUTSIDE_GROUP, link=effector.parent_link, group=effector.parent_group)


def check_arms_of_end_effectors(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The parent link of an end effector is in a planning group: that of the arm which carries it.

    Otherwise MoveIt finds no parent group, says so in its log, and does not know which arm to move for this hand.
    Nothing is wrong with a hand on a robot without an arm. Silent while a group could not be read.
    """
    if unresolved or not robot.semantic.end_effectors:
        return
    links = LinkSets(robot)
    moving = group_links(robot, links)
    if len(moving) < len(robot.semantic.groups):
        return
    in_one, in_several = 0, 0
    for members in moving.values():
        in_one, in_several = in_one | members, in_several | in_one & members
    for effector in robot.semantic.end_effectors:
        of_others = in_several | in_one & ~moving.get(effector.group, 0)
        is_held = of_others & links.bit(effector.parent_link)
        if not effector.parent_group and not is_held and robot.has_link(effector.parent_link):
            use = Use(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield use.told(NO_ARM, link=effector.parent_link)
