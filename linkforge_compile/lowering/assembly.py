"""The fold: each use of a file becomes a robot, and the robots of its modules are merged into it."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.graph import refuse_cycles
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Gaps, Note, Removed
from linkforge_compile.diagnostics.codes.model import REFUSED, VIRTUAL_JOINT_LEFT_OUT
from linkforge_compile.diagnostics.codes.names import OWN_ATTRIBUTE_STAYS
from linkforge_compile.frozen import dataclass
from linkforge_compile.lowering.asked_names import tell_unknown_names
from linkforge_compile.lowering.clashes import Clash, told_of_clashes
from linkforge_compile.lowering.duplicates import tell_duplicate
from linkforge_compile.lowering.fields import Fields
from linkforge_compile.lowering.file import LoweredFile, gaps_of, lower_file
from linkforge_compile.lowering.joint import position_measure
from linkforge_compile.lowering.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.lowering.module_joint import ModuleJoint, lower_module_joint, module_fields
from linkforge_compile.lowering.mount import handed_on, hang_on_world, hung_by, only_mount
from linkforge_compile.lowering.positions import SAY_POSITIONS, judge_positions_elsewhere
from linkforge_compile.modules.assembly import Instance, joint_name_of
from linkforge_compile.source import SourceFile, SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.srdf import SemanticRobotDescription
    from linkforge_compile.lowering.unprefixed import PassedOn

PartKey: TypeAlias = tuple[str, Hashable]
"""What no two parts of a robot may share: a kind, "link", and the name or whatever else tells its parts apart."""


class Unmerged(NamedTuple):
    """The robot of a module that could not be joined, free of gaps: these say only what it lacks on purpose."""

    robot: Robot
    gaps: Gaps

    @property
    def name(self) -> str:
        return self.robot.name


@dataclass(frozen=True, slots=True)
class Lowered:
    """What lowering makes of an instance and of all its modules.

    `robot` is None where its file could not be read. `unmerged` are the robots of modules
    that could not be joined to it because they are no tree or repeat a name: checking them alone tells why.
    `gaps` names what the robot lacks because of faults, the parts of `unmerged` among them.
    `mount` is the joint by which it hangs where it is used, with `world` for the link that it hangs on.
    `under_a_prefix` is what there is to tell once the names of the robot take one.
    """

    robot: Robot | None
    unmerged: tuple[Unmerged, ...]
    gaps: Gaps
    under_a_prefix: tuple[Diagnostic, ...] = ()
    mount: ModuleJoint | None = None

    @property
    def gaps_alone(self) -> Gaps:
        """The gaps of a robot that hangs nowhere, and so lacks its mount."""
        return self.gaps | Gaps(mounts=frozenset([self.mount.name])) if self.mount else self.gaps


def lower(instance: Instance, sink: Diagnostics, meshes: MeshSolids | None = None) -> Lowered:
    """Make one robot of a file and of all its modules, in the order written: its own parts, then each module's.

    A module's parts take its prefix and are followed by its connecting joint. Every fault is reported, and what
    is faulty left out. `meshes` are those read so far in this compile, and takes up more.
    """
    lowered = _lowered(instance, sink, meshes or MeshSolids(), instance.shared_files)
    if any(one.defaults is not None for one in instance.with_modules):
        from linkforge_compile.lowering.defaults import judge_defaults

        judge_defaults(instance, sink)
    return lowered


def _lowered(instance: Instance, sink: Diagnostics, meshes: MeshSolids, shared: frozenset[SourceFile]) -> Lowered:
    """Lower a use; the files that are `shared` are used more than once."""
    if instance.tree is None:
        return Lowered(None, (), Gaps(prefixes=("",)))
    reader = MeshReader(instance.find_mesh, meshes)
    file = lower_file(instance.tree, instance.mesh_bases, instance.trail, sink, reader)
    fold = _Fold(file, instance, sink, is_shared=instance.tree.span.file in shared)
    for module in instance.modules:
        fold.add(module, _lowered(module, sink, meshes, shared))
    lowered = fold.finished(hangs_alone=instance.entry is None)
    if instance.modules and lowered.robot and not instance.tree.entries.keys().isdisjoint(SAY_POSITIONS):
        joints: dict[str, Joint | None] = {joint.name: joint for joint in lowered.robot.joints}
        joints |= {lowered.mount.name: lowered.mount.joint} if lowered.mount else {}
        judge_positions_elsewhere(Fields(instance.tree, "robot", sink, instance.trail), joints)
    if instance.references and lowered.robot:
        tell_unknown_names(instance.references, lowered.robot, lowered.gaps_alone, sink)
    return lowered


class _Fold:
    """A robot while modules are being joined to it."""

    def __init__(self, file: LoweredFile, instance: Instance, sink: Diagnostics, *, is_shared: bool) -> None:
        self._robot = file.robot
        self._states = file.states
        self._gaps = file.gaps | Gaps(removed=instance.removed)
        self._sink = sink
        self._unmerged: list[Unmerged] = []
        self._parts = dict(_parts(file.robot))
        self._parts.update((("group state", state.key), state.fields.ref) for state in file.states)
        self._owners: dict[PartKey, Instance] = {}
        self._held = {joint.child for joint in file.robot.joints}
        self._mounts = list(file.mounts)
        # Only a module takes a prefix.
        self._passed_on = _passed_on(file.robot, instance, is_shared) if instance.entry else None
        self._under_a_prefix: list[Diagnostic] = []

    def add(self, module: Instance, lowered: Lowered) -> None:
        """Join a module and the joint that it hangs by, or record what is missing now."""
        self._unmerged += lowered.unmerged
        if module.prefix:
            self._sink.report_all(lowered.under_a_prefix)
        else:
            self._under_a_prefix += lowered.under_a_prefix
        self._gaps |= lowered.gaps.with_prefix(module.prefix)
        component = lowered.robot
        root = _root_of(component) if component else None
        final_root = None if root is None else module.prefix + root
        is_whole = component is not None and (root is not None or bool(lowered.gaps))
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
            joined = self._leave_out(component, module.prefix, lowered.gaps_alone)
        elif clashes:
            self._sink.report_all(told_of_clashes(module, clashes))
            joined = self._leave_out(component, "", lowered.gaps_alone.with_prefix(module.prefix))
        else:
            held = hanging is not None or final_root in self._held
            gaps = lowered.gaps_alone.with_prefix(module.prefix)
            joined = self._join(component, module, gaps, final_root if held else None)
        if hanging and not (joined and self._connect(hanging)):
            self._gaps |= gaps_of([hanging.name])

    def _module_joint(self, module: Instance, own: ModuleJoint | None, root: str | None) -> ModuleJoint | None:
        """Return the joint by which a module hangs: its own, or that of its entry; None for the base of this robot."""
        if own is None:
            return lower_module_joint(module, root, self._sink)
        if module.entry is not None and module.entry.node.child("parent") is not None:
            if module.entry.node.child("joint") is not None:
                # It may not name one, which is told: whoever names that joint goes by the same mistake.
                self._gaps |= gaps_of([joint_name_of(module.name, module.entry.node)])
            return hung_by(own, module, root, self._sink)
        whole = handed_on(own, module.prefix)
        if lower_module_joint(module, root, self._sink):
            # What else is said of how it hangs shows that its parent was forgotten, which is told.
            return whole._replace(joint=None)
        self._mounts.append(whole)
        return None

    def finished(self, *, hangs_alone: bool) -> Lowered:
        """Return the robot with its group states, which may name those of its modules.

        One that has a mount and is nobody's module (`hangs_alone`) hangs on the world by it.
        """
        mount = only_mount(self._mounts, self._sink)
        self._gaps |= gaps_of(other.name for other in self._mounts[1:])
        if mount and hangs_alone:
            self._gaps |= hang_on_world(self._robot, mount, _root_of(self._robot), self._sink)
        if self._states:
            from linkforge_compile.lowering.srdf_states import Surroundings, resolve_states

            semantic = self._robot.semantic
            joints: dict[str, Joint | None] = {joint.name: joint for joint in self._robot.joints}
            joints |= {mount.name: mount.joint for mount in self._mounts}
            around = Surroundings(
                groups=dict.fromkeys(group.name for group in semantic.groups),
                joints=joints,
                measure=lambda name: position_measure(joints.get(name)),
                states={(state.group, state.name): state.joint_values for state in semantic.group_states},
                lost=self._gaps,
            )
            states = resolve_states(self._states, around)
            self._gaps |= gaps_of({state.name for state in self._states} - {state.name for state in states})
            self._robot.semantic = replace(semantic, group_states=(*states, *semantic.group_states))
        if hangs_alone and self._robot.says_semantic:
            from linkforge_compile.lowering.srdf_order import side_by_side

            self._robot.semantic = side_by_side(self._robot.semantic)
        if self._passed_on:
            from linkforge_compile.lowering.unprefixed import warnings_under_a_prefix

            self._under_a_prefix += warnings_under_a_prefix(self._passed_on, self._robot)
        return Lowered(self._robot, tuple(self._unmerged), self._gaps, tuple(self._under_a_prefix), mount)

    def _takes_prefix(self, module: Instance) -> bool:
        """Whether names may begin with the prefix of a module; told where they may not."""
        fields = module_fields(module, self._sink)
        if not module.prefix or not fields:
            return True
        return fields.name_is_valid(module.prefix, "prefix", fields.node.get("prefix") or fields.ref)

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

    def _join(self, component: Robot, module: Instance, gaps: Gaps, held: str | None) -> bool:
        """Merge a component, whose root `held` hangs on a link now; None for the root of the whole.

        The joint by which it hangs is added apart, for its parent may be a link of a module that comes later.
        """
        self._sink.report_all(self._attributes_that_stay(component, module))
        if held is not None and component.says_semantic:
            self._leave_out_virtual_joints(component, held, module.prefix)
        parts = dict(_parts(component))
        materials = [("material", name) for name in component.materials if name not in self._robot.materials]
        try:
            self._robot.merge(component, None, None)
        except RobotModelError as error:
            if not gaps:
                refusal = REFUSED.at(module.entry, owner=f"module '{module.name}'", reason=error.message)
                self._sink.report(refusal)
            return self._leave_out(component, "", gaps)
        self._parts.update(parts)
        self._owners.update(dict.fromkeys((*parts, *materials), module))
        return True

    def _attributes_that_stay(self, component: Robot, module: Instance) -> Iterator[Diagnostic]:
        """Yield what a module says of the whole robot that this file says otherwise."""
        whole = [("the robot", dict(self._robot.extra_attributes), dict(component.extra_attributes))]
        if self._robot.says_semantic and component.says_semantic:
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
            from linkforge_compile.lowering.left_out import without_virtual_joint

            left = without_virtual_joint(component.semantic, joint.name, prefix)
            component.semantic = left.semantic
            name, link = joint.name.removeprefix(prefix), root.removeprefix(prefix)
            self._sink.report(VIRTUAL_JOINT_LEFT_OUT.at(joint.source, joint=name, others=left.words, link=link))
            note = Note("left out with this virtual joint", joint.source.span if joint.source else None)
            self._gaps |= Gaps(removed=Removed(dict.fromkeys((joint.name, *left.groups), note)))

    def _connect(self, hanging: ModuleJoint) -> bool:
        """Add the joint that a module hangs by; its parent may belong to a module that comes later."""
        joint = hanging.joint
        if joint is None:
            return False
        if ("joint", joint.name) in self._parts:
            tell_duplicate(self._sink, "joint", joint.name, joint.source, self._parts["joint", joint.name])
            return False
        self._parts["joint", joint.name] = joint.source
        self._robot.joints = self._robot.joints.extended((joint,))
        if hanging.gazebo:
            self._robot.gazebo_elements = self._robot.gazebo_elements.extended(hanging.gazebo)
        return True

    def _leave_out(self, component: Robot, prefix: str, gaps: Gaps) -> bool:
        """Record a component's names as missing; one without gaps is to be checked alone. False: it is not joined."""
        names = (key for (_, key), _ in _parts(component) if isinstance(key, str))
        self._gaps |= Gaps(frozenset(prefix + name for name in names))
        if not gaps:
            self._unmerged.append(Unmerged(component, gaps))
        return False


def _passed_on(robot: Robot, instance: Instance, is_shared: bool) -> PassedOn | None:
    """Return what a file says that takes no prefix; None for one that was not read."""
    if instance.tree is None:
        return None
    from linkforge_compile.lowering.unprefixed import passed_on

    return passed_on(robot, instance.tree, instance.prefix, {use.file for use in instance.trail}, is_shared=is_shared)


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
    if robot.says_semantic:
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
        root = robot.root_link
        refuse_cycles(robot.joints)
    except RobotModelError:
        return None
    return root.name if len(robot.joints) == len(robot.links) - 1 else None
