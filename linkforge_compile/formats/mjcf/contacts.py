"""Contacts in MJCF: pairs of bodies that do not collide, and the friction of the others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import TypeAlias

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree
from linkforge_compile.formats.xml_text import Xml
from linkforge_compile.source import SourceRef
from linkforge_compile.units import finite_number

Pair: TypeAlias = "tuple[str, str, SourceRef | None]"
"""Two links that do not collide, and where that is written."""

_LOOSE = (JointType.FLOATING, JointType.PLANAR)
"""The joints of a base that is to stay on the ground."""


def exclusion_elements(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Sequence[Xml]:
    """Return the pairs of the semantic part, and those of joints that MuJoCo does not exclude by itself.

    It lets no body collide with its parent, unless that is fixed to the world. What fixed joints hold together is one
    body to it.
    """
    pairs: dict[tuple[str, str], SourceRef | None] = {}
    adjacent = _joints_of_static_bodies(robot, tree, is_free=is_free)
    for one, other, source in (*_stated_pairs(robot), *adjacent):
        pairs.setdefault((min(one, other), max(one, other)), source)
    return [leaf_at("exclude", source, body1=one, body2=other) for (one, other), source in pairs.items()]


def _stated_pairs(robot: Robot) -> Iterator[Pair]:
    """Yield the disabled pairs, and all pairs of links without collisions by default that are not enabled."""
    if not robot.has_semantic:
        return
    semantic = robot.semantic
    for pair in semantic.disabled_collisions:
        if robot.has_link(pair.link1) and robot.has_link(pair.link2):
            yield pair.link1, pair.link2, pair.source
    enabled = {pair.key for pair in semantic.enabled_collisions}
    for name in filter(robot.has_link, semantic.no_default_collision_links):
        for other in robot.links:
            is_pair = other.name not in (name, WORLD) and other.collisions and robot.links[name].collisions
            if is_pair and (min(name, other.name), max(name, other.name)) not in enabled:
                yield name, other.name, robot.links[name].source


def _joints_of_static_bodies(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Pair]:
    """Yield the links that a joint at a link which never moves parts, where both have collisions.

    The world is none of them, as an exclusion would hold for the ground of the scene, too.
    """
    static: set[str] = set()
    for link, joint, _ in tree.nodes:
        if joint is None:
            is_static = not is_free or link.name == WORLD
        else:
            is_static = joint.type == JointType.FIXED and joint.parent in static
            if joint.parent in static and not is_static and joint.type not in _LOOSE:
                ends = (_nearest_shapes(robot, tree, end) for end in (joint.parent, link.name))
                yield from ((one, other, joint.source) for one, other in product(*ends))
        if is_static:
            static.add(link.name)


def _nearest_shapes(robot: Robot, tree: KinematicTree, link: str) -> list[str]:
    """Return a link with collisions, or those nearest to one without that fixed joints hold to it."""
    found, reached = [], [link]
    for name in reached:
        if name == WORLD:
            continue
        if robot.links[name].collisions:
            found.append(name)
        else:
            reached += (near for near in tree.fixed_to(name) if near not in reached)
    return found


def sliding_frictions(robot: Robot) -> Mapping[str, float]:
    """Return the friction of links by name, of their `physics`, else of their settings for Gazebo."""
    frictions: dict[str, float] = {}
    for block in robot.gazebo_elements:
        text = block.properties.get("mu1")
        mu = finite_number(text) if isinstance(text, str) else None
        if block.reference and mu is not None:
            frictions.setdefault(block.reference, mu)
    return frictions | {link.name: link.physics.mu for link in robot.links if link.physics.is_written("mu")}
