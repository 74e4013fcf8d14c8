"""Merge the robots of modules into that of the file that uses them, each with the joint that it is attached by."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.core.models.graph import tree_root
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import DeletedNames, Diagnostic, Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import REFUSED, VIRTUAL_JOINT_LEFT_OUT
from linkforge_compile.diagnostics.codes.names import (
    MATERIALS_DIFFER,
    MODULES_SHARE_NAMES,
    NAMES_OF_THIS_FILE,
    OWN_ATTRIBUTE_STAYS,
)
from linkforge_compile.expand.instance import Instance, joint_name_of
from linkforge_compile.lower.file import LoweredFile, unresolved_of
from linkforge_compile.lower.merge_managers import ManagerMerger
from linkforge_compile.lower.mount import (
    ModuleJoint,
    attach_mount,
    attach_to_world,
    inherit_mount,
    lower_module_joint,
    module_fields,
    single_mount,
    take_shared_link,
    without_virtual_joint,
)
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import SemanticRobotDescription

PartKey: TypeAlias = tuple[str, Hashable]
"""What is unique for each part of a robot: a kind, such as "link", and a name or other key."""


class Unmerged(NamedTuple):
    """The robot of a module that could not be merged, and names that it lacks."""

    robot: Robot
    unresolved: UnresolvedNames

    @property
    def name(self) -> str:
        return self.robot.name


@dataclass(frozen=True)
class Lowered:
    """A file lowered with all its modules.

    `robot` is None for a file that could not be read. `unmerged` are robots of modules that are no tree or have names
    that are defined already: checks of them alone tell why. `unresolved` are names that the robot lacks because of
    errors, parts of `unmerged` among them. `mount` is the joint that attaches the robot where it is used, with `world`
    as its parent. `prefix_warnings` are to be reported if the names of the robot get a prefix.
    """

    robot: Robot | None
    unmerged: tuple[Unmerged, ...]
    unresolved: UnresolvedNames
    prefix_warnings: tuple[Diagnostic, ...] = ()
    mount: ModuleJoint | None = None

    @property
    def robots(self) -> Iterator[tuple[Robot, UnresolvedNames]]:
        """Every robot with the names that it lacks, those that could not be merged first."""
        yield from self.unmerged
        if self.robot is not None:
            yield self.robot, self.unresolved

    @property
    def unresolved_alone(self) -> UnresolvedNames:
        """The names that the robot lacks while it is not attached to another one."""
        return self.unresolved | UnresolvedNames(mounts=frozenset([self.mount.name])) if self.mount else self.unresolved


class ModuleMerger:
    """Merges modules into the robot of a file, one by one."""

    def __init__(self, file: LoweredFile, unresolved: UnresolvedNames, sink: Diagnostics) -> None:
        """`unresolved` are names that the file lacks."""
        self._robot = file.robot
        self._unresolved = unresolved
        self._sink = sink
        self._unmerged: list[Unmerged] = []
        self._parts = dict(_parts(file.robot))
        self._parts.update((("group state", state.key), state.fields.ref) for state in file.states)
        self._owners: dict[PartKey, Instance] = {}
        self._managers = ManagerMerger(file.robot, sink)
        self._children = {joint.child for joint in file.robot.joints}
        self._mounts = list(file.mounts)
        self._prefix_warnings: list[Diagnostic] = []

    def add(self, module: Instance, lowered: Lowered) -> None:
        """Merge a module and its joint, or record the names that are missing without it."""
        self._unmerged += lowered.unmerged
        if module.prefix:
            self._sink.report_all(lowered.prefix_warnings)
        else:
            self._prefix_warnings += lowered.prefix_warnings
        self._unresolved |= lowered.unresolved.with_prefix(module.prefix)
        component = lowered.robot
        root = _root_of(component) if component else None
        final_root = None if root is None else module.prefix + root
        has_valid_prefix = self._has_valid_prefix(module)
        is_mergeable = has_valid_prefix and (root is not None or bool(lowered.unresolved))
        taken: tuple[ModuleJoint, ...] = ()
        if component and is_mergeable:
            component.prefix_all(module.prefix)
            taken = take_shared_link(component, module, self._sink)
        clashes = tuple(self._name_clashes(component)) if component and is_mergeable else ()
        mount = lowered.mount
        if mount and not has_valid_prefix:
            mount = mount._replace(joint=None, gazebo=())
        # With a clash the module is omitted, so that it does not matter whether its joint is at its root.
        joints = taken or (self._joint_of(module, mount, None if clashes else final_root),)
        is_merged = False
        if component and not is_mergeable:
            self._leave_out(component, module.prefix, lowered.unresolved_alone)
        elif component and clashes:
            report_name_clashes(module, clashes, self._sink)
            self._leave_out(component, "", lowered.unresolved_alone.with_prefix(module.prefix))
        elif component:
            is_attached = joints != (None,) or final_root in self._children
            unresolved = lowered.unresolved_alone.with_prefix(module.prefix)
            is_merged = self._merge(component, module, unresolved, final_root if is_attached else None)
        for joint in filter(None, joints):
            if not (is_merged and self._add_joint(joint)):
                self._unresolved |= unresolved_of([joint.name])

    def finish(self, *, is_compiled_file: bool) -> tuple[Lowered, tuple[ModuleJoint, ...]]:
        """Return the robot, and all of its mounts; the compiled file is attached to the world by its mount."""
        mount = single_mount(self._mounts, self._sink)
        self._unresolved |= unresolved_of(other.name for other in self._mounts[1:])
        if mount and is_compiled_file:
            self._unresolved |= attach_to_world(self._robot, mount, _root_of(self._robot), self._sink)
        lowered = Lowered(self._robot, tuple(self._unmerged), self._unresolved, tuple(self._prefix_warnings), mount)
        return lowered, tuple(self._mounts)

    def _joint_of(self, module: Instance, mount: ModuleJoint | None, root: str | None) -> ModuleJoint | None:
        """Return the joint of a module: its mount, or that of its entry; None for the base of this robot."""
        if mount is None:
            return lower_module_joint(module, root, self._sink)
        if module.entry is not None and module.entry.node.child("parent") is not None:
            if module.entry.node.child("joint") is not None:
                # The entry may not name the joint, which is reported; references to that name are follow-on errors.
                self._unresolved |= unresolved_of([joint_name_of(module.name, module.entry.node)])
            return attach_mount(mount, module, root, self._sink)
        inherited = inherit_mount(mount, module.prefix)
        if lower_module_joint(module, root, self._sink):
            # The entry has other fields of a joint, so it lacks a parent, which is reported.
            return inherited._replace(joint=None)
        self._mounts.append(inherited)
        return None

    def _has_valid_prefix(self, module: Instance) -> bool:
        """Whether names may begin with the prefix of a module; report it if not."""
        fields = module_fields(module, self._sink)
        if not module.prefix or not fields:
            return True
        return fields.name_is_valid(module.prefix, "prefix", fields.node.get("prefix"))

    def _name_clashes(self, component: Robot) -> Iterator[NameClash]:
        """Yield every part whose final name is defined already; materials that are equal may share one."""
        for (kind, key), _ in _parts(component):
            if (kind, key) in self._parts:
                name = "/".join(map(str, key)) if isinstance(key, tuple) else str(key)
                yield NameClash(f"{kind} '{name}'", self._owners.get((kind, key)), self._parts[kind, key])
        for name, material in component.materials.items():
            own = self._robot.materials.get(name, material)
            if own != material:
                owner = self._owners.get(("material", name))
                yield NameClash(f"material '{name}'", owner, own.source, material.source)

    def _merge(
        self, component: Robot, module: Instance, unresolved: UnresolvedNames, attached_root: str | None
    ) -> bool:
        """Merge the parts of a component; return whether it could be done.

        `attached_root` is its root if it is attached to a link, None if it is that of the whole robot. The joint is
        added apart, because its parent may be a link of a later module.
        """
        self._report_other_attributes(component, module)
        self._managers.move(component, module)
        if attached_root is not None and component.has_semantic:
            self._leave_out_virtual_joints(component, attached_root, module.prefix)
        parts = dict(_parts(component))
        materials = [("material", name) for name in component.materials if name not in self._robot.materials]
        try:
            self._robot.merge(component, None, None)
        except RobotModelError as error:
            if not unresolved:
                self._sink.report(REFUSED.at(module.entry, owner=f"module '{module.name}'", reason=error.message))
            self._leave_out(component, "", unresolved)
            return False
        self._parts.update(parts)
        self._owners.update(dict.fromkeys((*parts, *materials), module))
        return True

    def _report_other_attributes(self, component: Robot, module: Instance) -> None:
        """Report raw attributes of the robot and the SRDF that have another value in a module."""
        owners = [("the robot", dict(self._robot.extra_attributes), dict(component.extra_attributes))]
        if self._robot.has_semantic and component.has_semantic:
            own, other = self._robot.semantic, component.semantic
            owners.append(("the SRDF", dict(own.extra_attributes), dict(other.extra_attributes)))
        for owner, ours, theirs in owners:
            for name, value in theirs.items():
                if ours.get(name, value) != value:
                    what = f"attribute '{name}' of {owner}"
                    facts = {"what": what, "module": module.name, "theirs": value, "ours": ours[name]}
                    self._sink.report(OWN_ATTRIBUTE_STAYS.at(module.entry, notes=(), **facts))

    def _leave_out_virtual_joints(self, component: Robot, root: str, prefix: str) -> None:
        """Leave out the virtual joints of a module that is attached to a link, and what names them.

        Messages have the names of its file, so that they are the same if it is used twice.
        """
        for joint in component.semantic.virtual_joints:
            if joint.child_link != root:
                continue
            without = without_virtual_joint(component.semantic, joint.name, prefix)
            component.semantic = without.semantic
            name, link = joint.name.removeprefix(prefix), root.removeprefix(prefix)
            self._sink.report(VIRTUAL_JOINT_LEFT_OUT.at(joint.source, joint=name, others=without.words, link=link))
            note = Note("left out with this virtual joint", joint.source.span if joint.source else None)
            deleted = DeletedNames(dict.fromkeys((joint.name, *without.groups), note))
            self._unresolved |= UnresolvedNames(deleted=deleted)

    def _add_joint(self, module_joint: ModuleJoint) -> bool:
        """Add the joint of a module; return whether it could be done."""
        joint = module_joint.joint
        if joint is None:
            return False
        if ("joint", joint.name) in self._parts:
            report_duplicate(self._sink, "joint", joint.name, joint.source, self._parts["joint", joint.name])
            return False
        self._parts["joint", joint.name] = joint.source
        self._robot.add_parts(joints=[joint], gazebo_elements=module_joint.gazebo)
        return True

    def _leave_out(self, component: Robot, prefix: str, unresolved: UnresolvedNames) -> None:
        """Record the names of a component as missing; one that lacks nothing itself is to be checked alone."""
        names = (key for (_, key), _ in _parts(component) if isinstance(key, str))
        self._unresolved |= UnresolvedNames(frozenset(prefix + name for name in names))
        if not unresolved:
            self._unmerged.append(Unmerged(component, unresolved))


class NameClash(NamedTuple):
    """A part of a module whose name is defined already.

    `part` is its kind and final name in messages. `owner` is the module with the first definition, None for the file
    that uses both. `second` is the place of another material of that name, which might have been the same one.
    """

    part: str
    owner: Instance | None
    first: SourceRef | None
    second: SourceRef | None = None


def report_name_clashes(module: Instance, clashes: Iterable[NameClash], sink: Diagnostics) -> None:
    """Report the clashes of a module at its prefix, once for each owner of first definitions."""
    by_owner: dict[Instance | None, list[NameClash]] = {}
    for clash in clashes:
        by_owner.setdefault(clash.owner, []).append(clash)
    for owner, group in by_owner.items():
        part, more, first = group[0].part, len(group) - 1, group[0].first
        parts = f"{part} and {more} more" if more else part
        if group[0].second:  # materials come last, so that there are no other clashes
            who = f"module '{owner.name}'" if owner else "this file"
            places = (first.span if first else None, group[0].second.span)
            notes = [Note("it is declared here", place) for place in places]
            facts = {"module": module.name, "parts": parts, "first": who}
            sink.report(MATERIALS_DIFFER.at(module.entry, "prefix", notes=notes, **facts))
        elif owner is None:
            notes = [Note(f"{part} is here", first.span)] if first else []
            sink.report(NAMES_OF_THIS_FILE.at(module.entry, "prefix", module=module.name, parts=parts, notes=notes))
        else:
            notes = [Note(f"module '{owner.name}' is here", owner.entry.at("prefix"))] if owner.entry else []
            facts = {"first": owner.name, "second": module.name, "parts": parts}
            sink.report(MODULES_SHARE_NAMES.at(module.entry, "prefix", notes=notes, **facts))


def _parts(robot: Robot) -> Iterator[tuple[PartKey, SourceRef | None]]:
    """Yield the key of each part of a robot, and where it was written."""
    for kind, parts in (
        ("link", robot.links),
        ("joint", robot.joints),
        ("sensor", robot.sensors),
        ("transmission", robot.transmissions),
        ("ros2_control", robot.ros2_controls),
        ("controller", [one for one in robot.controllers if one.name != MANAGER]),
    ):
        for part in parts:
            yield (kind, part.name), part.source
    if robot.has_semantic:
        yield from _semantic_parts(robot.semantic)


def _semantic_parts(semantic: SemanticRobotDescription) -> Iterator[tuple[PartKey, SourceRef | None]]:
    yield from ((("virtual joint", joint.name), joint.source) for joint in semantic.virtual_joints)
    yield from ((("planning group", group.name), group.source) for group in semantic.groups)
    yield from ((("group state", (state.group, state.name)), state.source) for state in semantic.group_states)
    yield from ((("end effector", effector.name), effector.source) for effector in semantic.end_effectors)
    yield from ((("passive joint", joint.name), joint.source) for joint in semantic.passive_joints)
    yield from ((("sphere approximation", each.link), each.source) for each in semantic.link_sphere_approximations)
    for each in semantic.joint_properties:
        yield ("joint property", (each.joint_name, each.property_name)), each.source


def _root_of(robot: Robot) -> str | None:
    """Return the root link of a robot that is one tree, None for any other."""
    try:
        root = tree_root(robot.links, robot.joints)
    except RobotModelError:
        return None
    return root if len(robot.joints) == len(robot.links) - 1 else None
