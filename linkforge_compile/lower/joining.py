"""The fold: the robots of its modules are merged into that of a file, each with the joint that it hangs by."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.graph import tree_root
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import DeletedNames, Diagnostic, Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import REFUSED, VIRTUAL_JOINT_LEFT_OUT
from linkforge_compile.diagnostics.codes.names import OWN_ATTRIBUTE_STAYS
from linkforge_compile.expand.assembly import Instance, joint_name_of
from linkforge_compile.lower.clashes import Clash, told_of_clashes
from linkforge_compile.lower.duplicates import tell_duplicate
from linkforge_compile.lower.file import LoweredFile, unresolved_of
from linkforge_compile.lower.lowered import Lowered, Unmerged
from linkforge_compile.lower.module_joint import ModuleJoint, lower_module_joint, module_fields
from linkforge_compile.lower.mount import handed_on, hang_on_world, hung_by, only_mount
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import SemanticRobotDescription

PartKey: TypeAlias = tuple[str, Hashable]
"""What no two parts of a robot may share: a kind, "link", and the name or whatever else tells its parts apart."""


class Joining:
    """A robot while modules are being joined to it."""

    def __init__(self, file: LoweredFile, unresolved: UnresolvedNames, sink: Diagnostics) -> None:
        """`unresolved` is what the file lacks."""
        self._robot = file.robot
        self._unresolved = unresolved
        self._sink = sink
        self._unmerged: list[Unmerged] = []
        self._parts = dict(_parts(file.robot))
        self._parts.update((("group state", state.key), state.fields.ref) for state in file.states)
        self._owners: dict[PartKey, Instance] = {}
        self._held = {joint.child for joint in file.robot.joints}
        self._mounts = list(file.mounts)
        self._under_a_prefix: list[Diagnostic] = []

    def add(self, module: Instance, lowered: Lowered) -> None:
        """Join a module and the joint that it hangs by, or record what is missing now."""
        self._unmerged += lowered.unmerged
        if module.prefix:
            self._sink.report_all(lowered.under_a_prefix)
        else:
            self._under_a_prefix += lowered.under_a_prefix
        self._unresolved |= lowered.unresolved.with_prefix(module.prefix)
        component = lowered.robot
        root = _root_of(component) if component else None
        final_root = None if root is None else module.prefix + root
        is_whole = component is not None and (root is not None or bool(lowered.unresolved))
        takes_prefix = self._takes_prefix(module)
        is_named = component is not None and is_whole and takes_prefix
        if component and is_named:
            component.prefix_all(module.prefix)
        clashes = tuple(self._clashes(component)) if component and is_named else ()
        # What a clash keeps out is not judged for where it would hang.
        mount = lowered.mount if takes_prefix else lowered.mount and lowered.mount._replace(joint=None, gazebo=())
        hanging = self._module_joint(module, mount, None if clashes else final_root)
        if component is None:
            joined = False
        elif not is_named:
            joined = self._leave_out(component, module.prefix, lowered.unresolved_alone)
        elif clashes:
            self._sink.report_all(told_of_clashes(module, clashes))
            joined = self._leave_out(component, "", lowered.unresolved_alone.with_prefix(module.prefix))
        else:
            held = hanging is not None or final_root in self._held
            unresolved = lowered.unresolved_alone.with_prefix(module.prefix)
            joined = self._join(component, module, unresolved, final_root if held else None)
        if hanging and not (joined and self._connect(hanging)):
            self._unresolved |= unresolved_of([hanging.name])

    def _module_joint(self, module: Instance, own: ModuleJoint | None, root: str | None) -> ModuleJoint | None:
        """Return the joint by which a module hangs: its own, or that of its entry; None for the base of this robot."""
        if own is None:
            return lower_module_joint(module, root, self._sink)
        if module.entry is not None and module.entry.node.child("parent") is not None:
            if module.entry.node.child("joint") is not None:
                # It may not name one, which is told: whoever names that joint goes by the same mistake.
                self._unresolved |= unresolved_of([joint_name_of(module.name, module.entry.node)])
            return hung_by(own, module, root, self._sink)
        whole = handed_on(own, module.prefix)
        if lower_module_joint(module, root, self._sink):
            # What else is said of how it hangs shows that its parent was forgotten, which is told.
            return whole._replace(joint=None)
        self._mounts.append(whole)
        return None

    def finished(self, *, hangs_alone: bool) -> tuple[Lowered, tuple[ModuleJoint, ...]]:
        """Return the robot, and each joint by which it might hang.

        One that has a mount and is nobody's module (`hangs_alone`) hangs on the world by it.
        """
        mount = only_mount(self._mounts, self._sink)
        self._unresolved |= unresolved_of(other.name for other in self._mounts[1:])
        if mount and hangs_alone:
            self._unresolved |= hang_on_world(self._robot, mount, _root_of(self._robot), self._sink)
        lowered = Lowered(self._robot, tuple(self._unmerged), self._unresolved, tuple(self._under_a_prefix), mount)
        return lowered, tuple(self._mounts)

    def _takes_prefix(self, module: Instance) -> bool:
        """Whether names may begin with the prefix of a module; told where they may not."""
        fields = module_fields(module, self._sink)
        if not module.prefix or not fields:
            return True
        return fields.name_is_valid(module.prefix, "prefix", fields.node.get("prefix"))

    def _clashes(self, component: Robot) -> Iterator[Clash]:
        """Yield every part whose final name is taken already; materials that are equal may share one."""
        for (kind, key), _ in _parts(component):
            if (kind, key) in self._parts:
                name = "/".join(map(str, key)) if isinstance(key, tuple) else str(key)
                yield Clash(f"{kind} '{name}'", self._owners.get((kind, key)), self._parts[kind, key])
        for name, material in component.materials.items():
            own = self._robot.materials.get(name, material)
            if own != material:
                yield Clash(f"material '{name}'", self._owners.get(("material", name)), own.source)

    def _join(self, component: Robot, module: Instance, unresolved: UnresolvedNames, held: str | None) -> bool:
        """Merge a component, whose root `held` hangs on a link now; None for the root of the whole.

        The joint by which it hangs is added apart, for its parent may be a link of a module that comes later.
        """
        self._sink.report_all(self._attributes_that_stay(component, module))
        if held is not None and component.has_semantic:
            self._leave_out_virtual_joints(component, held, module.prefix)
        parts = dict(_parts(component))
        materials = [("material", name) for name in component.materials if name not in self._robot.materials]
        try:
            self._robot.merge(component, None, None)
        except RobotModelError as error:
            if not unresolved:
                refusal = REFUSED.at(module.entry, owner=f"module '{module.name}'", reason=error.message)
                self._sink.report(refusal)
            return self._leave_out(component, "", unresolved)
        self._parts.update(parts)
        self._owners.update(dict.fromkeys((*parts, *materials), module))
        return True

    def _attributes_that_stay(self, component: Robot, module: Instance) -> Iterator[Diagnostic]:
        """Yield what a module says of the whole robot that this file says otherwise."""
        whole = [("the robot", dict(self._robot.extra_attributes), dict(component.extra_attributes))]
        if self._robot.has_semantic and component.has_semantic:
            own, other = self._robot.semantic, component.semantic
            whole.append(("the SRDF", dict(own.extra_attributes), dict(other.extra_attributes)))
        for owner, ours, theirs in whole:
            for name, value in theirs.items():
                if ours.get(name, value) != value:
                    yield OWN_ATTRIBUTE_STAYS.at(
                        module.entry,
                        what=f"attribute '{name}' of {owner}",
                        module=module.name,
                        theirs=value,
                        ours=ours[name],
                    )

    def _leave_out_virtual_joints(self, component: Robot, root: str, prefix: str) -> None:
        """Leave out how a module would stand in the world by itself, once it hangs on a link, and what names that.

        Told with the names that its file writes, so once for a file that is used twice.
        """
        for joint in component.semantic.virtual_joints:
            if joint.child_link != root:
                continue
            from linkforge_compile.lower.left_out import without_virtual_joint

            left = without_virtual_joint(component.semantic, joint.name, prefix)
            component.semantic = left.semantic
            name, link = joint.name.removeprefix(prefix), root.removeprefix(prefix)
            self._sink.report(VIRTUAL_JOINT_LEFT_OUT.at(joint.source, joint=name, others=left.words, link=link))
            note = Note("left out with this virtual joint", joint.source.span if joint.source else None)
            deleted = DeletedNames(dict.fromkeys((joint.name, *left.groups), note))
            self._unresolved |= UnresolvedNames(deleted=deleted)

    def _connect(self, hanging: ModuleJoint) -> bool:
        """Add the joint that a module hangs by; its parent may belong to a module that comes later."""
        joint = hanging.joint
        if joint is None:
            return False
        if ("joint", joint.name) in self._parts:
            tell_duplicate(self._sink, "joint", joint.name, joint.source, self._parts["joint", joint.name])
            return False
        self._parts["joint", joint.name] = joint.source
        self._robot.add_parts(joints=[joint], gazebo_elements=hanging.gazebo)
        return True

    def _leave_out(self, component: Robot, prefix: str, unresolved: UnresolvedNames) -> bool:
        """Record a component's names as missing; a complete one is to be checked alone. False: it is not joined."""
        names = (key for (_, key), _ in _parts(component) if isinstance(key, str))
        self._unresolved |= UnresolvedNames(frozenset(prefix + name for name in names))
        if not unresolved:
            self._unmerged.append(Unmerged(component, unresolved))
        return False


def _parts(robot: Robot) -> Iterator[tuple[PartKey, SourceRef | None]]:
    """Yield what tells each part of a robot apart, and where the part was written."""
    for kind, parts in (
        ("link", robot.links),
        ("joint", robot.joints),
        ("sensor", robot.sensors),
        ("transmission", robot.transmissions),
        ("ros2_control", robot.ros2_controls),
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
    for approximation in semantic.link_sphere_approximations:
        yield ("sphere approximation", approximation.link), approximation.source
    for remark in semantic.joint_properties:
        yield ("joint property", (remark.joint_name, remark.property_name)), remark.source


def _root_of(robot: Robot) -> str | None:
    """Return the root link of a robot that is one tree, None where it is none."""
    try:
        root = tree_root(robot.links, robot.joints)
    except RobotModelError:
        return None
    return root if len(robot.joints) == len(robot.links) - 1 else None
