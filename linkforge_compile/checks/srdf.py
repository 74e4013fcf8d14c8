"""The semantic part refers to links, joints and groups of the robot, and does not contradict itself."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from linkforge_compile.checks.names import Reference, notes_at, own_positions, report_unknown
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    ENABLED_ANYWAY,
    PAIR_BOTH_WAYS,
    PAIR_TWICE,
    PASSIVE_COMMANDED,
    VIRTUAL_JOINT_NOT_AT_ROOT,
    VIRTUAL_NAME_TAKEN,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP, UNKNOWN_JOINT, UNKNOWN_LINK

if TYPE_CHECKING:
    from linkforge_compile.core.models.collision_rules import CollisionPair
    from linkforge_compile.core.models.srdf import GroupState


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
    groups = _names_of_groups(robot)
    for state in robot.semantic.group_states:
        if state.group not in unresolved and (reordered := _reordered(state, groups)):
            ref = _group_of(state)
            names = [name.removeprefix(ref.prefix) for name in reordered]
            hint = f"; the group comes first: write '{': {'.join(names)}: …{'}' * (len(names) - 1)}'"
            yield ref.report(UNKNOWN_GROUP, name=state.group.removeprefix(ref.prefix), hint=hint)
    yield from report_unknown(_groups(robot, groups), UNKNOWN_GROUP, groups, unresolved, hint="")


def _reordered(state: GroupState, groups: Collection[str]) -> tuple[str, ...]:
    """Return group, state and joint of a state that has them in another order; () for any other state."""
    if state.group in groups:
        return ()
    if state.name in groups:
        return state.name, state.group
    group = next((joint for joint in state.joint_values if joint in groups), None)
    return (group, state.name, state.group) if group else ()


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

    MoveIt keeps both under one name and takes the one for the other, in groups and states too. Rename it.
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
            yield PAIR_BOTH_WAYS.at(pair.source, link1=pair.link1, link2=pair.link2, notes=notes)
        elif not ends & off:
            yield ENABLED_ANYWAY.at(pair.source, link1=pair.link1, link2=pair.link2)


def check_passive_joints(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A passive joint has no command interface.

    MoveIt never plans for a passive joint, so its command interface in ros2_control waits for ever. Drop the
    command interface, or the joint from `passive_joints`.
    """
    passive = {joint.name: joint for joint in robot.semantic.passive_joints}
    for control in robot.ros2_controls if passive else ():
        for driven in control.joints:
            joint = passive.get(driven.name)
            if joint and driven.command_interfaces:
                command = Reference(
                    joint.name, f"ros2_control '{control.name}'", driven.source, ("command_interfaces",)
                )
                notes = [command.note(f"{command.user} commands it")]
                yield PASSIVE_COMMANDED.at(joint.source, joint=joint.name, control=control.name, notes=notes)


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
        path = ("no_default_collision_links", place)
        yield Reference(link, "no_default_collision_links", semantic.source, path)
    for approximation in semantic.link_sphere_approximations:
        yield Reference(approximation.link, "link_sphere_approximations", approximation.source, ("link",))


def _joints(robot: Robot) -> Iterator[Reference]:
    semantic, groups = robot.semantic, _names_of_groups(robot)
    for group in semantic.groups:
        for place, joint in enumerate(group.joints):
            yield Reference(joint, f"planning group '{group.name}'", group.source, ("joints", place))
    for state in semantic.group_states:
        for joint, key in own_positions(state).items() if not _reordered(state, groups) else ():
            yield Reference(joint, f"state '{state.name}' of group '{state.group}'", state.source, (key,))
    for passive in semantic.passive_joints:
        yield Reference(passive.name, "passive_joints", passive.source)
    for remark in semantic.joint_properties:
        yield Reference(remark.joint_name, f"joint property '{remark.property_name}'", remark.source, ("joint_name",))


def _names_of_groups(robot: Robot) -> Collection[str]:
    return dict.fromkeys(group.name for group in robot.semantic.groups)


def _group_of(state: GroupState) -> Reference:
    return Reference(state.group, f"group state '{state.name}'", state.source, ("group",))


def _groups(robot: Robot, known: Collection[str]) -> Iterator[Reference]:
    """Yield the uses of groups, but for states that have their names in another order."""
    semantic = robot.semantic
    for group in semantic.groups:
        for place, subgroup in enumerate(group.subgroups):
            yield Reference(subgroup, f"planning group '{group.name}'", group.source, ("subgroups", place))
    yield from (_group_of(state) for state in semantic.group_states if not _reordered(state, known))
    for effector in semantic.end_effectors:
        user = f"end effector '{effector.name}'"
        yield Reference(effector.group, user, effector.source, ("group",))
        if effector.parent_group:
            yield Reference(effector.parent_group, user, effector.source, ("parent_group",))
