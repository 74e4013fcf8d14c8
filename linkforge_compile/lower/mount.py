"""`mount`: the joint by which a file hangs on a link of whoever uses it, or on `world` by itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from linkforge_compile.core.constants import WORLD
from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    MOUNT_AND_JOINT,
    MOUNT_NOT_AT_ROOT,
    MOUNT_SAYS_ENDS,
    TWO_MOUNTS,
)
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.lower.duplicates import tell_duplicate
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import Ends, joint_between
from linkforge_compile.lower.module_joint import ModuleJoint, gazebo_of, module_fields
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlMap

_ENDS = ("parent", "origin")
"""What is said of a mount by the entry that uses its file."""


def lower_mounts(file: Fields) -> list[ModuleJoint]:
    """Lower what a file says under `mount`, each joint with `world` in the place of the link that it will hang on."""
    if file.node.get("mount") is None:
        return []
    lowered = file.each("mount", "joint", _lower)
    return [mount or ModuleJoint(name, None) for name, mount in lowered]


def _lower(fields: Fields, name: str) -> ModuleJoint:
    for end in _ENDS:
        if (said := fields.node.get(end)) is not None:
            fields.tell(MOUNT_SAYS_ENDS, said, owner=fields.owner, field=end)
    valid_name = name if fields.name_is_valid(name, "joint") else None
    joint_type = fields.choice("type", JointType, required="revolute")
    ends = Ends(WORLD, fields.text("child", required="hip"), Transform.identity())
    return ModuleJoint(name, joint_between(fields, valid_name, joint_type, ends), gazebo_of(fields, name))


def only_mount(mounts: Sequence[ModuleJoint], sink: Diagnostics) -> ModuleJoint | None:
    """Return the joint by which a robot hangs, None where it has none; a second one is reported."""
    for mount in mounts[1:]:
        if mount.joint and mounts[0].joint:
            notes = [Note("the first is here", mounts[0].joint.source.span)] if mounts[0].joint.source else []
            sink.report(TWO_MOUNTS.at(mount.joint.source, joint=mount.name, first=mounts[0].name, notes=notes))
    return mounts[0] if mounts else None


def handed_on(mount: ModuleJoint, prefix: str) -> ModuleJoint:
    """Return the mount of a module as that of the robot which has the module's root for its own."""
    joint = mount.joint.with_prefix(prefix) if mount.joint else None
    # The prefix is for what is in the module, and the link that it hangs on is not.
    joint = replace(joint, parent=WORLD) if joint else None
    return ModuleJoint(prefix + mount.name, joint, tuple(one.with_prefix(prefix) for one in mount.gazebo))


def hung_by(mount: ModuleJoint, module: Instance, root: str | None, sink: Diagnostics) -> ModuleJoint:
    """Return the mount of a module, with its final names, as the joint to the link that its entry names.

    `root` is the final name of the module's root link, None where it has no single one.
    """
    written = module_fields(module, sink)
    whole = handed_on(mount, module.prefix)
    if written is None or whole.joint is None:
        return whole
    if (said := written.node.get("joint")) is not None:
        written.tell(MOUNT_AND_JOINT, said, owner=written.owner, joint=mount.name)
    parent, origin = written.text("parent"), written.origin()
    if parent is None or not _holds_root(whole, root, module.prefix, sink):
        return whole._replace(joint=None)
    joint = replace(whole.joint, source=_with_ends_of(written.node, whole.joint.source))
    return whole._replace(joint=written.build(lambda: replace(joint, parent=parent, origin=origin)))


def _with_ends_of(entry: YamlMap, mount: SourceRef | None) -> SourceRef | None:
    """Return where a mount stands, with the ends that the entry of its module says for it."""
    if mount is None or not isinstance(mount.node, YamlMap):
        return mount
    ends = {key: said for key in _ENDS if (said := entry.entries.get(key))}
    return replace(mount, node=YamlMap({**mount.node.entries, **ends}, mount.node.span))


def hang_on_world(robot: Robot, mount: ModuleJoint, root: str | None, sink: Diagnostics) -> UnresolvedNames:
    """Hang a compiled robot on the link `world`, its first, made unless it is declared; returns what it lacks now.

    For a robot without a single root none is made, so that what is told of its roots names what its author wrote.
    """
    if mount.joint is None or not _holds_root(mount, root, "", sink):
        return UnresolvedNames(frozenset([mount.name]))
    if root is None and WORLD not in robot.links:
        return UnresolvedNames(mounts=frozenset([mount.name, WORLD]))
    if (other := robot.joints.get(mount.name)) is not None:
        tell_duplicate(sink, "joint", mount.name, mount.joint.source, other.source)
        return UnresolvedNames(frozenset([mount.name]))
    declared = robot.links.get(WORLD) if WORLD in robot.links else None
    world = declared or Link(WORLD, source=mount.joint.source)
    robot.links = (world, *(link for link in robot.links if link.name != WORLD))
    robot.joints = (mount.joint, *robot.joints)
    robot.gazebo_elements = (*mount.gazebo, *robot.gazebo_elements)
    return UnresolvedNames()


def _holds_root(mount: ModuleJoint, root: str | None, prefix: str, sink: Diagnostics) -> bool:
    """Whether a mount holds the root link, as far as there is one; reports where it does not."""
    joint = mount.joint
    if joint is None or root is None or joint.child == root:
        return True
    child, expected = joint.child.removeprefix(prefix), root.removeprefix(prefix)
    sink.report(
        MOUNT_NOT_AT_ROOT.at(joint.source, "child", joint=mount.name.removeprefix(prefix), link=child, root=expected)
    )
    return False
