"""Names: unique within a kind, and accepted by ROS and Gazebo."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Protocol

from linkforge_compile.checks.references import Reference, notes_at
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME, FRAME_WITH_SLASH, LINK_AND_JOINT, RESERVED_NAME

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import GroupState
    from linkforge_compile.source import SourceRef


class NamedPart(Protocol):
    """A part of a robot that has a name."""

    @property
    def name(self) -> str: ...
    @property
    def source(self) -> SourceRef | None: ...


def check_duplicates(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Sensors have unique names, and so have transmissions and ros2_control systems.

    Of two with one name readers take the first, the last or none. Rename one. The prefixes of modules keep their
    names apart. Lowering has reported links and joints of one name.
    """
    yield from _report_duplicates("sensor", robot.sensors)
    yield from _report_duplicates("transmission", robot.transmissions)
    yield from _report_duplicates("ros2_control system", robot.ros2_controls)


def check_semantic_duplicates(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Planning groups have unique names, and so have end effectors, virtual joints and the states of a group.

    MoveIt takes the first group of a name and the last state, with a line in its log at best. Rename one.
    """
    semantic = robot.semantic
    yield from _report_duplicates("planning group", semantic.groups)
    yield from _report_duplicates("end effector", semantic.end_effectors)
    yield from _report_duplicates("virtual joint", semantic.virtual_joints)
    yield from _report_duplicates("passive joint", semantic.passive_joints)
    by_group: dict[str, list[GroupState]] = {}
    for state in semantic.group_states:
        by_group.setdefault(state.group, []).append(state)
    for group, states in by_group.items():
        yield from _report_duplicates("group state", states, f"planning group '{group}'")


def check_link_and_joint_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No joint has the name of a link.

    URDF and ROS keep links and joints apart. In Gazebo both are frames of one model: it refuses the second, and
    with it all that hangs below. Rename the joint: `wrist_joint` for the link `wrist`.
    """
    for joint in robot.joints:
        if link := robot.links.get(joint.name):
            notes = notes_at(link.source, "the link is here")
            yield LINK_AND_JOINT.at(joint.source, name=joint.name, notes=notes)


def check_reserved_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No link or joint has a name that Gazebo reserves.

    Those are `world`, unless it is the root link, which Gazebo identifies with its world, and all that begin and
    end with two underscores, such as `__model__`.
    """
    children = {joint.child for joint in robot.joints}
    for link in robot.links:
        if _is_reserved(link.name) and (link.name != "world" or "world" in children):
            yield RESERVED_NAME.at(link.source, kind="link", name=link.name)
    for joint in robot.joints:
        if _is_reserved(joint.name):
            yield RESERVED_NAME.at(joint.source, kind="joint", name=joint.name)


def _is_reserved(name: str) -> bool:
    return name == "world" or (len(name) >= len("____") and name.startswith("__") and name.endswith("__"))


def check_frame_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The names of links and of frames of sensors do not begin with a slash.

    Each is a frame to tf2, which strips the slash where a transform is published and refuses it where one is
    looked up. Leave it out.
    """
    for link in robot.links:
        if link.name.startswith("/"):
            yield FRAME_WITH_SLASH.at(link.source, name=link.name)
    for sensor in robot.sensors:
        if sensor.frame and sensor.frame.startswith("/"):
            yield FRAME_WITH_SLASH.at(sensor.source, "frame", name=sensor.frame)


def _report_duplicates(kind: str, parts: Iterable[NamedPart], user: str = "") -> Iterator[Diagnostic]:
    first: dict[str, NamedPart] = {}
    for part in parts:
        if earlier := first.get(part.name):
            notes = notes_at(earlier.source, f"the first {kind} '{part.name}'")
            yield Reference(part.name, user, part.source).report(DUPLICATE_NAME, kind=kind, name=part.name, notes=notes)
        else:
            first[part.name] = part
