"""A semantic part without one of its virtual joints, and without all that names it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.models.srdf import GroupState, PlanningGroup, SemanticRobotDescription
from linkforge_compile.core.part import Inside


class Remainder(NamedTuple):
    """What is left of a semantic part; `gone` and `changed` name what named the joint, as messages say it.

    `groups` are the names of the groups that are gone.
    """

    semantic: SemanticRobotDescription
    groups: frozenset[str]
    gone: tuple[str, ...]
    changed: tuple[str, ...]

    @property
    def words(self) -> str:
        """What goes with the joint, to be put behind "virtual joint 'x' is left out"; empty for nothing."""
        gone = f", with {', '.join(self.gone)}" if self.gone else ""
        return gone + (f", and taken out of {', '.join(self.changed)}" if self.changed else "")


def without_virtual_joint(semantic: SemanticRobotDescription, joint: str, prefix: str = "") -> Remainder:
    """Take a virtual joint out, and what is empty without it; `gone` and `changed` leave out the prefix of names.

    A group of nothing else is gone, with its states and end effectors. A state of another group keeps its name,
    by which other states may take it over.
    """
    empty = _empty_groups(semantic.groups, joint)
    left = replace(
        semantic,
        virtual_joints=tuple(each for each in semantic.virtual_joints if each.name != joint),
        groups=tuple(_thinned(group, joint, empty) for group in semantic.groups if group.name not in empty),
        group_states=tuple(
            _without_position(state, joint) for state in semantic.group_states if state.group not in empty
        ),
        end_effectors=tuple(
            replace(effector, parent_group=None) if effector.parent_group in empty else effector
            for effector in semantic.end_effectors
            if effector.group not in empty
        ),
        passive_joints=tuple(passive for passive in semantic.passive_joints if passive.name != joint),
        joint_properties=tuple(remark for remark in semantic.joint_properties if remark.joint_name != joint),
    )
    gone = [("group", name) for group in semantic.groups if (name := group.name) in empty]
    gone += [("end effector", effector.name) for effector in semantic.end_effectors if effector.group in empty]
    gone += [("state", state.name) for state in semantic.group_states if state.group in empty]
    named = tuple(f"{kind} '{name.removeprefix(prefix)}'" for kind, name in gone)
    return Remainder(left, empty, named, tuple(_changed(semantic, left, prefix)))


def _changed(before: SemanticRobotDescription, after: SemanticRobotDescription, prefix: str) -> Iterator[str]:
    """Yield what is there still and says less than before."""
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
    """Return the groups that have no member but the joint, or but groups that are empty then."""
    empty: frozenset[str] = frozenset()
    while True:
        found = frozenset(
            group.name
            for group in groups
            if not (group.links or group.chains or {*group.joints} - {joint} or {*group.subgroups} - empty)
        )
        if found == empty:
            return empty
        empty = found


def _thinned(group: PlanningGroup, joint: str, empty: frozenset[str]) -> PlanningGroup:
    joints = tuple(name for name in group.joints if name != joint)
    subgroups = tuple(name for name in group.subgroups if name not in empty)
    gone = {*(("joint", name) for name in group.joints if name not in joints)}
    gone |= {("group", name) for name in group.subgroups if name not in subgroups}
    return replace(group, joints=joints, subgroups=subgroups, extra_inside=_inside_without(group, gone))


def _without_position(state: GroupState, joint: str) -> GroupState:
    if joint not in state.joint_values:
        return state
    kept = {name: position for name, position in state.joint_values.items() if name != joint}
    inside = _inside_without(state, {("joint", joint)})
    return replace(state, joint_values=FrozenMap(kept), extra_inside=inside)


def _inside_without(part: PlanningGroup | GroupState, gone: Collection[tuple[str, str]]) -> tuple[Inside, ...]:
    return tuple(one for one in part.extra_inside if (one.tag, one.name) not in gone)
