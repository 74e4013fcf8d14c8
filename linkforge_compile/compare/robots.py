"""Two robots compared, section by section."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.renames import Renames, find_renames, under_new_names
from linkforge_compile.compare.said import key_of_field, said_fields, said_value
from linkforge_compile.compare.walk import TOLERANCE, How, stated_differences, walk
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot


def compare(
    before: Robot, after: Robot, *, tolerance: float = TOLERANCE, semantic: bool = True
) -> tuple[Difference, ...]:
    """Return what differs between two robots, in the order of the robot after.

    The order of what has a name is no difference. `tolerance` is what poses may differ by [m], [rad], and other
    numbers as a share. Without `semantic`, that part is left out.
    """
    renames = find_renames(before, after)
    slid, slides = (
        {joint.name for joint in robot.joints if joint.type is JointType.PRISMATIC} for robot in (before, after)
    )
    slid = {renames.joints.get(name, name) for name in slid}
    how = How(tolerance, (slid, slides), (before.materials, after.materials))
    return tuple(_sections(before, after, renames, how, semantic=semantic))


def _sections(before: Robot, after: Robot, renames: Renames, how: How, *, semantic: bool) -> Iterator[Difference]:
    for field in said_fields(after):
        if field == "semantic" and not semantic:
            continue
        if field in {"links", "joints"}:
            yield from _renamed(field, renames.links if field == "links" else renames.joints)
        if field == "links":
            yield from _moved_links(before, after, renames)
        if field == "semantic":
            for (group, was), now in renames.states.items():
                path = ("semantic", "group_states", f"{group}/{now}")
                yield Difference(Kind.RENAMED, path, was, now, f"was '{was}'")
        old, new = _section(before, field, renames), _section(after, field, Renames({}, {}))
        yield from walk((key_of_field(field),), old, new, how.about_field(field))
        if field == "version":
            yield from stated_differences((), before, after, how)


def _section(robot: Robot, field: str, renames: Renames) -> object:
    if field == "semantic":
        said = robot.semantic
        # It bears the robot's name, which is told once.
        nameless = replace(said, robot_name="") if said.robot_name == robot.name else said
        return under_new_names(nameless, renames)
    held = said_value(robot, field)
    return under_new_names(tuple(held), renames) if isinstance(held, tuple) else held


def _renamed(section: str, names: Mapping[str, str]) -> Iterator[Difference]:
    for old, new in names.items():
        yield Difference(Kind.RENAMED, (section, new), old, new, f"was '{old}'")


def _moved_links(before: Robot, after: Robot, renames: Renames) -> Iterator[Difference]:
    """Yield the links that hang on another link by another joint; where the joint is the same, it tells that itself."""
    old_names = {new: old for old, new in renames.links.items()}
    for link in after.links:
        if (old := old_names.get(link.name, link.name)) not in before.links:
            continue
        was, now = before.get_parent_joint(old), after.get_parent_joint(link.name)
        parent, other = renames.links.get(was.parent, was.parent) if was else None, now.parent if now else None
        is_told = was and now and renames.joints.get(was.name, was.name) == now.name
        if parent != other and not is_told:
            text = f"hangs on {_place(other)}, was on {_place(parent)}" if was and now else _uprooted(parent, other)
            yield Difference(Kind.MOVED, ("links", link.name), parent, other, text)


def _place(parent: str | None) -> str:
    return f"'{parent}'"


def _uprooted(before: str | None, after: str | None) -> str:
    return f"hangs on '{after}', was the root" if before is None else f"is the root, was on '{before}'"
