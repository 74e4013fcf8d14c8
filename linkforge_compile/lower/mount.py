"""The joint between a module and the robot that uses it: written in the module's entry, or as `mount` in its file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.constants import WORLD
from linkforge_compile.core.models.geometry import IDENTITY
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    JOINT_WITHOUT_PARENT,
    MOUNT_AND_JOINT,
    MOUNT_NOT_AT_ROOT,
    MOUNT_SAYS_ENDS,
    TWO_MOUNTS,
)
from linkforge_compile.expand.uses import Instance, joint_name_of
from linkforge_compile.lower.elements import lower_pose
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import JointEnds, joint_between
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement

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
            entry.report(JOINT_WITHOUT_PARENT, node, owner=entry.owner, field=field)
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
    from linkforge_compile.lower.gazebo import lower_gazebo

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
            notes = [Note("the first stands here", mounts[0].joint.source.span)] if mounts[0].joint.source else []
            sink.report(TWO_MOUNTS.at(mount.joint.source, joint=mount.name, first=mounts[0].name, notes=notes))
    return mounts[0] if mounts else None


def inherit_mount(mount: ModuleJoint, prefix: str) -> ModuleJoint:
    """Return the mount of a module as that of the robot that uses it, if both have the same root link."""
    joint = mount.joint.with_prefix(prefix) if mount.joint else None
    # The parent is not in the module, so it keeps its name.
    joint = replace(joint, parent=WORLD) if joint else None
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
        entry.report(MOUNT_AND_JOINT, node, owner=entry.owner, joint=mount.name)
    parent, origin = entry.text("parent"), lower_pose(entry)
    if parent is None or not _is_at_root(final, root, module.prefix, sink):
        return final._replace(joint=None)
    joint = replace(final.joint, source=_with_ends_of(entry.node, final.joint.source))
    return final._replace(joint=entry.build(lambda: replace(joint, parent=parent, origin=origin)))


def _with_ends_of(entry: YamlMap, mount: SourceRef | None) -> SourceRef | None:
    """Return the source of a mount, with the `parent` and `origin` of the entry of its module."""
    if mount is None or not isinstance(mount.node, YamlMap):
        return mount
    return replace(mount, node=YamlMap({**mount.node.entries, **_ends_in(entry)}, mount.node.span))


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
    world = robot.links.get(WORLD) or Link(WORLD, source=mount.joint.source)
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
