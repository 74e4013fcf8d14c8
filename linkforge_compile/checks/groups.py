"""Planning groups: the links and joints in them, their chains and end effectors as MoveIt reads them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, reduce
from graphlib import CycleError, TopologicalSorter
from itertools import takewhile
from operator import or_

from linkforge_compile.checks.names import Reference, report_cycles
from linkforge_compile.core.models.graph import parent_joints, walk_up
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import Chain, GroupState
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    CHAIN_ACROSS,
    CHAIN_UPWARD,
    GROUP_CYCLE,
    GROUP_WITHOUT_JOINT,
    NO_ARM,
    OWN_PARENT_GROUP,
    PARENT_LINK_OUTSIDE_GROUP,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP
from linkforge_compile.diagnostics.entry_fixes import exchange
from linkforge_compile.diagnostics.fix import Fix


def check_group_cycles(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A group may contain groups, but not itself, not even by way of others.

    MoveIt drops every group of such a cycle. Take one of the subgroups out.
    """
    subgroups = {
        group.name: [
            Reference(name, f"planning group '{group.name}'", group.source, ("subgroups", place))
            for place, name in enumerate(group.subgroups)
        ]
        for group in robot.semantic.groups
        if group.subgroups
    }
    yield from report_cycles(subgroups, GROUP_CYCLE)


