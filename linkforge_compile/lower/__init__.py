"""Lower an expanded spec to the model: one robot from a file and all its modules."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics, UnresolvedNames, notes_of
from linkforge_compile.diagnostics.codes import model
from linkforge_compile.diagnostics.codes.names import UNKNOWN_JOINT, UNKNOWN_LINK
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.expand.instance import Instance, NameReference
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file import lower_file, unresolved_of
from linkforge_compile.lower.joint import check_joint_defaults, check_positions_of_module_joints
from linkforge_compile.lower.link import lower_links
from linkforge_compile.lower.merge_modules import Lowered, ModuleMerger
from linkforge_compile.lower.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.lower.mount import ModuleJoint
from linkforge_compile.lower.shapes import FileScope
from linkforge_compile.source import SourceFile
from linkforge_compile.source.provenance import uses_in
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.expand.module_cache import CacheOfCompile
    from linkforge_compile.lower.semantic import WrittenState


_SECTIONS_WITH_POSITIONS = frozenset({"transmissions", "gazebo"})
"""The sections with positions of joints, but for group states, which are resolved with those of modules."""


def lower(
    instance: Instance, sink: Diagnostics, meshes: MeshSolids | None = None, cache: CacheOfCompile | None = None
) -> Lowered:
    """Make one robot of a file and its modules: the parts of the file, then those of each module, as written.

    The parts of a module get its prefix, and its joint comes after them. Every fault is reported, and what is faulty is
    left out. `meshes` caches the meshes of this compile. `cache` has modules of earlier compiles.
    """
    lowered = _Lowering(sink, meshes or MeshSolids(), instance.shared_files, cache).lower(instance)
    if any(each.defaults is not None for each in instance.with_modules):
        check_defaults(instance, sink)
    return lowered


class _Lowering(NamedTuple):
    """The state of one compile; `shared_files` are those that are used more than once."""

    sink: Diagnostics
    meshes: MeshSolids
    shared_files: frozenset[SourceFile]
    cache: CacheOfCompile | None

    def lower_module(self, module: Instance) -> Lowered:
        """Lower a module, or take it from the cache if its Instance may be from there."""
        if not (self.cache and self.cache.has(module)):
            return self.lower(module)
        shared_files = self.shared_files.intersection(each.tree.span.file for each in module.with_modules if each.tree)
        lowered = self.cache.lowered(module, shared_files, partial(self.lower, module))
        return replace(lowered, robot=lowered.robot and _own_copy(lowered.robot))

    def lower(self, instance: Instance) -> Lowered:
        """Lower one use of a file, with its modules."""
        sink, tree, stack = self.sink, instance.tree, instance.include_stack
        if tree is None:
            return Lowered(None, (), UnresolvedNames(prefixes=("",)))
        file = lower_file(tree, instance.mesh_bases, stack, sink, MeshReader(instance.find_mesh, self.meshes))
        robot, is_compiled_file = file.robot, instance.entry is None
        texts = None
        if not is_compiled_file:
            from linkforge_compile.lower.unprefixed_names import passthrough_texts, prefix_warnings

            # Before modules are merged, because these have warnings of their own.
            users, is_shared = {use.file for use in stack}, tree.span.file in self.shared_files
            texts = passthrough_texts(robot, tree, instance.prefix, users, is_shared=is_shared)
        unresolved = file.unresolved | UnresolvedNames(deleted=instance.removed)
        lowered, mounts = Lowered(robot, (), unresolved), file.mounts
        if instance.modules or mounts:
            merger = ModuleMerger(file, unresolved, sink)
            for module in instance.modules:
                merger.add(module, self.lower_module(module))
            lowered, mounts = merger.finish(is_compiled_file=is_compiled_file)
        if file.states:
            faulty_states = _add_group_states(robot, file.states, mounts, lowered.unresolved)
            lowered = replace(lowered, unresolved=lowered.unresolved | faulty_states)
        if is_compiled_file and robot.has_semantic:
            from linkforge_compile.lower.semantic import group_by_name

            robot.semantic = group_by_name(robot.semantic)
        if texts:
            uses = notes_of(uses_in(stack))
            warnings = (replace(one, notes=(*one.notes, *uses)) for one in prefix_warnings(texts, robot))
            lowered = replace(lowered, prefix_warnings=(*lowered.prefix_warnings, *warnings))
        if instance.modules and not _SECTIONS_WITH_POSITIONS.isdisjoint(tree.entries):
            joints = _joints_by_name(robot, [lowered.mount] if lowered.mount else [])
            check_positions_of_module_joints(Fields(tree, "robot", sink, stack), joints)
        check_name_lookups(instance.references, robot, lowered.unresolved_alone, sink)
        return lowered


def _own_copy(robot: Robot) -> Robot:
    """Return a robot that may be changed, as may its links; other parts are immutable."""
    own = copy(robot)
    own.links = map(copy, robot.links)
    return own


def _add_group_states(
    robot: Robot, written: Sequence[WrittenState], mounts: Sequence[ModuleJoint], unresolved: UnresolvedNames
) -> UnresolvedNames:
    """Add the group states of a file, which may refer to those of its modules; return the names of faulty ones."""
    from linkforge_compile.lower.semantic import NamesInScope, resolve_states

    semantic = robot.semantic
    scope = NamesInScope(
        groups=dict.fromkeys(group.name for group in semantic.groups),
        joints=_joints_by_name(robot, mounts),
        states={(state.group, state.name): state.joint_values for state in semantic.group_states},
        unresolved=unresolved,
    )
    states = resolve_states(written, scope)
    robot.semantic = semantic.with_fields(group_states=(*states, *semantic.group_states))
    return unresolved_of({state.name for state in written} - {state.name for state in states})


def _joints_by_name(robot: Robot, mounts: Iterable[ModuleJoint]) -> Mapping[str, Joint | None]:
    """Return the joints of a robot and its mounts, None for a faulty mount."""
    return {joint.name: joint for joint in robot.joints} | {mount.name: mount.joint for mount in mounts}


def check_name_lookups(
    references: Iterable[NameReference], robot: Robot, unresolved: UnresolvedNames, sink: Diagnostics
) -> None:
    """Report `link('x')` and `joint('x')` in expressions if neither the file nor its modules have such a part."""
    known = {"link": (robot.links.names, UNKNOWN_LINK), "joint": (robot.joints.names, UNKNOWN_JOINT)}
    for reference in references:
        names, code = known[reference.kind]
        if reference.name not in names and reference.name not in unresolved:
            notes = unresolved.deleted.notes(reference.name)
            sink.report(code.at(reference.where, name=reference.name, near=() if notes else names, notes=notes))


_VALUE_CODES = frozenset(
    {
        model.WRONG_KIND,
        model.WRONG_DIMENSION,
        model.UNKNOWN_UNIT,
        model.NOT_FINITE,
        model.OUT_OF_RANGE,
        model.UNKNOWN_CHOICE,
        model.WRONG_COUNT,
        model.WIDE_ANGLE,
        model.LONG_LENGTH,
        model.UNKNOWN_AXIS,
        model.ZERO_AXIS,
        XACRO_EXPRESSION,
    }
)
"""The faults of single values. What an element lacks or may not have is reported for the entries that inherit."""


def check_defaults(instance: Instance, sink: Diagnostics) -> None:
    """Report faulty values in the defaults of a file and of its modules, unless reported for an entry."""
    from linkforge_compile.lower.devices import lower_devices

    reported = {(found.code, place) for found in sink for place in (found.span, *(note.span for note in found.notes))}
    for each in instance.with_modules:
        entries = _as_entries(each.defaults) if each.defaults else None
        if entries is None:
            continue
        faults = Diagnostics()
        file = Fields(entries, "defaults", faults, each.include_stack)
        deque(lower_links(file, FileScope()), maxlen=0)
        deque(file.each("joints", "joint", check_joint_defaults), maxlen=0)
        lower_devices(file)
        sink.report_all(
            fault for fault in faults if fault.code in _VALUE_CODES and (fault.code, fault.span) not in reported
        )


def _as_entries(defaults: YamlMap) -> YamlMap | None:
    """Return the sections of a file with one entry for each default, None for no defaults."""

    def fields_of(**nodes: YamlNode | None) -> YamlMap | None:
        entries = {name: _entry(name, node) for name, node in nodes.items() if node is not None}
        return YamlMap(entries, defaults.span) if entries else None

    shapes = fields_of(visual=defaults.get("visual"), collision=defaults.get("collision"))
    return fields_of(
        links=fields_of(link=defaults.get("link"), shapes=shapes),
        joints=fields_of(joint=defaults.get("joint")),
        sensors=fields_of(sensor=defaults.get("sensor")),
    )


def _entry(name: str, node: YamlNode) -> YamlEntry:
    return YamlEntry(YamlScalar(name, name, node.span), node)
