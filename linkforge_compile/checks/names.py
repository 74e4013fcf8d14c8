"""Names: unique within a kind, accepted by ROS and Gazebo, and known where others refer to them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, Protocol, TypeAlias

from linkforge_compile.core.models.graph import find_cycles
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics import Code, Diagnostic, Note, UnresolvedNames, notes_of
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME, FRAME_WITH_SLASH, LINK_AND_JOINT, RESERVED_NAME
from linkforge_compile.diagnostics.grouping import SHOWN
from linkforge_compile.source import Key, SourceRef, Span
from linkforge_compile.source.provenance import uses_in


class NamedPart(Protocol):
    """A part of a robot that has a name."""

    @property
    def name(self) -> str: ...
    @property
    def source(self) -> SourceRef | None: ...


def check_duplicates(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Sensors have unique names, and so have transmissions, ros2_control systems and controllers.

    Of two with one name readers take the first, the last or none. Rename one. The prefixes of modules keep their
    names apart. Lowering has reported links and joints of one name.
    """
    yield from _report_duplicates("sensor", robot.sensors)
    yield from _report_duplicates("transmission", robot.transmissions)
    yield from _report_duplicates("ros2_control system", robot.ros2_controls)
    yield from _report_duplicates("controller", robot.controllers)


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
            fault = FRAME_WITH_SLASH.at(sensor.source, "frame", name=sensor.frame)
            yield fault.replacing(sensor.frame, sensor.frame.removeprefix("/"), is_whole=True)


def _report_duplicates(kind: str, parts: Iterable[NamedPart], user: str = "") -> Iterator[Diagnostic]:
    first: dict[str, NamedPart] = {}
    for part in parts:
        if earlier := first.get(part.name):
            notes = notes_at(earlier.source, f"the first {kind} '{part.name}'")
            yield Reference(part.name, user, part.source).report(DUPLICATE_NAME, kind=kind, name=part.name, notes=notes)
        else:
            first[part.name] = part


class Reference(NamedTuple):
    """A name, the part that refers to it ("joint 'elbow'", or ""), and where: a path below the source of that part."""

    name: str
    user: str
    source: SourceRef | None
    path: tuple[str | int, ...] = ()

    def report(
        self, code: Code, *, near: Iterable[str] = (), notes: Iterable[Note] = (), **facts: object
    ) -> Diagnostic:
        """Return the diagnostic about this reference; without a place its message begins with the user.

        A robot built in Python has no places, and two users of one wrong name are two faults.
        """
        diagnostic = code.at(self.source, *self.path, near=near, notes=notes, **facts)
        if diagnostic.span or not self.user:
            return diagnostic
        return replace(diagnostic, message=f"{self.user}: {diagnostic.message}")

    @property
    def prefix(self) -> str:
        """The prefix that modules have put before the name as its file writes it.

        A module imported twice under two prefixes has one wrong name in its file, which is reported in its words.
        """
        if not (self.source and self.source.trail):
            return ""
        span = self.source.at(*self.path)
        end = span.end_column - 1 if span.line == span.end_line else None
        written = span.file.line(span.line)[span.column - 1 : end].strip("'\"")
        return self.name.removesuffix(written) if written and self.name.endswith(written) else ""

    def key(self, name: str) -> Key:
        """Return the key that the file of this reference writes for a name: without the prefix that both have."""
        return Key(name.removeprefix(self.prefix))

    @property
    def place(self) -> Span | None:
        """The place of the name, the same one for all imports of its file; None if it was not written in a file."""
        return self.source.at(*self.path) if self.source else None

    def note(self, message: str) -> Note:
        return Note(message, self.place)

    def notes(self, message: str) -> list[Note]:
        """Return the note and where its file was imported, as two imports of a file share one place."""
        imports = self.source.trail if self.source else ()
        return [self.note(message), *notes_of(uses_in(imports))]


def notes_at(source: SourceRef | None, message: str) -> list[Note]:
    """Return the note at a part and where its file was imported; none for a part built in Python."""
    return Reference("", "", source).notes(message) if source else []


def own_positions(state: GroupState) -> dict[str, Key]:
    """Return the joints that a state itself sets, with their keys; without positions taken from another state.

    Those are checked once, where they are written. A state built in Python sets all its positions itself.
    """
    holder = Reference(state.name, "", state.source)
    keys = {joint: holder.key(joint) for joint in state.joint_values}
    if state.source is None:
        return keys
    return {joint: key for joint, key in keys.items() if state.source.node.child(key) is not None}


MAX_SUGGESTIONS = 100
"""After so many wrong names there are no more suggestions: each is compared with every known name."""


def report_unknown(
    references: Iterable[Reference],
    code: Code,
    known: Iterable[str],
    unresolved: UnresolvedNames,
    *,
    offered: Iterable[str] | None = None,
    **facts: object,
) -> Iterator[Diagnostic]:
    """Report each name that is neither known nor unresolved, as the file that refers to it writes it.

    `offered` are the names to suggest, by default all known ones.
    """
    reported = 0
    names = dict.fromkeys(known)
    candidates = names if offered is None else dict.fromkeys(offered)
    for ref in references:
        if ref.name not in names and ref.name not in unresolved:
            prefix = ref.prefix
            notes = unresolved.deleted.notes(ref.name)
            suggests = not notes and reported < MAX_SUGGESTIONS
            near = [name.removeprefix(prefix) for name in candidates if name.startswith(prefix)] if suggests else []
            yield ref.report(code, name=ref.name.removeprefix(prefix), near=near, notes=notes, **facts)
            reported += 1


Graph: TypeAlias = Mapping[str, Sequence[Reference]]
"""The references of each name."""


def find_reference_cycles(graph: Graph) -> Iterator[list[Reference]]:
    """Yield every cycle once, as its references; the last one closes it."""
    for cycle in find_cycles({name: [ref.name for ref in references] for name, references in graph.items()}):
        yield [graph[name][place] for name, place in cycle]


def report_cycles(graph: Graph, code: Code) -> Iterator[Diagnostic]:
    """Report each cycle once, at the reference that closes it, with the others as notes."""
    for cycle in find_reference_cycles(graph):
        closing = cycle[-1]
        notes = [ref.note(f"{ref.user} leads to '{ref.name}'") for ref in cycle[:-1][:SHOWN]]
        names = [closing.name, *(ref.name for ref in cycle)]
        if len(names) > SHOWN:
            names = [*names[: SHOWN - 3], "…", *names[-2:]]
        yield closing.report(code, path=" → ".join(names), notes=notes)
