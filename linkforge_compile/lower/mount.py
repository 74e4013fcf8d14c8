"""The joint between a module and the robot that uses it: written in the module's entry, or as `mount` in its file."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.constants import WORLD
from linkforge_compile.core.models.geometry import IDENTITY
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import FrozenMap
from linkforge_compile.diagnostics import Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    JOINT_WITHOUT_PARENT,
    MOUNT_AND_JOINT,
    MOUNT_NOT_AT_ROOT,
    MOUNT_SAYS_ENDS,
    TWO_MOUNTS,
)
from linkforge_compile.diagnostics.entry_fixes import leave_out
from linkforge_compile.expand.instance import Instance, joint_name_of
from linkforge_compile.lower.elements import lower_pose
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import JointEnds, joint_between
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement
    from linkforge_compile.core.models.srdf import GroupState, PlanningGroup, SemanticRobotDescription
    from linkforge_compile.core.part import Inside


_ENDS = ("parent", "origin")
"""The fields of a mount that the entry of its module has."""


class ModuleJoint(NamedTuple):
    """The name of a module's joint, the joint, None for a faulty one, and its Gazebo blocks."""

    name: str
    joint: Joint | None
    gazebo: tuple[GazeboElement, ...] = ()


def module_fields(module: Instance, sink: Diagnostics) -> Fields | None:
    """Return the entry of `modules` that uses a module, None for the compiled file itself."""
    entry = module.entry
    if entry is None or not isinstance(entry.node, YamlMap):
        return None
    return Fields(entry.node, f"module '{module.name}'", sink, entry.trail, entry.key)


# The joint in the module's entry


def lower_module_joint(module: Instance, root: str | None, sink: Diagnostics) -> ModuleJoint | None:
    """Lower the joint from a module's `parent` to its root link (final name; None where it has no single one).

    Returns None for a module without `parent`, which is the base of the robot that uses it. If it has fields of a joint
    all the same, they are reported, and the joint is a faulty one.
    """
    entry = module_fields(module, sink)
    if entry is None:
        return None
    if entry.node.get("parent") is None:
        others = [(field, node) for field in ("joint", "origin") if (node := entry.node.get(field)) is not None]
        for field, node in others:
            fix = leave_out(entry.ref, field)
            entry.report(JOINT_WITHOUT_PARENT, node, fixes=[fix], owner=entry.owner, field=field)
        return ModuleJoint(joint_name_of(module.name, entry.node), None) if others else None
    default = f"{module.name}_joint"
    valid_name = _lower_name(entry, default)
    name = valid_name or default
    joint = _as_joint(entry, name)
    joint_type = JointType.FIXED if joint.node.get("type") is None else joint.choice("type", JointType)
    ends = JointEnds(joint.text("parent"), root, lower_pose(joint))
    return ModuleJoint(name, joint_between(joint, valid_name, joint_type, ends), _lower_gazebo(joint, name))


def _lower_name(entry: Fields, default: str) -> str | None:
    """Read the name of the joint: `joint` itself, or `name` in it; None for a faulty one."""
    node = entry.node.get("joint")
    if isinstance(node, YamlMap):
        joint = entry.map_at(node, "joint")
        if joint and node.get("name") is not None:
            return joint.name("name", "joint")
    elif node is not None:
        return entry.name("joint", "joint")
    return default if entry.name_is_valid(default, "joint") else None


def _as_joint(entry: Fields, name: str) -> Fields:
    """Return the entry in the form of a joint: the fields in its `joint`, with its `parent` and `origin`."""
    joint = entry.node.get("joint")
    fields = joint.entries if isinstance(joint, YamlMap) else {}
    key = joint if isinstance(joint, YamlScalar) else joint and joint.child("name")
    node = YamlMap({**fields, **_ends_in(entry.node)}, entry.node.span)
    return Fields(node, f"joint '{name}'", entry.sink, entry.trail, key or entry.key)


def _ends_in(entry: YamlMap) -> dict[str, YamlEntry]:
    return {key: entry.entries[key] for key in _ENDS if key in entry.entries}


