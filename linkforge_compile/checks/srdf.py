"""The semantic part refers to parts of the robot and does not contradict itself; states fit groups and limits."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping

from linkforge_compile.checks.groups import LinkSets, group_of, names_in_order, report_states_in_other_order
from linkforge_compile.checks.joints import ROUNDING, in_unit, is_known, missed_range, unit_in
from linkforge_compile.checks.names import Reference, notes_at, own_positions, report_unknown
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState, VirtualJoint
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    ENABLED_ANYWAY,
    PAIR_BOTH_WAYS,
    PAIR_TWICE,
    STATE_AGAINST_MIMIC,
    STATE_INCOMPLETE,
    STATE_OUTSIDE_GROUP,
    STATE_OUTSIDE_LIMITS,
    STATE_TAKES_OTHERS_ALONG,
    STATE_VALUE_COUNT,
    VIRTUAL_JOINT_NOT_AT_ROOT,
    VIRTUAL_NAME_TAKEN,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP, UNKNOWN_JOINT, UNKNOWN_LINK
from linkforge_compile.diagnostics.entry_fixes import leave_out_entry
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.diagnostics.grouping import SHOWN, join_names
from linkforge_compile.source import Key, Span
from linkforge_compile.units import WIDEST_ANGLE

VALUES_IN_A_STATE: dict[str, tuple[int, str]] = {
    JointType.FIXED: (0, "no value"),
    JointType.REVOLUTE: (1, "1 value"),
    JointType.CONTINUOUS: (1, "1 value"),
    JointType.PRISMATIC: (1, "1 value"),
    JointType.PLANAR: (3, "3 values: x, y and angle"),
    JointType.FLOATING: (7, "7 values: x, y, z and a quaternion"),
}
"""The count of values that MoveIt reads for a joint in a state, which can exceed the degrees of freedom."""

MIMIC_ROUNDING = 1e-3
"""The tolerance on positions of followers [rad] or [m]: states are written with few digits."""


def check_semantic_links(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The semantic part names links of this robot.

    MoveIt drops what names another link: a chain and with it the group, an end effector, a collision pair that
    then costs time or stops the robot for no reason. Correct the name, or remove the entry.
    """
    yield from report_unknown(_links(robot), UNKNOWN_LINK, robot.links.names, unresolved)


def check_semantic_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The semantic part names joints of this robot, or its own virtual joints.

    MoveIt drops what names another joint: it is missing from its group, or its position from the state.
    """
    known = (*robot.joints.names, *(joint.name for joint in robot.semantic.virtual_joints))
    yield from report_unknown(_joints(robot), UNKNOWN_JOINT, known, unresolved)


def check_semantic_groups(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """Subgroups, states and end effectors name planning groups of this robot.

    MoveIt drops a group with an unknown subgroup, and states and end effectors of unknown groups.
    """
    groups = {group.name: group for group in robot.semantic.groups}
    yield from report_states_in_other_order(robot.semantic.group_states, groups, unresolved)
    yield from report_unknown(_groups(robot, groups), UNKNOWN_GROUP, groups, unresolved, hint="")


def check_virtual_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The child link of a virtual joint is the root link.

    MoveIt skips one with any other link. Name the root as `child_link`, or leave the virtual joint out.
    Not checked while part of the robot could not be read, or while it has several roots.
    """
    children = {joint.child for joint in robot.joints}
    roots = [link.name for link in robot.links if link.name not in children]
    if unresolved or len(roots) != 1:
        return
    for joint in robot.semantic.virtual_joints:
        if robot.has_link(joint.child_link) and joint.child_link != roots[0]:
            ref = Reference(joint.child_link, f"virtual joint '{joint.name}'", joint.source, ("child_link",))
            yield ref.report(VIRTUAL_JOINT_NOT_AT_ROOT, link=joint.child_link, root=roots[0])


