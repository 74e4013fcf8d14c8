"""The verb of this room: each use of a file becomes a robot, and the robots of its modules are joined to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics, UnresolvedNames
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file import lower_file, unresolved_of
from linkforge_compile.lower.joint import position_measure
from linkforge_compile.lower.lowered import Lowered
from linkforge_compile.lower.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.source import SourceFile

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.lower.module_joint import ModuleJoint
    from linkforge_compile.lower.srdf_states import WrittenState
    from linkforge_compile.lower.unprefixed import PassedOn

_SAY_POSITIONS = frozenset({"transmissions", "gazebo"})
"""The sections of a file that say positions of joints beside the joints themselves; states are read apart."""


def lower(instance: Instance, sink: Diagnostics, meshes: MeshSolids | None = None) -> Lowered:
    """Make one robot of a file and of all its modules, in the order written: its own parts, then each module's.

    A module's parts take its prefix and are followed by its connecting joint. Every fault is reported, and what
    is faulty left out. `meshes` are those read so far in this compile, and takes up more.
    """
    lowered = _lowered(instance, sink, meshes or MeshSolids(), instance.shared_files)
    if any(one.defaults is not None for one in instance.with_modules):
        from linkforge_compile.lower.defaults import judge_defaults

        judge_defaults(instance, sink)
    return lowered


def _lowered(instance: Instance, sink: Diagnostics, meshes: MeshSolids, shared: frozenset[SourceFile]) -> Lowered:
    """Lower a use; the files that are `shared` are used more than once."""
    if instance.tree is None:
        return Lowered(None, (), UnresolvedNames(prefixes=("",)))
    reader = MeshReader(instance.find_mesh, meshes)
    file = lower_file(instance.tree, instance.mesh_bases, instance.include_stack, sink, reader)
    robot, is_alone = file.robot, instance.entry is None
    # Only a module takes a prefix. What it says without one is looked for before others are joined to it.
    passed_on = None if is_alone else _passed_on(robot, instance, is_shared=instance.tree.span.file in shared)
    lowered, mounts = Lowered(robot, (), file.unresolved | UnresolvedNames(deleted=instance.removed)), file.mounts
    if instance.modules or mounts:
        # What joins modules, and tells why it cannot, is imported for a robot that has some.
        from linkforge_compile.lower.joining import Joining

        joining = Joining(file, lowered.unresolved, sink)
        for module in instance.modules:
            joining.add(module, _lowered(module, sink, meshes, shared))
        lowered, mounts = joining.finished(hangs_alone=is_alone)
    if file.states:
        lowered = replace(
            lowered, unresolved=lowered.unresolved | _resolve_states(robot, file.states, mounts, lowered.unresolved)
        )
    if is_alone and robot.has_semantic:
        from linkforge_compile.lower.srdf_order import side_by_side

        robot.semantic = side_by_side(robot.semantic)
    if passed_on:
        from linkforge_compile.lower.unprefixed import warnings_under_a_prefix

        told = (*lowered.under_a_prefix, *warnings_under_a_prefix(passed_on, robot))
        lowered = replace(lowered, under_a_prefix=told)
    _judge_references(instance, lowered, sink)
    return lowered


def _resolve_states(
    robot: Robot, written: Sequence[WrittenState], mounts: Sequence[ModuleJoint], lost: UnresolvedNames
) -> UnresolvedNames:
    """Add the group states of a file to its robot: they may name those of its modules. Returns what is lost of them."""
    from linkforge_compile.lower.srdf_states import Surroundings, resolve_states

    semantic = robot.semantic
    joints: dict[str, Joint | None] = {joint.name: joint for joint in robot.joints}
    joints |= {mount.name: mount.joint for mount in mounts}
    around = Surroundings(
        groups=dict.fromkeys(group.name for group in semantic.groups),
        joints=joints,
        measure=lambda name: position_measure(joints.get(name)),
        states={(state.group, state.name): state.joint_values for state in semantic.group_states},
        lost=lost,
    )
    states = resolve_states(written, around)
    robot.semantic = replace(semantic, group_states=(*states, *semantic.group_states))
    return unresolved_of({state.name for state in written} - {state.name for state in states})


def _judge_references(instance: Instance, lowered: Lowered, sink: Diagnostics) -> None:
    """Report what a file says of parts of its modules, where they are none or other ones."""
    if instance.tree is None or lowered.robot is None:
        return
    if instance.modules and not _SAY_POSITIONS.isdisjoint(instance.tree.entries):
        from linkforge_compile.lower.positions import judge_positions_elsewhere

        joints: dict[str, Joint | None] = {joint.name: joint for joint in lowered.robot.joints}
        joints |= {lowered.mount.name: lowered.mount.joint} if lowered.mount else {}
        judge_positions_elsewhere(Fields(instance.tree, "robot", sink, instance.include_stack), joints)
    if instance.references:
        from linkforge_compile.lower.asked_names import tell_unknown_names

        tell_unknown_names(instance.references, lowered.robot, lowered.unresolved_alone, sink)


def _passed_on(robot: Robot, instance: Instance, *, is_shared: bool) -> PassedOn | None:
    """Return what a file says that takes no prefix; None for one that was not read."""
    if instance.tree is None:
        return None
    from linkforge_compile.lower.unprefixed import passed_on

    return passed_on(
        robot, instance.tree, instance.prefix, {use.file for use in instance.include_stack}, is_shared=is_shared
    )
