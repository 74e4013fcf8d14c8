"""The names of the right kind that `check` refuses at a position, as a part there would refer to itself."""

from __future__ import annotations

from collections.abc import Iterator, Set

from linkforge_compile.core.models.graph import child_joints, walk_down
from linkforge_compile.core.models.joint import SINGLE_AXIS
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.lsp.completion.context import Context


def refused_names(context: Context, path: tuple[str | int, ...]) -> frozenset[str]:
    """Return the names that completion leaves out at a path: of the cursor, or in the override that it is in."""
    beside = context.text_around
    match path:
        case ("semantic", "disabled_collisions" | "enabled_collisions", str(link), *_):
            return frozenset({link})
        case ("semantic", "groups", str(group), "subgroups", *_):
            return frozenset({group, *_around_group(group, context.robot)})
        case ("semantic", "end_effectors", _, "parent_group"):
            return frozenset({beside.get("group", "")})
        case ("semantic", "group_states", _, _):
            return frozenset(_without_own_position(context.robot))
        case ("joints", str(joint), "parent"):
            child = beside.get("child", "")
            return frozenset({child, *_below({child}, context.robot)})
        case ("joints", str(joint), "child"):
            joints = context.robot.joints if context.robot else ()
            taken = (one.child for one in joints if one.name != joint)
            return frozenset({beside.get("parent", ""), *taken})
        case ("modules", str(module), "parent"):
            links = _links_of(module, context.robot)
            return frozenset({*links, *_below(links, context.robot)})
        case ("frames", str(frame), "parent"):
            return frozenset({frame, *_below({frame}, context.robot)})
        case ("joints" | "mount", str(joint), "mimic", "joint"):
            return frozenset({joint, *_no_leaders(joint, context.robot)})
    return frozenset()


def _below(links: Set[str], robot: Robot | None) -> Iterator[str]:
    """Yield the links below some links: a joint from one of them to the links would close a cycle."""
    yield from (joint.child for joint in walk_down(links, child_joints(robot.joints))) if robot else ()


def _links_of(module: str, robot: Robot | None) -> Set[str]:
    """Return the links of a module."""
    links = robot.links if robot else ()
    return {link.name for link in links if link.source and link.source.modules[:1] == (module,)}


def _around_group(name: str, robot: Robot | None) -> Iterator[str]:
    """Yield the groups that have a group as a subgroup, directly or by others."""
    groups = [*robot.semantic.groups] if robot else []
    found = {name}
    for _ in groups:
        found |= {group.name for group in groups if not found.isdisjoint(group.subgroups)}
    yield from found


def _without_own_position(robot: Robot | None) -> Iterator[str]:
    """Yield the joints that have no position of their own in a state."""
    for joint in robot.joints if robot else ():
        if joint.mimic or not joint.degrees_of_freedom:
            yield joint.name


def _no_leaders(name: str, robot: Robot | None) -> Iterator[str]:
    """Yield the joints that a joint cannot mimic: those that move along no single axis, or that mimic it."""
    for joint in robot.joints if robot else ():
        if joint.type not in SINGLE_AXIS or (joint.mimic and joint.mimic.joint == name):
            yield joint.name