def check_virtual_joint_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A virtual joint does not have the name of a joint.

    MoveIt keeps both under one name and confuses the two, in groups and states too. Rename it.
    """
    for virtual in robot.semantic.virtual_joints:
        if joint := robot.joints.get(virtual.name):
            notes = notes_at(joint.source, f"joint '{joint.name}' is here")
            yield VIRTUAL_NAME_TAKEN.at(virtual.source, name=virtual.name, notes=notes)


def check_collision_pairs(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A pair of links is listed once, under either of its links.

    The second entry adds nothing, or another reason that is never read. Remove one.
    """
    for pairs in (robot.semantic.disabled_collisions, robot.semantic.enabled_collisions):
        first: dict[frozenset[str], CollisionPair] = {}
        for pair in pairs:
            ends = frozenset((pair.link1, pair.link2))
            if earlier := first.get(ends):
                notes = notes_at(earlier.source, "the first entry")
                yield PAIR_TWICE.at(pair.source, link1=pair.link1, link2=pair.link2, notes=notes)
            else:
                first[ends] = pair


def _without_pair(pair: CollisionPair) -> Fix | None:
    """Return the fix that leaves out a pair."""
    if pair.source is None:
        return None
    reason = pair.source.node.child("reason")
    return leave_out_entry(pair.source.at("link2"), None if reason is None else reason.span)


