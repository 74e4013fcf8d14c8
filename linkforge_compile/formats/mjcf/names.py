"""Names in MJCF that are made of those of the robot, and must be unique among all of their kind."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics.codes.simulators import TAKEN_IN_MUJOCO
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.mjcf.joints import free_joint_name, part_names
from linkforge_compile.formats.mjcf.keyframes import states_of
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic


class Named(NamedTuple):
    """A name in the MJCF, what has it, in words, and its place; `is_own` if it is that of the robot, too."""

    name: str
    owner: str
    source: SourceRef | None
    is_own: bool = False


def check_names(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Diagnostic]:
    """MuJoCo refuses two joints of one name, and two keyframes; some of their names are made of others."""
    yield from _taken("joints", sorted(_joint_names(tree, is_free=is_free), key=lambda named: named.is_own))
    yield from _taken("keyframes", [Named(one.name, one.origin, one.source) for one in states_of(robot)])


def _joint_names(tree: KinematicTree, *, is_free: bool) -> Iterator[Named]:
    for link, joint, _ in tree.nodes:
        if joint is None:
            if is_free and link.name != WORLD:
                yield Named(free_joint_name(link.name), f"the free joint of link '{link.name}'", link.source)
            continue
        for name in part_names(joint):
            is_own = name == joint.name
            yield Named(name, f"a part of {joint.type} joint '{joint.name}'", joint.source, is_own)


def _taken(parts: str, names: Iterable[Named]) -> Iterator[Diagnostic]:
    first: dict[str, Named] = {}
    for named in names:
        other = first.setdefault(named.name, named)
        if other is not named:
            yield TAKEN_IN_MUJOCO.at(named.source, "name", parts=parts, name=named.name, owner=other.owner)
