"""Named states of planning groups: joints of their group, positions within the limits, and completeness."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.checks.groups import LinkSets, group_links, moved_links
from linkforge_compile.checks.joints import ROUNDING, in_unit, is_known, missed_range, unit_in
from linkforge_compile.checks.names import SHOWN, Reference, join_names, own_positions
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    STATE_AGAINST_MIMIC,
    STATE_INCOMPLETE,
    STATE_OUTSIDE_GROUP,
    STATE_OUTSIDE_LIMITS,
    STATE_TAKES_OTHERS_ALONG,
    STATE_VALUE_COUNT,
)
from linkforge_compile.source import Key, Span
from linkforge_compile.units import WIDEST_ANGLE

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import GroupState, VirtualJoint

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


def check_group_states(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The positions of a state are of joints of its group, and within their limits.

    MoveIt ignores the value of a joint that is not in the group, and one with the wrong count of numbers; to a
    pose outside the limits it never plans. Correct the value, or the group.
    """
    semantic = robot.semantic
    if not semantic.group_states:
        return
    links = LinkSets(robot)
    moving = group_links(robot, links)
    virtual = {joint.name: joint for joint in semantic.virtual_joints}
    for state in semantic.group_states:
        for name, key in own_positions(state).items():
            values = state.joint_values[name]
            joint = robot.joints.get(name) or virtual.get(name)
            if joint is None:
                continue
            ref = _at_value(state, name, key)
            members = moving.get(state.group)
            if members and not members & links.bit(_moved_link(joint)):
                yield ref._replace(path=(key,)).report(
                    STATE_OUTSIDE_GROUP, joint=name, group=state.group, state=state.name
                )
            elif isinstance(values, tuple):
                yield from _faults_of_values(ref, joint, values)


def check_states_taken_over(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A position that a state takes from another group's state is of a joint of its own group.

    A position that comes from the state of another group is written into this one, and MoveIt ignores it where the
    joint is not in the group. Put the other group among the `subgroups` of this one, or take the name out.
    """
    states = robot.semantic.group_states
    if not states:
        return
    links = LinkSets(robot)
    moving = group_links(robot, links)
    for state in states:
        members, own = moving.get(state.group), own_positions(state)
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
        yield from _fault_of_position(ref, joint, position)


def _fault_of_position(ref: Reference, joint: Joint, position: float) -> Iterator[Diagnostic]:
    # Few are outside, and reading the unit of a value takes longer than comparing it.
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
    if len(values) == 1:
        return f"the value {shown[0]}"
    return (
        f"{len(values)} values, [{', '.join((*shown, *(['…'] if len(values) > SHOWN else [])))}]" if values else "none"
    )


def check_states_of_mimics(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A state gives a joint that mimics another the position that follows from the other.

    MoveIt takes the one or the other value, as their names are sorted, and a robot can take only one of the two
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


def check_states_are_whole(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A state has a position for every joint of its group.

    MoveIt warns of a joint that a state leaves out, and leaves it where it happens to be, so that one name stands
    for many poses. That may be what you want: open fingers whatever the wrist does. Fixed and passive joints and
    those that mimic others need no value. Not checked while part of the robot could not be read, nor for a state
    with a joint that is not in its group, which may be the missing one.
    """
    semantic = robot.semantic
    if unresolved or not semantic.group_states:
        return
    links, moved = LinkSets(robot), moved_links(robot)
    moving = group_links(robot, links)
    passive = {joint.name for joint in semantic.passive_joints}
    free = {
        joint.child: joint.name
        for joint in reversed(robot.joints)
        if joint.type != JointType.FIXED and joint.mimic is None and joint.name not in passive
    }
    movable = links.of(filter(robot.has_link, free)) or 0
    for state in semantic.group_states:
        members, placed = moving.get(state.group, 0), links.of(moved.get(name, "") for name in state.joint_values)
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


def _moved_link(joint: Joint | VirtualJoint) -> str:
    return joint.child if isinstance(joint, Joint) else joint.child_link
