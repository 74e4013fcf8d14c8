"""Lower one file without its modules: its sections become the parts of a robot."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, UnresolvedNames
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.lower.elements import lower_pose, outer_extras_of
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.free_parts import PlainData
from linkforge_compile.lower.joint import JointEnds, joint_between, lower_joints
from linkforge_compile.lower.link import lower_links
from linkforge_compile.lower.mesh_solids import MeshReader
from linkforge_compile.lower.mount import ModuleJoint, lower_mounts
from linkforge_compile.lower.object_context import has_fault, report_duplicate
from linkforge_compile.lower.shapes import FileScope, lower_materials
from linkforge_compile.source import ModuleUse, SourceFile, SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, names_at_fault
from linkforge_compile.units import Quantity, number_text

if TYPE_CHECKING:
    from linkforge_compile.lower.devices import Devices
    from linkforge_compile.lower.semantic import LoweredSemantic, WrittenState

_SECTIONS_OF_NAMES = ("links", "joints", "frames", "mount", "modules", "semantic", "include")
_DEVICE_SECTIONS = frozenset({"sensors", "transmissions", "ros2_control", "controllers"})
_SECTIONS_OF_MATERIALS = ("materials", "include")
_SECTIONS_OF_SEMANTIC_NAMES = ("virtual_joints", "groups", "group_states", "end_effectors")


@dataclass(frozen=True)
class LoweredFile:
    """The robot of a file's own parts, its group states as written, its mounts, and names of what is faulty."""

    robot: Robot
    states: tuple[WrittenState, ...]
    unresolved: UnresolvedNames
    mounts: tuple[ModuleJoint, ...] = ()


def lower_file(
    tree: YamlMap,
    mesh_bases: Mapping[SourceFile, str],
    trail: tuple[ModuleUse, ...],
    sink: Diagnostics,
    meshes: MeshReader,
) -> LoweredFile:
    """Lower the sections of a file; report names that are defined twice at the second definition."""
    file = Fields(tree, "robot", sink, trail)
    scope = _scope_of(file, mesh_bases, meshes)
    links, joints = dict(lower_links(file, scope)), dict(lower_joints(file))
    for name, frame in file.each("frames", "frame", _lower_frame):
        _add_frame(frame or _Frame(name, f"{name}_joint"), links, joints, sink)
    semantic = _semantic(file)
    version, metadata = file.text("version"), tree.get("metadata")
    robot = Robot(
        file.name("name", "robot") or "robot",  # the schema reports a missing name
        version=IR_VERSION if version is None else version,
        version_stated=version is not None,
        materials=dict(scope.materials),
        metadata={entry.name: _plain_data(entry.value) for entry in metadata} if isinstance(metadata, YamlMap) else {},
        links=[link for link in links.values() if link],
        joints=[joint for joint in joints.values() if joint],
        **_devices_of(file),
        semantic=semantic.description if semantic else None,
        **outer_extras_of(file),
    )
    robot.source = SourceRef(tree, tree.get("name"), trail)
    faulty = [name for parts in (links, joints) for name, part in parts.items() if part is None]
    faulty += _names_without_part(tree.get("ros2_control"), {control.name for control in robot.ros2_controls})
    faulty += _names_without_part(tree.get("controllers"), {controller.name for controller in robot.controllers})
    unresolved = _unresolved_names(tree, faulty)
    if semantic:
        unresolved |= unresolved_of(semantic.faulty_names)
    return LoweredFile(robot, semantic.states if semantic else (), unresolved, tuple(lower_mounts(file)))


def _scope_of(file: Fields, mesh_bases: Mapping[SourceFile, str], meshes: MeshReader) -> FileScope:
    tree = file.node
    materials = lower_materials(file, FileScope(mesh_bases))
    unresolved = unresolved_of(name for name, material in materials.items() if material is None)
    unresolved |= unresolved_of(names_at_fault(tree))
    # A file without a name is included: the materials that it does not declare are in the file that includes it.
    if tree.get("name") is None or _has_fault_in(tree, _SECTIONS_OF_MATERIALS):
        unresolved |= UnresolvedNames(prefixes=("",))
    declared = {name: material for name, material in materials.items() if material}
    return FileScope(mesh_bases, declared, unresolved, meshes)


# Names of what is faulty


def unresolved_of(names: Iterable[str]) -> UnresolvedNames:
    """Return the names of faulty definitions; of a name with an expression that failed, the text before it."""
    whole: set[str] = set()
    prefixes = []
    for name in names:
        start, *expressions = re.split(r"\$[({]", name, maxsplit=1)
        if expressions:
            prefixes.append(start)
        else:
            # References to an invalid name may have it with its invalid characters replaced.
            whole |= {name, *(re.sub(r"[^\w.-]", substitute, name) for substitute in ("_", "-", ""))}
    return UnresolvedNames(frozenset(whole), tuple(prefixes))


