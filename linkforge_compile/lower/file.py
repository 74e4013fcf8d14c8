"""One file by itself: all that it says of a robot, without its modules."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, UnresolvedNames
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.lower.extra import outer_extras_of
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file_scope import FileScope
from linkforge_compile.lower.frame import Frame, lower_frames
from linkforge_compile.lower.joint import lower_joints
from linkforge_compile.lower.link import lower_links
from linkforge_compile.lower.material import lower_materials
from linkforge_compile.lower.mesh_solids import MeshReader
from linkforge_compile.lower.object_context import has_fault, report_duplicate
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, names_at_fault
from linkforge_compile.units import Quantity, number_text

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement
    from linkforge_compile.core.models.ros2_control import Ros2Control
    from linkforge_compile.core.models.sensor import Sensor
    from linkforge_compile.core.models.transmission import Transmission
    from linkforge_compile.lower.group_states import WrittenState
    from linkforge_compile.lower.module_joint import ModuleJoint
    from linkforge_compile.lower.srdf import LoweredSemantic

_SECTIONS_OF_NAMES = ("links", "joints", "frames", "mount", "modules", "semantic", "include")
_SECTIONS_OF_MATERIALS = ("materials", "include")
_SECTIONS_OF_SEMANTIC_NAMES = ("virtual_joints", "groups", "group_states", "end_effectors")

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"


@dataclass(frozen=True)
class LoweredFile:
    """The robot of a file's own parts, its group states as written, and what is missing."""

    robot: Robot
    states: tuple[WrittenState, ...]
    unresolved: UnresolvedNames
    mounts: tuple[ModuleJoint, ...] = ()


def lower_file(
    tree: YamlMap, mesh_bases: Mapping[SourceFile, str], trail: tuple[Span, ...], sink: Diagnostics, meshes: MeshReader
) -> LoweredFile:
    """Lower all that a file says itself; a name that is written twice is told at the second."""
    file = Fields(tree, "robot", sink, trail)
    materials = lower_materials(file, FileScope(mesh_bases))
    unresolved_materials = unresolved_of(name for name, material in materials.items() if material is None)
    unresolved_materials |= unresolved_of(names_at_fault(tree))
    # What has no name is a part of a robot: the file that includes it has the names that it lacks.
    is_part = tree.get("name") is None
    if is_part or _has_lost(tree, _SECTIONS_OF_MATERIALS):
        unresolved_materials |= UnresolvedNames(prefixes=("",))
    kept_materials = {name: material for name, material in materials.items() if material}
    scope = FileScope(mesh_bases, kept_materials, unresolved_materials, meshes)
    links, joints = dict(lower_links(file, scope)), dict(lower_joints(file))
    for frame in lower_frames(file):
        _add_frame(frame, links, joints, sink)
    semantic = _semantic(file)
    said, version = tree.get("name"), file.text("version")
    robot = Robot(
        file.name("name", "robot") or "robot",  # the schema has told of a missing name
        version=IR_VERSION if version is None else version,
        version_stated=version is not None,
        materials=dict(scope.materials),
        metadata=_metadata(tree),
        links=[link for link in links.values() if link],
        joints=[joint for joint in joints.values() if joint],
        sensors=sensors_of(file),
        transmissions=_transmissions(file),
        ros2_controls=_ros2_controls(file),
        gazebo_elements=gazebo_elements_of(file),
        semantic=semantic.description if semantic else None,
        source=SourceRef(tree, said, trail),
        **outer_extras_of(file),
    )
    unresolved = _unresolved_names(
        tree, [name for parts in (links, joints) for name, part in parts.items() if part is None]
    )
    unresolved |= unresolved_of(semantic.faulty_names if semantic else ())
    return LoweredFile(robot, semantic.states if semantic else (), unresolved, tuple(_mounts(file)))


def _unresolved_names(tree: YamlMap, lost: Iterable[str]) -> UnresolvedNames:
    """Return the names that a file has lost: those of faulty entries, and what may be in what could not be read."""
    semantic = tree.get("semantic")
    if (
        tree.get("name") is None
        or _has_lost(tree, _SECTIONS_OF_NAMES)
        or _has_lost(semantic, _SECTIONS_OF_SEMANTIC_NAMES)
    ):
        return unresolved_of(lost) | UnresolvedNames(prefixes=("",))
    modules = (entry.name for entry in tree if isinstance(entry.value, YamlFault) and "use" in entry.value.keys)
    brought = [f"{name}_$(…)" for name in modules]  # whatever names those have
    # An entry that is indented stands among the keys of the one above.
    sections = [node for name in _SECTIONS_OF_NAMES if isinstance(node := tree.get(name), YamlMap)]
    faulty = [
        entry
        for section in sections
        for entry in section
        if isinstance(entry.value, YamlMap) and has_fault(entry.value)
    ]
    inside = [name for entry in faulty for name in names_at_fault(entry.value)]
    return unresolved_of(
        [
            *lost,
            *_without_mimic(faulty, tree.get("joints")),
            *names_at_fault(tree),
            *names_at_fault(semantic),
            *brought,
            *inside,
        ]
    )