def check_enabled_pairs(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """An enabled pair makes an exception from `no_default_collision_links`, and is not disabled.

    MoveIt checks every pair of links that is not disabled; an enabled pair brings back one of a link whose
    collisions are off by default. Of a pair that is enabled and disabled it reads the latter last.
    """
    semantic = robot.semantic
    disabled = {frozenset((pair.link1, pair.link2)): pair for pair in reversed(semantic.disabled_collisions)}
    off = frozenset(semantic.no_default_collision_links)
    for pair in semantic.enabled_collisions:
        ends = frozenset((pair.link1, pair.link2))
        if not all(map(robot.has_link, ends)):
            continue
        if other := disabled.get(ends):
            notes = notes_at(other.source, "disabled here")
            fault = PAIR_BOTH_WAYS.at(pair.source, link1=pair.link1, link2=pair.link2, notes=notes)
            yield fault.with_fix(_without_pair(pair))
        elif not ends & off:
            yield ENABLED_ANYWAY.at(pair.source, link1=pair.link1, link2=pair.link2)


def _links(robot: Robot) -> Iterator[Reference]:
    semantic = robot.semantic
    for virtual in semantic.virtual_joints:
        yield Reference(virtual.child_link, f"virtual joint '{virtual.name}'", virtual.source, ("child_link",))
    for group in semantic.groups:
        user = f"planning group '{group.name}'"
        for place, link in enumerate(group.links):
            yield Reference(link, user, group.source, ("links", place))
        for chain in group.chains:
            yield Reference(chain.base_link, user, chain.source or group.source, ("base_link",))
            yield Reference(chain.tip_link, user, chain.source or group.source, ("tip_link",))
    for effector in semantic.end_effectors:
        yield Reference(effector.parent_link, f"end effector '{effector.name}'", effector.source, ("parent_link",))
    for pair in (*semantic.disabled_collisions, *semantic.enabled_collisions):
        user = f"collision pair '{pair.link1}', '{pair.link2}'"
        yield Reference(pair.link1, user, pair.source, ("link1",))
        yield Reference(pair.link2, user, pair.source, ("link2",))
    for place, link in enumerate(semantic.no_default_collision_links):
        key = "no_default_collision_links"
        yield Reference(link, key, semantic.source, (key, place))
    for approximation in semantic.link_sphere_approximations:
        yield Reference(approximation.link, "link_sphere_approximations", approximation.source, ("link",))


def _joints(robot: Robot) -> Iterator[Reference]:
    semantic, groups = robot.semantic, {group.name: group for group in robot.semantic.groups}
    for group in semantic.groups:
        for place, joint in enumerate(group.joints):
            yield Reference(joint, f"planning group '{group.name}'", group.source, ("joints", place))
    for state in semantic.group_states:
        for joint, key in own_positions(state).items() if not names_in_order(state, groups) else ():
            yield Reference(joint, f"state '{state.name}' of group '{state.group}'", state.source, (key,))
    for passive in semantic.passive_joints:
        yield Reference(passive.name, "passive_joints", passive.source)
    for remark in semantic.joint_properties:
        yield Reference(remark.joint_name, f"joint property '{remark.property_name}'", remark.source, ("joint_name",))


def _groups(robot: Robot, known: Collection[str]) -> Iterator[Reference]:
    """Yield the uses of groups, but for states that have their names in another order."""
    semantic = robot.semantic
    for group in semantic.groups:
        for place, subgroup in enumerate(group.subgroups):
            yield Reference(subgroup, f"planning group '{group.name}'", group.source, ("subgroups", place))
    yield from (group_of(state) for state in semantic.group_states if not names_in_order(state, known))
    for effector in semantic.end_effectors:
        user = f"end effector '{effector.name}'"
        yield Reference(effector.group, user, effector.source, ("group",))
        if effector.parent_group:
            yield Reference(effector.parent_group, user, effector.source, ("parent_group",))


def check_group_states(robot: Robot, _: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """The positions of a state are of joints of its group, and within their limits.

    MoveIt ignores the value of a joint that is not in the group, and one with the wrong count of numbers; to a
    pose outside the limits it never plans. Correct the value, or the group.
    """
    virtual = {joint.name: joint for joint in robot.semantic.virtual_joints}
    for state in robot.semantic.group_states:
        for name, key in own_positions(state).items():
            values = state.joint_values[name]
            joint = robot.joints.get(name) or virtual.get(name)
            if joint is None:
                continue
            ref = _at_value(state, name, key)
            members = links.of_groups.get(state.group)
            if members and not members & links.bit(links.moved[name]):
                yield ref._replace(path=(key,)).report(
                    STATE_OUTSIDE_GROUP, joint=name, group=state.group, state=state.name
                )
            elif isinstance(values, tuple):
                yield from _faults_of_values(ref, joint, values)


def check_states_taken_over(robot: Robot, _: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """A position that a state takes from another group's state is of a joint of its own group.

    A position that comes from the state of another group is written into this one, and MoveIt ignores it where the
    joint is not in the group. Put the other group among the `subgroups` of this one, or take the name out.
    """
    for state in robot.semantic.group_states:
        members, own = links.of_groups.get(state.group), own_positions(state)
        taken = [joint for name in state.joint_values if name not in own and (joint := robot.joints.get(name))]
        outside = [joint.name for joint in taken if members and not members & links.bit(joint.child)]
        if outside:
            them = "it" if len(outside) == 1 else "them"
            yield STATE_TAKES_OTHERS_ALONG.at(
                state.source, state=state.name, group=state.group, joints=join_names(outside), them=them
            )


def _faults_of_values(ref: Reference, joint: Joint | VirtualJoint, values: tuple[object, ...]) -> Iterator[Diagnostic]:
    count, expected = VALUES_IN_A_STATE.get(joint.type, (len(values), ""))
    if len(values) != count:
        found = _counted(values) + ("" if count else "; leave it out")
        yield ref.report(STATE_VALUE_COUNT, joint=joint.name, type=joint.type, expected=expected, found=found)
    elif isinstance(joint, Joint) and values and isinstance(position := values[0], int | float):
        # Few are outside, and reading the unit of a value is slower than comparing it.
        if missed_range(joint, position, position) is None or _is_reported_as_degrees(position, joint, ref.place):
            return
        unit = unit_in(ref.place.text) if ref.place else None
        span = missed_range(joint, position, position, unit)
        yield ref.report(STATE_OUTSIDE_LIMITS, joint=joint.name, range=span, found=in_unit(position, unit))


def _is_reported_as_degrees(position: float, joint: Joint, place: Span | None) -> bool:
    """Return whether lowering has reported a position as probably in degrees: a bare number of a spec."""
    if place is None or place.text is None or place.file.is_xml or joint.type is not JointType.REVOLUTE:
        return False
    is_bare = place.text.lstrip("+-")[:1].isdigit() and unit_in(place.text) is None
    return is_bare and abs(position) > WIDEST_ANGLE


def _counted(values: tuple[object, ...]) -> str:
    """Return "none", "the value 1", or how many values there are and the first of them: "2 values, [0, 0.5]"."""
    shown = [f"{value:.6g}" if isinstance(value, int | float) else str(value) for value in values[:SHOWN]]
    if len(values) < 2:
        return f"the value {shown[0]}" if shown else "none"
    rest = ["…"] if len(values) > SHOWN else []
    return f"{len(values)} values, [{', '.join(shown + rest)}]"


def check_states_of_mimics(robot: Robot, _: UnresolvedNames, _links: LinkSets) -> Iterator[Diagnostic]:
    """A state gives a joint that mimics another the position that follows from the other.

    MoveIt reads one value or the other, as their names are sorted, and a robot can take only one of the two
    poses. Leave the follower out of the state: its position follows from that of its leader, times `multiplier`
    plus `offset`.
    """
    for state in robot.semantic.group_states:
        for name, key in own_positions(state).items():
            joint = robot.joints.get(name)
            if joint is None or joint.mimic is None:
                continue
            found, led = _position(state.joint_values, name), _position(state.joint_values, joint.mimic.joint)
            if found is None or led is None or not is_known(joint.mimic.multiplier, joint.mimic.offset):
                continue
            expected = joint.mimic.multiplier * led + joint.mimic.offset
            if not math.isclose(found, expected, rel_tol=ROUNDING, abs_tol=MIMIC_ROUNDING):
                ref, leader = _at_value(state, name, key), joint.mimic.joint
                unit = unit_in(ref.place.text) if ref.place else None
                shown, written = in_unit(expected, unit), in_unit(found, unit)
                yield ref.report(STATE_AGAINST_MIMIC, joint=name, leader=leader, expected=shown, found=written)


def check_states_are_whole(robot: Robot, unresolved: UnresolvedNames, links: LinkSets) -> Iterator[Diagnostic]:
    """A state has a position for every joint of its group.

    MoveIt warns of a joint that a state leaves out, and leaves it where it happens to be, so that one name is
    that of many poses. That may be what you want: open fingers whatever the wrist does. Fixed and passive joints and
    those that mimic others need no value. Not checked while part of the robot could not be read, nor for a state
    with a joint that is not in its group, which may be the missing one.
    """
    semantic = robot.semantic
    if unresolved or not semantic.group_states:
        return
    passive = {joint.name for joint in semantic.passive_joints}
    free = {
        joint.child: joint.name
        for joint in reversed(robot.joints)
        if joint.type != JointType.FIXED and joint.mimic is None and joint.name not in passive
    }
    movable = links.of(filter(robot.has_link, free)) or 0
    for state in semantic.group_states:
        members = links.of_groups.get(state.group, 0)
        placed = links.of(links.moved.get(name, "") for name in state.joint_values)
        left = 0 if placed is None or placed & ~members else members & movable & ~placed
        if left:
            joints = join_names([free[link] for link in links.first(left, SHOWN)], left.bit_count())
            yield STATE_INCOMPLETE.at(state.source, state=state.name, group=state.group, joints=joints)


def _at_value(state: GroupState, joint: str, key: Key) -> Reference:
    return Reference(joint, f"state '{state.name}' of group '{state.group}'", state.source, (str(key),))


def _position(positions: Mapping[str, object], joint: str) -> float | None:
    match positions.get(joint):
        case (int() | float() as position,):
            return position
    return None