def _unresolved_names(tree: YamlMap, faulty: Iterable[str]) -> UnresolvedNames:
    """Return the names of links and joints that are missing: faulty ones, and those in what could not be read."""
    semantic = tree.get("semantic")
    if (
        tree.get("name") is None
        or _has_fault_in(tree, _SECTIONS_OF_NAMES)
        or _has_fault_in(semantic, _SECTIONS_OF_SEMANTIC_NAMES)
    ):
        return unresolved_of(faulty) | UnresolvedNames(prefixes=("",))
    modules = (entry.name for entry in tree if isinstance(entry.value, YamlFault) and "use" in entry.value.keys)
    # A wrongly indented entry is among the keys of the one above.
    sections = [node for name in _SECTIONS_OF_NAMES if isinstance(node := tree.get(name), YamlMap)]
    entries = [
        entry
        for section in sections
        for entry in section
        if isinstance(entry.value, YamlMap) and has_fault(entry.value)
    ]
    return unresolved_of(
        [
            *faulty,
            *_with_faulty_mimic(entries, tree.get("joints")),
            *names_at_fault(tree),
            *names_at_fault(semantic),
            *(f"{name}_$(…)" for name in modules),  # any name of a module's part
            *(name for entry in entries for name in names_at_fault(entry.value)),
        ]
    )


def _names_without_part(section: YamlNode | None, names: Collection[str]) -> list[str]:
    """Return the names in a section that are not those of parts: what is there is faulty."""
    return [entry.name for entry in section if entry.name not in names] if isinstance(section, YamlMap) else []


def _with_faulty_mimic(faulty: Iterable[YamlEntry], joints: YamlNode | None) -> list[str]:
    """Return the joints that follow an unknown joint, because their `mimic` has a fault."""
    entries = joints.entries if isinstance(joints, YamlMap) else {}
    followers = [entry for entry in faulty if entries.get(entry.name) is entry]
    return [entry.name for entry in followers if _has_fault_in(entry.value, ("mimic",))]


def _has_fault_in(node: YamlNode | None, sections: tuple[str, ...]) -> bool:
    """Whether a map has a fault in one of these sections; its key may be misspelt."""
    faulty = [entry.name for entry in node if isinstance(entry.value, YamlFault)] if isinstance(node, YamlMap) else []
    return any(nearest(name, sections) for name in faulty)


# Frames


class _Frame(NamedTuple):
    """The link and the fixed joint of a frame, None for a faulty one, and their names."""

    link_name: str
    joint_name: str
    link: Link | None = None
    joint: Joint | None = None


def _lower_frame(fields: Fields, name: str) -> _Frame:
    is_valid = fields.name_is_valid(name, "frame")
    written_name = fields.text("joint")
    joint_name = f"{name}_joint" if written_name is None else written_name
    if written_name is not None and not fields.name_is_valid(written_name, "joint", fields.node.get("joint")):
        is_valid = False
    ends = JointEnds(fields.text("parent", required="base"), name, lower_pose(fields))
    joint = joint_between(fields, joint_name if is_valid else None, JointType.FIXED, ends)
    return _Frame(name, joint_name, Link(name).with_source(fields.ref) if joint else None, joint)


def _add_frame(
    frame: _Frame, links: dict[str, Link | None], joints: dict[str, Joint | None], sink: Diagnostics
) -> None:
    """Add the link and the joint of a frame, both or none."""
    if frame.link and (link := links.get(frame.link_name)):
        report_duplicate(sink, "link", frame.link_name, frame.link.source, link.source)
    if frame.joint and (joint := joints.get(frame.joint_name)):
        report_duplicate(sink, "joint", frame.joint_name, frame.joint.source, joint.source)
    is_duplicate = frame.link_name in links or frame.joint_name in joints
    if is_duplicate or not frame.link or not frame.joint:
        links.setdefault(frame.link_name, None)
        joints.setdefault(frame.joint_name, None)
        return
    links[frame.link_name], joints[frame.joint_name] = frame.link, frame.joint


# Other sections. The classes of one that a file does not have are not imported, which a command's start-up would pay.


def _devices_of(file: Fields) -> Devices:
    """Lower the sensors, transmissions, ros2_control systems and Gazebo blocks of a file."""
    parts = [
        entry.value for node in map(file.node.get, ("links", "joints")) if isinstance(node, YamlMap) for entry in node
    ]
    has_gazebo = any(isinstance(node, YamlMap) and "gazebo" in node.entries for node in (file.node, *parts))
    if not has_gazebo and _DEVICE_SECTIONS.isdisjoint(file.node.entries):
        return {}
    from linkforge_compile.lower.devices import lower_devices

    return lower_devices(file)


def _semantic(file: Fields) -> LoweredSemantic | None:
    if file.node.get("semantic") is None:
        return None
    from linkforge_compile.lower.semantic import lower_semantic

    return lower_semantic(file)


def _plain_data(node: YamlNode) -> PlainData:
    """Return an author's data; a number in a spelling that would change, such as the version 1.10, is a text."""
    match node:
        case YamlScalar(text=text, value=int() | float() as value) if not isinstance(value, bool):
            return value if number_text(value) == text else text
        case YamlScalar(text=text, value=value):
            return text if isinstance(value, Quantity) else value
        case YamlList():
            return [_plain_data(item) for item in node]
        case YamlMap():
            return {entry.name: _plain_data(entry.value) for entry in node}
        case YamlFault():
            return None
