"""A robot as plain values, which several processes may share: bodies, their motion and shapes."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import combinations
from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Transform
from linkforge_compile.core.models.graph import child_joints, tree_root, walk_down
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair

Triple: TypeAlias = tuple[float, float, float]

UNBOUNDED = (JointType.FLOATING, JointType.PLANAR)
"""Joints without limits of their position: the links below one can be anywhere."""


class Pose(NamedTuple):
    """A position [m] and a rotation about the fixed axes x, y, z [rad], in the frame of the parent."""

    xyz: Triple
    rpy: Triple


class Shape(NamedTuple):
    """The shape of a collision: its tag in URDF, its sizes [m], or the scale of a mesh, and the file of a mesh."""

    tag: str
    sizes: tuple[float, ...]
    pose: Pose
    path: Path | None = None


class Motion(NamedTuple):
    """How a joint with one degree of freedom moves; positions are [rad], or [m] unless `is_turning`.

    `default` is that of MoveIt's default pose. A joint that follows another one is at `multiplier` times the position
    of body `leader`, plus `offset`.
    """

    is_turning: bool
    axis: Triple
    lower: float
    upper: float
    default: float
    leader: int | None = None
    multiplier: float = 1.0
    offset: float = 0.0


class Body(NamedTuple):
    """A link with the place of its parent in the scene, None for the root, and the motion of the joint between.

    `motion` is None for a joint that is fixed, or that can be anywhere. Bodies of one `island` have no joint between
    them that can be anywhere; it is the place of the topmost of them.
    """

    link: str
    parent: int | None
    pose: Pose
    motion: Motion | None
    island: int
    shapes: tuple[Shape, ...]


Scene: TypeAlias = Sequence[Body]
"""The bodies of a robot, each after its parent."""


def make_scene(robot: Robot, paths: Mapping[str, Path]) -> Scene:
    """Return the bodies of a robot that is a tree; `paths` are the files of the meshes, as they are written."""
    root = tree_root(robot.links, robot.joints)
    joints = list(walk_down([root], child_joints(robot.joints)))
    places = {root: 0} | {joint.child: place for place, joint in enumerate(joints, 1)}
    place_of_joint = {joint.name: places[joint.child] for joint in joints}
    bodies = [Body(root, None, _pose(Transform()), None, 0, _shapes(robot.links[root], paths))]
    for place, joint in enumerate(joints, 1):
        parent = places[joint.parent]
        island = place if joint.type in UNBOUNDED else bodies[parent].island
        motion, shapes = _motion(joint, place_of_joint), _shapes(robot.links[joint.child], paths)
        bodies.append(Body(joint.child, parent, _pose(joint.origin), motion, island, shapes))
    return tuple(bodies)


def _motion(joint: Joint, places: Mapping[str, int]) -> Motion | None:
    if joint.axis is None or joint.type in UNBOUNDED:
        return None
    is_turning, (lower, upper) = joint.type != JointType.PRISMATIC, joint.bounds or (-math.pi, math.pi)
    motion = Motion(is_turning, joint.axis.to_tuple(), lower, upper, joint.default_position)
    if joint.mimic is None:
        return motion
    leader = places.get(joint.mimic.joint)
    return motion._replace(leader=leader, multiplier=joint.mimic.multiplier, offset=joint.mimic.offset)


def _pose(origin: Transform) -> Pose:
    return Pose(origin.xyz.to_tuple(), origin.rpy.to_tuple())


def _shapes(link: Link, paths: Mapping[str, Path]) -> tuple[Shape, ...]:
    return tuple(_shape(one.geometry, _pose(one.origin), paths) for one in link.collisions)


def _shape(geometry: Geometry, pose: Pose, paths: Mapping[str, Path]) -> Shape:
    match geometry:
        case Box(size=size):
            return Shape(geometry.TAG, size.to_tuple(), pose)
        case Sphere(radius=radius):
            return Shape(geometry.TAG, (radius,), pose)
        case Cylinder(radius=radius, length=length) | Capsule(radius=radius, length=length):
            return Shape(geometry.TAG, (radius, length), pose)
        case Mesh(resource=resource, scale=scale):
            return Shape(geometry.TAG, scale.to_tuple(), pose, paths[resource])


Pair: TypeAlias = tuple[int, int]
"""The places of two bodies in their scene, in ascending order."""

Names: TypeAlias = tuple[str, str]
"""The links of a pair; the first one is that under which the pair is written."""


class Reason(StrEnum):
    """Why a pair of links needs no check, as MoveIt's Setup Assistant writes it."""

    ADJACENT = "Adjacent"
    """A joint connects them, or joints and links without collisions."""
    DEFAULT = "Default"
    """They collide in the default pose."""
    ALWAYS = "Always"
    """They collide in nearly all samples."""
    NEVER = "Never"
    """They collide in no sample."""


def comparable_pairs(scene: Scene) -> Iterator[Pair]:
    """Yield the pairs of bodies with shapes that no planar or floating joint separates."""
    with_shapes = [place for place, body in enumerate(scene) if body.shapes]
    for pair in combinations(with_shapes, 2):
        if scene[pair[0]].island == scene[pair[1]].island:
            yield pair


def adjacent_pairs(scene: Scene) -> set[Pair]:
    """Return the pairs between which there are only joints and bodies without shapes."""
    # Bodies around one group of connected bodies without shapes are adjacent to each other.
    group_of: dict[int, int] = {}
    around: defaultdict[int, set[int]] = defaultdict(set)
    adjacent: set[Pair] = set()
    for place, body in enumerate(scene):
        parent = None if place == body.island else body.parent
        if body.shapes:
            if parent in group_of:
                around[group_of[parent]].add(place)
            elif parent is not None:
                adjacent.add((parent, place))
        else:
            group_of[place] = group_of.get(parent, place) if parent is not None else place
            if parent is not None and parent not in group_of:
                around[place].add(parent)
    for neighbors in around.values():
        adjacent.update(combinations(sorted(neighbors), 2))
    return adjacent


def is_own(pair: CollisionPair) -> bool:
    """Whether a pair is declared in the compiled file or its includes, and not by a module."""
    return pair.source is None or not pair.source.modules


class KnownModules:
    """The modules of a robot that declare pairs."""

    def __init__(self, robot: Robot) -> None:
        known = {pair.source.modules for pair in robot.semantic.disabled_collisions if pair.source and not is_own(pair)}
        self._modules: dict[str, set[tuple[str, ...]]] = {}
        for link in robot.links:
            own = link.source.modules if link.source else ()
            self._modules[link.name] = {module for module in known if own[: len(module)] == module}

    def hold(self, one: str, other: str) -> bool:
        """Whether two links are in one module that declares pairs, or in modules that it uses."""
        return bool(self._modules[one] & self._modules[other])
