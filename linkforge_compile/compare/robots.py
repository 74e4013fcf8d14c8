"""Compare two robots, section by section."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkforge_compile.compare.context import TOLERANCE, CompareContext
from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.fields import compared_fields, compared_value, key_of_field
from linkforge_compile.compare.matching import Renames, apply_renames, find_renames
from linkforge_compile.compare.walk import stated_differences, walk
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot


def compare(
    before: Robot, after: Robot, *, tolerance: float = TOLERANCE, semantic: bool = True
) -> tuple[Difference, ...]:
    """Return the differences between two robots, in the order of the robot after.

    The order of named parts is not compared. `tolerance` is absolute for poses [m], [rad], and relative for other
    numbers. The semantic part is compared only if `semantic`.
    """
    renames = find_renames(before, after)
    were_prismatic, are_prismatic = (
        {joint.name for joint in robot.joints if joint.type is JointType.PRISMATIC} for robot in (before, after)
    )
    were_prismatic = {renames.joints.get(name, name) for name in were_prismatic}
    context = CompareContext(tolerance, (were_prismatic, are_prismatic), (before.materials, after.materials))
    return tuple(_compare_sections(before, after, renames, context, semantic=semantic))


def _compare_sections(
    before: Robot, after: Robot, renames: Renames, context: CompareContext, *, semantic: bool
) -> Iterator[Difference]:
    for field in compared_fields(after):
        if field == "semantic" and not semantic:
            continue
        if field in {"links", "joints"}:
            yield from _renamed_parts(field, renames.links if field == "links" else renames.joints)
        if field == "links":
            yield from _moved_links(before, after, renames)
        if field == "semantic":
            for (group, was), now in renames.states.items():
                path = ("semantic", "group_states", f"{group}/{now}")
                yield Difference(Kind.RENAMED, path, was, now, f"was '{was}'")
        old, new = _section(before, field, renames), _section(after, field, Renames({}, {}))
        yield from walk((key_of_field(Robot, field),), old, new, context.for_section(field))
        if field == "version":
            yield from stated_differences((), before, after, context)


def _section(robot: Robot, field: str, renames: Renames) -> object:
    if field == "semantic":
        semantic = robot.semantic
        # It repeats the robot's name, whose change is reported once.
        is_repeated = semantic.robot_name == robot.name
        return apply_renames(semantic.with_fields(robot_name="") if is_repeated else semantic, renames)
    section = compared_value(robot, field)
    return apply_renames(tuple(section), renames) if isinstance(section, tuple) else section


def _renamed_parts(section: str, names: Mapping[str, str]) -> Iterator[Difference]:
    for old, new in names.items():
        yield Difference(Kind.RENAMED, (section, new), old, new, f"was '{old}'")


def _moved_links(before: Robot, after: Robot, renames: Renames) -> Iterator[Difference]:
    """Yield the links with another parent by another joint; the same joint reports its new parent itself."""
    old_names = {new: old for old, new in renames.links.items()}
    for link in after.links:
        if (old := old_names.get(link.name, link.name)) not in before.links:
            continue
        was, now = before.get_parent_joint(old), after.get_parent_joint(link.name)
        parent, other = renames.links.get(was.parent, was.parent) if was else None, now.parent if now else None
        is_same_joint = was and now and renames.joints.get(was.name, was.name) == now.name
        if parent != other and not is_same_joint:
            yield Difference(Kind.MOVED, ("links", link.name), parent, other, _describe_move(parent, other))


def _describe_move(before: str | None, after: str | None) -> str:
    was = "the root" if before is None else f"attached to '{before}'"
    now = "the root" if after is None else f"attached to '{after}'"
    return f"is {now}, was {was}"
