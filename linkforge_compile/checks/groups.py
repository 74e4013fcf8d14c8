"""Planning groups: their chains lead somewhere, and end effectors fit them as MoveIt sees it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.checks.circles import told_circles
from linkforge_compile.checks.references import Use
from linkforge_compile.checks.tree import parent_joints, way_up
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Gaps
from linkforge_compile.diagnostics.codes.model import (
    CHAIN_ACROSS,
    CHAIN_UPWARD,
    GROUP_CIRCLE,
    GROUP_WITHOUT_JOINT,
    NO_ARM,
    OWN_PARENT_GROUP,
    PARENT_LINK_OUTSIDE_GROUP,
)

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import Chain, PlanningGroup


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
    ways = _Ways(robot)
    for group in robot.semantic.groups:
        for chain in group.chains:
            meeting = ways.meeting_link(chain)
            if meeting is None or meeting == chain.base_link:
                continue
            code, end = (CHAIN_UPWARD, "base_link") if meeting == chain.tip_link else (CHAIN_ACROSS, "tip_link")
            use = Use(group.name, f"planning group '{group.name}'", chain.source or group.source, (end,))
            yield use.told(code, base=chain.base_link, tip=chain.tip_link, meeting=meeting)


def check_empty_groups(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A planning group has a joint.

    MoveIt leaves out a group without one, with its states and end effectors: a chain from a link to itself, or
    subgroups that have none either. Add a joint, or a link, which stands for the joint that it hangs on.
    """
    links = group_links(robot)
    for group in robot.semantic.groups:
        if links.get(group.name) == frozenset():
            yield Use(group.name, "", group.source).told(GROUP_WITHOUT_JOINT, group=group.name)


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
        elif members and effector.parent_link not in members and robot.has_link(effector.parent_link):
            use = Use(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield use.told(PARENT_LINK_OUTSIDE_GROUP, link=effector.parent_link, group=effector.parent_group)


def check_arms_of_end_effectors(robot: Robot, gaps: Gaps) -> Iterator[Diagnostic]:
    """The parent link of an end effector is in a planning group: that of the arm which carries it.

    Otherwise MoveIt finds no parent group, says so in its log, and does not know which arm to move for this hand.
    Nothing is wrong with a hand on a robot without an arm. Silent while a group could not be read.
    """
    links = group_links(robot)
    if gaps or len(links) < len(robot.semantic.groups):
        return
    parents = {effector.parent_link for effector in robot.semantic.end_effectors}
    holders = Counter(link for members in links.values() for link in parents & members)
    for effector in robot.semantic.end_effectors:
        own = links.get(effector.group, frozenset())
        is_held = holders[effector.parent_link] > (effector.parent_link in own)
        if not effector.parent_group and not is_held and robot.has_link(effector.parent_link):
            use = Use(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield use.told(NO_ARM, link=effector.parent_link)


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
    ways = _Ways(robot)
    moved = {joint.name: joint.child_link for joint in robot.semantic.virtual_joints}
    moved.update((joint.name, joint.child) for joint in robot.joints)
    links: dict[str, frozenset[str]] = {}
    for name in order:
        group = groups.get(name)
        own = _own_links(group, ways, moved) if group else None
        if group and own is not None and links.keys() >= set(group.subgroups):
            links[name] = own.union(*(links[subgroup] for subgroup in group.subgroups)) if group.subgroups else own
    return links


def _own_links(group: PlanningGroup, ways: _Ways, moved: Mapping[str, str]) -> frozenset[str] | None:
    named = frozenset((*group.links, *(moved.get(joint, "") for joint in group.joints)))
    chains = [ways.links(chain) for chain in group.chains]
    whole = [links for links in chains if links is not None]
    if len(whole) < len(chains):
        return None
    links = whole[0] if len(whole) == 1 and not named else named.union(*whole)
    return links if links <= ways.known else None


class _Ways:
    """The ways of chains through a robot, each walked once: many groups may name one long chain."""

    def __init__(self, robot: Robot) -> None:
        self.known = frozenset(robot.links.names)
        self._above = parent_joints(robot)
        self._meetings: dict[tuple[str, str], str | None] = {}
        self._links: dict[tuple[str, str], frozenset[str]] = {}

    def meeting_link(self, chain: Chain) -> str | None:
        """Return the lowest link that both ends are or hang on; None if there is none or an end is unknown."""
        ends = (chain.base_link, chain.tip_link)
        if not self.known.issuperset(ends):
            return None
        if ends not in self._meetings:
            above_base = frozenset(way_up(chain.base_link, self._above))
            on_both = (link for link in way_up(chain.tip_link, self._above) if link in above_base)
            self._meetings[ends] = next(on_both, None)
        return self._meetings[ends]

    def links(self, chain: Chain) -> frozenset[str] | None:
        """Return the links that a chain moves, one object for all chains with its ends; None without a meeting link."""
        meeting = self.meeting_link(chain)
        if meeting is None:
            return None
        ends = (chain.base_link, chain.tip_link)
        if ends not in self._links:
            ways = [way_up(end, self._above) for end in ends]
            below = (link for way in ways for link in way[: way.index(meeting)])
            # With the link where they meet, as MoveIt does, unless the chain leads down from it.
            self._links[ends] = frozenset(below) | ({meeting} - {chain.base_link})
        return self._links[ends]