def _lower_gazebo(joint: Fields, name: str) -> tuple[GazeboElement, ...]:
    if joint.node.get("gazebo") is None:
        return ()
    from linkforge_compile.lower.devices import lower_gazebo

    return tuple(lower_gazebo(joint, name, {name: joint.node}))


# The mount in the module's file


def lower_mounts(file: Fields) -> Iterator[ModuleJoint]:
    """Lower the joints in `mount`, with `world` as the parent until the file is used."""
    for name, mount in file.each("mount", "joint", _lower_mount):
        yield mount or ModuleJoint(name, None)


def _lower_mount(fields: Fields, name: str) -> ModuleJoint:
    for end in _ENDS:
        if (node := fields.node.get(end)) is not None:
            fields.report(MOUNT_SAYS_ENDS, node, owner=fields.owner, field=end)
    valid_name = name if fields.name_is_valid(name, "joint") else None
    joint_type = fields.choice("type", JointType, required="revolute")
    ends = JointEnds(WORLD, fields.text("child", required="hip"), IDENTITY)
    return ModuleJoint(name, joint_between(fields, valid_name, joint_type, ends), _lower_gazebo(fields, name))


def single_mount(mounts: Sequence[ModuleJoint], sink: Diagnostics) -> ModuleJoint | None:
    """Return the first mount of a robot, None for no mount; report further ones."""
    for mount in mounts[1:]:
        if mount.joint and mounts[0].joint:
            notes = [Note("the first is here", mounts[0].joint.source.span)] if mounts[0].joint.source else []
            sink.report(TWO_MOUNTS.at(mount.joint.source, joint=mount.name, first=mounts[0].name, notes=notes))
    return mounts[0] if mounts else None


def inherit_mount(mount: ModuleJoint, prefix: str) -> ModuleJoint:
    """Return the mount of a module as that of the robot that uses it, if both have the same root link."""
    joint = mount.joint.with_prefix(prefix) if mount.joint else None
    # The parent is not in the module, so it keeps its name.
    joint = joint.with_fields(parent=WORLD) if joint else None
    return ModuleJoint(prefix + mount.name, joint, tuple(block.with_prefix(prefix) for block in mount.gazebo))


def attach_mount(mount: ModuleJoint, module: Instance, root: str | None, sink: Diagnostics) -> ModuleJoint:
    """Return the mount of a module, with its final names, as the joint to the `parent` of the module's entry.

    `root` is the final name of the module's root link, None where it has no single one.
    """
    entry = module_fields(module, sink)
    final = inherit_mount(mount, module.prefix)
    if entry is None or final.joint is None:
        return final
    if (node := entry.node.get("joint")) is not None:
        fix = leave_out(entry.ref, "joint")
        entry.report(MOUNT_AND_JOINT, node, fixes=[fix], owner=entry.owner, joint=mount.name, section="mount")
    parent, origin = entry.text("parent"), lower_pose(entry)
    if parent is None or not _is_at_root(final, root, module.prefix, sink):
        return final._replace(joint=None)
    joint = final.joint.with_source(_with_ends_of(entry.node, final.joint.source))
    return final._replace(joint=entry.build(lambda: joint.with_fields(parent=parent, origin=origin)))


def take_shared_link(robot: Robot, module: Instance, sink: Diagnostics) -> tuple[ModuleJoint, ...]:
    """Take the link that is no link of a module out of its robot, and return the joints to it, now to the `parent`.

    The robot has its final names. Returns nothing for a module of which all links are its own.
    """
    entry = module_fields(module, sink)
    if entry is None or module.shared_link is None:
        return ()
    link, parent = module.prefix + module.shared_link, entry.text("parent")
    joints = [joint for joint in robot.joints if joint.parent == link]
    if (node := entry.node.get("joint")) is not None:
        fix, name = leave_out(entry.ref, "joint"), joints[0].name.removeprefix(module.prefix)
        entry.report(MOUNT_AND_JOINT, node, fixes=[fix], owner=entry.owner, joint=name, section="joints")
    robot.joints = tuple(joint for joint in robot.joints if joint.parent != link)
    robot.links = tuple(one for one in robot.links if one.name != link)
    return tuple(
        ModuleJoint(joint.name, joint.with_fields(parent=parent).with_source(source) if parent else None)
        for joint in joints
        for source in [_with_ends_of(entry.node, joint.source, ("parent",))]
    )