def _without_mimic(faulty: Iterable[YamlEntry], joints: YamlNode | None) -> list[str]:
    """Return the joints that follow another, but whose `mimic` has a fault, so that nobody knows which."""
    entries = joints.entries if isinstance(joints, YamlMap) else {}
    followers = [entry for entry in faulty if entries.get(entry.name) is entry]
    return [entry.name for entry in followers if _has_lost(entry.value, ("mimic",))]


def _has_lost(node: YamlNode | None, sections: tuple[str, ...]) -> bool:
    """Whether a map has one of these sections with a fault, be it only that its key is misspelt."""
    faulty = [entry.name for entry in node if isinstance(entry.value, YamlFault)] if isinstance(node, YamlMap) else []
    return any(nearest(name, sections) for name in faulty)


def unresolved_of(names: Iterable[str]) -> UnresolvedNames:
    """Return the names of faulty entries; of a name whose expression failed, the prefix before it.

    One of xacro's, `${...}`, is such an expression as well.
    """
    whole, begun = set(), []
    for name in names:
        start, *expressions = re.split(r"\$[({]", name, maxsplit=1)
        if expressions:
            begun.append(start)
        else:
            # Whoever uses a name that was refused may have written it as one that is taken.
            whole |= {name, *(re.sub(r"[^\w.-]", instead, name) for instead in ("_", "-", ""))}
    return UnresolvedNames(frozenset(whole), tuple(begun))


def _add_frame(frame: Frame, links: dict[str, Link | None], joints: dict[str, Joint | None], sink: Diagnostics) -> None:
    """Add a frame's link and joint, both or none."""
    clashes = False
    for kind, name, part, others in (
        ("link", frame.link_name, frame.link, links),
        ("joint", frame.joint_name, frame.joint, joints),
    ):
        first = others.get(name)
        if part and first:
            report_duplicate(sink, kind, name, part.source, first.source)
        clashes |= name in others
    if clashes or not frame.link or not frame.joint:
        links.setdefault(frame.link_name, None)
        joints.setdefault(frame.joint_name, None)
        return
    links[frame.link_name], joints[frame.joint_name] = frame.link, frame.joint


# What a file does not say is not imported for it either: the classes of each concept cost start-up time.


def _mounts(file: Fields) -> Iterable[ModuleJoint]:
    if file.node.get("mount") is None:
        return ()
    from linkforge_compile.lower.mount import lower_mounts

    return lower_mounts(file)


def sensors_of(file: Fields) -> tuple[Sensor, ...]:
    if file.node.get("sensors") is None:
        return ()
    from linkforge_compile.lower.sensor import lower_sensors

    return tuple(lower_sensors(file))


def _transmissions(file: Fields) -> tuple[Transmission, ...]:
    if file.node.get("transmissions") is None:
        return ()
    from linkforge_compile.lower.transmission import lower_transmissions

    return tuple(lower_transmissions(file))


def _ros2_controls(file: Fields) -> tuple[Ros2Control, ...]:
    if file.node.get("ros2_control") is None:
        return ()
    from linkforge_compile.lower.ros2_control import lower_ros2_controls

    return tuple(lower_ros2_controls(file))


def gazebo_elements_of(file: Fields) -> tuple[GazeboElement, ...]:
    sections = (file.node.get("links"), file.node.get("joints"))
    entries = (entry.value for section in sections if isinstance(section, YamlMap) for entry in section)
    if not any(isinstance(node, YamlMap) and "gazebo" in node.entries for node in (file.node, *entries)):
        return ()
    from linkforge_compile.lower.gazebo import lower_gazebo_elements

    return tuple(lower_gazebo_elements(file))


def _semantic(file: Fields) -> LoweredSemantic | None:
    if file.node.get("semantic") is None:
        return None
    from linkforge_compile.lower.srdf import lower_semantic

    return lower_semantic(file)


def _metadata(tree: YamlMap) -> dict[str, object]:
    said = tree.get("metadata")
    return {entry.name: _plain(entry.value) for entry in said} if isinstance(said, YamlMap) else {}


def _plain(node: YamlNode) -> Plain:
    """Return an author's own data; a number spelled as none is written, such as the version 1.10, is that text."""
    match node:
        case YamlScalar(text=text, value=int() | float() as value) if not isinstance(value, bool):
            return value if number_text(value) == text else text
        case YamlScalar(text=text, value=value):
            return text if isinstance(value, Quantity) else value
        case YamlList():
            return [_plain(item) for item in node]
        case YamlMap():
            return {entry.name: _plain(entry.value) for entry in node}
        case YamlFault():
            return None
