"""Remove a virtual joint from a semantic description, with all that names it or is empty without it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.models.srdf import GroupState, PlanningGroup, SemanticRobotDescription
from linkforge_compile.core.part import Inside


class SemanticWithoutJoint(NamedTuple):
    """What remains of a semantic description; `removed` and `changed` are what named the joint, for messages.

    `groups` are the names of the groups that were removed.
    """

    semantic: SemanticRobotDescription
    groups: frozenset[str]
    removed: tuple[str, ...]
    changed: tuple[str, ...]

    @property
    def words(self) -> str:
        """What else is left out, as the end of "virtual joint 'x' is left out"; empty for nothing."""
        removed = f", with {', '.join(self.removed)}" if self.removed else ""
        return removed + (f", and taken out of {', '.join(self.changed)}" if self.changed else "")


def without_virtual_joint(semantic: SemanticRobotDescription, joint: str, prefix: str = "") -> SemanticWithoutJoint:
    """Remove a virtual joint, and what is empty without it; messages have names without the prefix.

    A group of nothing else is removed, with its states and end effectors. A state of another group stays even if it is
    empty, because other states may refer to it.
    """
    empty = _empty_groups(semantic.groups, joint)
    remaining = replace(
        semantic,
        virtual_joints=tuple(each for each in semantic.virtual_joints if each.name != joint),
        groups=tuple(_group_without(group, joint, empty) for group in semantic.groups if group.name not in empty),
        group_states=tuple(_state_without(state, joint) for state in semantic.group_states if state.group not in empty),
        end_effectors=tuple(
            replace(effector, parent_group=None) if effector.parent_group in empty else effector
            for effector in semantic.end_effectors
            if effector.group not in empty
        ),
        passive_joints=tuple(each for each in semantic.passive_joints if each.name != joint),
        joint_properties=tuple(each for each in semantic.joint_properties if each.joint_name != joint),
    )
    removed = [("group", name) for group in semantic.groups if (name := group.name) in empty]
    removed += [("end effector", effector.name) for effector in semantic.end_effectors if effector.group in empty]
    removed += [("state", state.name) for state in semantic.group_states if state.group in empty]
    words = tuple(f"{kind} '{name.removeprefix(prefix)}'" for kind, name in removed)
    return SemanticWithoutJoint(remaining, empty, words, tuple(_changed(semantic, remaining, prefix)))


def _changed(before: SemanticRobotDescription, after: SemanticRobotDescription, prefix: str) -> Iterator[str]:
    """Yield what is still there, but without the joint."""
    for group in after.groups:
        if group not in before.groups:
            yield f"group '{group.name.removeprefix(prefix)}'"
    for state in after.group_states:
        if state not in before.group_states:
            yield f"state '{state.name.removeprefix(prefix)}' of group '{state.group.removeprefix(prefix)}'"
    for effector in after.end_effectors:
        if effector not in before.end_effectors:
            yield f"end effector '{effector.name.removeprefix(prefix)}'"
    if len(after.passive_joints) < len(before.passive_joints):
        yield "passive_joints"
    if len(after.joint_properties) < len(before.joint_properties):
        yield "joint_properties"


def _empty_groups(groups: Sequence[PlanningGroup], joint: str) -> frozenset[str]:
    """Return the groups with no members but the joint and groups that are empty without it."""
    empty: frozenset[str] = frozenset()
    while True:
        now_empty = frozenset(
            group.name
            for group in groups
            if not (group.links or group.chains or {*group.joints} - {joint} or {*group.subgroups} - empty)
        )
        if now_empty == empty:
            return empty
        empty = now_empty


def _group_without(group: PlanningGroup, joint: str, empty: frozenset[str]) -> PlanningGroup:
    joints = tuple(name for name in group.joints if name != joint)
    subgroups = tuple(name for name in group.subgroups if name not in empty)
    removed = {*(("joint", name) for name in group.joints if name not in joints)}
    removed |= {("group", name) for name in group.subgroups if name not in subgroups}
    return replace(group, joints=joints, subgroups=subgroups, extra_inside=_extras_without(group, removed))


def _state_without(state: GroupState, joint: str) -> GroupState:
    if joint not in state.joint_values:
        return state
    kept = {name: position for name, position in state.joint_values.items() if name != joint}
    extras = _extras_without(state, {("joint", joint)})
    return replace(state, joint_values=FrozenMap(kept), extra_inside=extras)


def _extras_without(part: PlanningGroup | GroupState, removed: Collection[tuple[str, str]]) -> tuple[Inside, ...]:
    return tuple(extra for extra in part.extra_inside if (extra.tag, extra.name) not in removed)