def _with_ends_of(entry: YamlMap, mount: SourceRef | None, ends: Sequence[str] = _ENDS) -> SourceRef | None:
    """Return the source of a mount, with the `parent` and `origin` of the entry of its module."""
    if mount is None or not isinstance(mount.node, YamlMap):
        return mount
    of_entry = {key: end for key, end in _ends_in(entry).items() if key in ends}
    return replace(mount, node=YamlMap({**mount.node.entries, **of_entry}, mount.node.span))


def attach_to_world(robot: Robot, mount: ModuleJoint, root: str | None, sink: Diagnostics) -> UnresolvedNames:
    """Attach the compiled robot to the link `world`, which is added unless declared; return names that are missing.

    A robot without a single root gets no `world`: messages about its roots name links that its author wrote.
    """
    if mount.joint is None or not _is_at_root(mount, root, "", sink):
        return UnresolvedNames(frozenset([mount.name]))
    if root is None and WORLD not in robot.links:
        return UnresolvedNames(mounts=frozenset([mount.name, WORLD]))
    if (other := robot.joints.get(mount.name)) is not None:
        report_duplicate(sink, "joint", mount.name, mount.joint.source, other.source)
        return UnresolvedNames(frozenset([mount.name]))
    world = robot.links.get(WORLD) or Link(WORLD).with_source(mount.joint.source)
    robot.links = (world, *(link for link in robot.links if link.name != WORLD))
    robot.joints = (mount.joint, *robot.joints)
    robot.gazebo_elements = (*mount.gazebo, *robot.gazebo_elements)
    return UnresolvedNames()


def _is_at_root(mount: ModuleJoint, root: str | None, prefix: str, sink: Diagnostics) -> bool:
    """Whether the child of a mount is the root link, if there is a single one; report it if not."""
    joint = mount.joint
    if joint is None or root is None or joint.child == root:
        return True
    child, expected = joint.child.removeprefix(prefix), root.removeprefix(prefix)
    sink.report(
        MOUNT_NOT_AT_ROOT.at(joint.source, "child", joint=mount.name.removeprefix(prefix), link=child, root=expected)
    )
    return False


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
        """What else is omitted, as the end of "virtual joint 'x' is omitted"; empty for nothing."""
        removed = f", with {', '.join(self.removed)}" if self.removed else ""
        return removed + (f", and taken out of {', '.join(self.changed)}" if self.changed else "")


def without_virtual_joint(semantic: SemanticRobotDescription, joint: str, prefix: str = "") -> SemanticWithoutJoint:
    """Remove a virtual joint, and what is empty without it; messages have names without the prefix.

    A group of nothing else is removed, with its states and end effectors. A state of another group stays even if it is
    empty, because other states may refer to it.
    """
    empty = _empty_groups(semantic.groups, joint)
    remaining = semantic.with_fields(
        virtual_joints=tuple(each for each in semantic.virtual_joints if each.name != joint),
        groups=tuple(_group_without(group, joint, empty) for group in semantic.groups if group.name not in empty),
        group_states=tuple(_state_without(state, joint) for state in semantic.group_states if state.group not in empty),
        end_effectors=tuple(
            effector.with_fields(parent_group=None) if effector.parent_group in empty else effector
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
    return group.with_fields(joints=joints, subgroups=subgroups, extra_inside=_extras_without(group, removed))


def _state_without(state: GroupState, joint: str) -> GroupState:
    if joint not in state.joint_values:
        return state
    kept = {name: position for name, position in state.joint_values.items() if name != joint}
    extras = _extras_without(state, {("joint", joint)})
    return state.with_fields(joint_values=FrozenMap(kept), extra_inside=extras)


def _extras_without(part: PlanningGroup | GroupState, removed: Collection[tuple[str, str]]) -> tuple[Inside, ...]:
    return tuple(extra for extra in part.extra_inside if (extra.tag, extra.name) not in removed)