def check_chains(robot: Robot, _: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """The chain of a group leads from its `base_link` down to its `tip_link`.

    With the two swapped MoveIt takes the joints between them and the one above as well, and kinematics solvers
    find no chain. Between two branches (such as two hands) it takes the joints of both: that is allowed, but
    solvers for a single arm refuse it.
    """
    for group in robot.semantic.groups:
        for chain in group.chains:
            meeting = links.meeting_link(chain)
            if meeting is None or meeting == chain.base_link:
                continue
            code, end = (CHAIN_UPWARD, "base_link") if meeting == chain.tip_link else (CHAIN_ACROSS, "tip_link")
            ref = Reference(group.name, f"planning group '{group.name}'", chain.source or group.source, (end,))
            fault = ref.report(code, base=chain.base_link, tip=chain.tip_link, meeting=meeting)
            ends = [chain.source.at(key) if chain.source else None for key in ("base_link", "tip_link")]
            yield fault.with_fix(exchange("swap them", *ends) if code is CHAIN_UPWARD else None)


def check_empty_groups(robot: Robot, _: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """A planning group has a joint.

    MoveIt leaves out a group without one, with its states and end effectors: a chain from a link to itself, or
    subgroups that have none either. Add a joint, or a link, which means the joint above it.
    """
    for group in robot.semantic.groups:
        if links.of_groups.get(group.name) == 0:
            yield GROUP_WITHOUT_JOINT.at(group.source, group=group.name)


def check_end_effectors(robot: Robot, _: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """The parent group of an end effector is another group, and holds its parent link.

    Otherwise MoveIt ignores the parent group and takes the smallest group that holds the link, or none. The base
    link of a chain is not in its group, the tip link is.
    """
    for effector in robot.semantic.end_effectors:
        if not effector.parent_group:
            continue
        members = links.of_groups.get(effector.parent_group)
        if effector.parent_group == effector.group:
            ref = Reference(effector.group, f"end effector '{effector.name}'", effector.source, ("parent_group",))
            yield ref.report(OWN_PARENT_GROUP, group=effector.group)
        elif members and robot.has_link(effector.parent_link) and not members & links.bit(effector.parent_link):
            ref = Reference(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield ref.report(PARENT_LINK_OUTSIDE_GROUP, link=effector.parent_link, group=effector.parent_group)


def check_arms_of_end_effectors(robot: Robot, unresolved: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """The parent link of an end effector is in a planning group: that of the arm which carries it.

    Otherwise MoveIt finds no parent group, writes that to its log, and does not know which arm to move for this hand.
    Nothing is wrong with a hand on a robot without an arm. Not checked while a group could not be read.
    """
    if unresolved or not robot.semantic.end_effectors:
        return
    moving = links.of_groups
    if len(moving) < len(robot.semantic.groups):
        return
    in_one, in_several = 0, 0
    for members in moving.values():
        in_one, in_several = in_one | members, in_several | in_one & members
    for effector in robot.semantic.end_effectors:
        of_others = in_several | in_one & ~moving.get(effector.group, 0)
        is_held = of_others & links.bit(effector.parent_link)
        if not effector.parent_group and not is_held and robot.has_link(effector.parent_link):
            ref = Reference(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
            yield ref.report(NO_ARM, link=effector.parent_link)


class LinkSets:
    """Sets of the links of a robot as integers with a bit for each link, in the order of the joints above them.

    A spec may have thousands of groups with chains of thousands of links: 5,000 sets of 5,000 names take 1.3 GB, as
    integers 3 MB.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._known = frozenset(robot.links.names)
        self._parents = {name: joint.parent for name, joint in parent_joints(robot.joints).items()}
        self._names = [*dict.fromkeys((*self._parents, *robot.links.names))]
        self._places = {name: place for place, name in enumerate(self._names)}
        self._ways_up: dict[str, int] = {}
        self._lowest: dict[bytes, str] = {}

    def bit(self, link: str) -> int:
        """Return the set of one link, empty for a name that is none of the robot's."""
        return 1 << self._places[link] if link in self._known else 0

    def of(self, links: Iterable[str]) -> int | None:
        """Return the set of links, None where one is none of the robot's."""
        found = 0
        for link in links:
            bit = self.bit(link)
            if not bit:
                return None
            found |= bit
        return found

    def first(self, links: int, count: int) -> Iterator[str]:
        """Yield the first links of a set, at most so many."""
        for _ in range(min(count, links.bit_count())):
            lowest = links & -links
            yield self._names[lowest.bit_length() - 1]
            links ^= lowest

    def meeting_link(self, chain: Chain) -> str | None:
        """Return the lowest link that both ends are or hang on; None if there is none or an end is unknown."""
        return self._lowest.get(_key(self._way_up(chain.base_link) & self._way_up(chain.tip_link)))

    def between(self, chain: Chain) -> int | None:
        """Return the set of the links that a chain moves; None without a meeting link."""
        meeting = self.meeting_link(chain)
        if meeting is None:
            return None
        below = self._way_up(chain.base_link) ^ self._way_up(chain.tip_link)
        # With the link where they meet, as MoveIt does, unless the chain leads down from it.
        return below if meeting == chain.base_link else below | self.bit(meeting)

    @cached_property
    def moved(self) -> Mapping[str, str]:
        """The link that each joint moves, the virtual ones among them."""
        moved = {joint.name: joint.child_link for joint in self._robot.semantic.virtual_joints}
        moved.update((joint.name, joint.child) for joint in self._robot.joints)
        return moved

    @cached_property
    def of_groups(self) -> Mapping[str, int]:
        """The set of links that each group moves, and with them its joints: a link hangs on one joint.

        Groups with an unknown name are omitted, and all groups while they contain one another in a cycle.
        """
        groups = {group.name: group for group in reversed(tuple(self._robot.semantic.groups))}
        try:
            order = tuple(TopologicalSorter({name: group.subgroups for name, group in groups.items()}).static_order())
        except CycleError:
            return {}
        moving: dict[str, int] = {}
        for group in filter(None, map(groups.get, order)):
            # Without its subgroups it moves these; None among them is for an unknown name.
            named = self.of((*group.links, *(self.moved.get(joint, "") for joint in group.joints)))
            sets = [named, *map(self.between, group.chains), *map(moving.get, group.subgroups)]
            known = [links for links in sets if links is not None]
            if len(known) == len(sets):
                moving[group.name] = reduce(or_, known)
        return moving

    def _way_up(self, link: str) -> int:
        """Return the set of a link and all those above it, of a cycle once; empty for one that is unknown."""
        new = takewhile(lambda each: each in self._known and each not in self._ways_up, walk_up(link, self._parents))
        way = list(new)
        links = self._ways_up.get(self._parents.get(way[-1], ""), 0) if way else 0
        for each in reversed(way):
            links |= self.bit(each)
            self._ways_up[each] = links
            self._lowest[_key(links)] = each
        return self._ways_up.get(link, 0)


def _key(links: int) -> bytes:
    # The hash of a number is its remainder by 2**61 - 1, which is the same for most of the ways up one chain.
    return links.to_bytes(links.bit_length() // 8 + 1, "little")


def group_of(state: GroupState) -> Reference:
    """Return the reference of a state to its group."""
    return Reference(state.group, f"group state '{state.name}'", state.source, ("group",))


def names_in_order(state: GroupState, groups: Collection[str]) -> tuple[str, ...]:
    """Return group, state and joint of a state that has them in another order; () for any other state."""
    if state.group in groups:
        return ()
    if state.name in groups:
        return state.name, state.group
    group = next((joint for joint in state.joint_values if joint in groups), None)
    return (group, state.name, state.group) if group else ()


def report_states_in_other_order(
    states: Sequence[GroupState], groups: Collection[str], unresolved: UnresolvedNames
) -> Iterator[Diagnostic]:
    """Report each state whose group is not the outermost of its names."""
    for state in states:
        if state.group not in unresolved and (reordered := names_in_order(state, groups)):
            ref = group_of(state)
            names = [name.removeprefix(ref.prefix) for name in reordered]
            hint = f"; the group comes first: write '{': {'.join(names)}: …{'}' * (len(names) - 1)}'"
            fault = ref.report(UNKNOWN_GROUP, name=state.group.removeprefix(ref.prefix), hint=hint)
            is_only = sum(other.group == state.group for other in states) == 1
            yield fault.with_fix(_exchanged_keys(state, names) if is_only else None)


def _exchanged_keys(state: GroupState, names: Sequence[str]) -> Fix | None:
    """Return the fix that exchanges keys so that these names are in this order; None for a state of several joints."""
    source = state.source
    if source is None or (len(names) == 3 and len(state.joint_values) > 1):
        return None
    other = source.node.key_span(names[0]) if len(names) == 3 else source.span
    return exchange(f"write '{names[0]}' first", source.at("group"), other)
