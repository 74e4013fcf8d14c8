"""Computes which pairs of bodies collide at given positions of the joints, with Pinocchio and coal."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import coal
import networkx as nx
import numpy as np
import pinocchio as pin

from linkforge_compile.collisions.meshes import load_mesh
from linkforge_compile.collisions.scene import Body, Motion, Pair, Pose, Scene, Shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

HULL_MARGIN = 1e-5
"""Convex hulls closer than this count as touching, as their distance is computed with less precision [m]."""


class Collider:
    """The bodies of a scene in Pinocchio, and the pairs of them to check.

    A mesh has its convex hull as a second shape: meshes are compared only where their hulls touch, which takes a tenth
    of the time for most robots.
    """

    def __init__(self, scene: Scene, pairs: Iterable[Pair]) -> None:
        self._motions = [(place, body.motion) for place, body in enumerate(scene) if body.motion]
        self._followers = _in_order_of_leaders(self._motions)
        self._model = pin.Model()
        self._exact, self._hulls = pin.GeometryModel(), pin.GeometryModel()
        shapes = list(self._add_bodies(scene))
        self._pairs: list[Pair] = []
        self._places: dict[Pair, list[int]] = {}
        for first, second in pairs:
            for one in shapes[first]:
                for other in shapes[second]:
                    self._places.setdefault((first, second), []).append(len(self._pairs))
                    self._pairs.append((first, second))
                    for geometry in (self._exact, self._hulls):
                        geometry.addCollisionPair(pin.CollisionPair(one, other))
        self._data = self._model.createData()
        self._exact_data, self._hull_data = self._exact.createData(), self._hulls.createData()
        for request in self._hull_data.collisionRequests:
            request.security_margin, request.enable_contact = HULL_MARGIN, False
        for request in self._exact_data.collisionRequests:
            request.enable_contact = False

    def select(self, pairs: Collection[Pair]) -> None:
        """Check these of the pairs, and no others."""
        for pair, places in self._places.items():
            self._switch(places, is_on=pair in pairs)

    def drop(self, pairs: Iterable[Pair]) -> None:
        """Check these pairs no more."""
        for pair in pairs:
            self._switch(self._places[pair], is_on=False)

    def colliding(self, positions: NDArray[np.float64]) -> set[Pair]:
        """Return the selected pairs that collide at the positions of the moving bodies."""
        if not pin.computeCollisions(self._model, self._data, self._hulls, self._hull_data, positions, False):
            return set()
        pin.updateGeometryPlacements(self._model, self._data, self._exact, self._exact_data)
        found: set[Pair] = set()
        is_on = self._hull_data.activeCollisionPairs
        for place, result in enumerate(self._hull_data.collisionResults):
            # The result of a pair that is switched off is that of an earlier sample.
            if not is_on[place] or self._pairs[place] in found or not result.isCollision():
                continue
            if pin.computeCollision(self._exact, self._exact_data, place):
                found.add(self._pairs[place])
        return found

    def depths(self, positions: NDArray[np.float64]) -> dict[Pair, float | None]:
        """Return the selected pairs that collide at the positions of the moving bodies, and how deep [m].

        The depth is that of the convex hulls, None for a mesh that has none.
        """
        depths: dict[Pair, float | None] = {}
        for pair in sorted(self.colliding(positions)):
            places = [at for at in self._places[pair] if pin.computeCollision(self._exact, self._exact_data, at)]
            deepest = max(-pin.computeDistance(self._hulls, self._hull_data, at).min_distance for at in places)
            depths[pair] = deepest if deepest > 0 else None
        return depths

    def positions_with(self, given: Mapping[int, float]) -> NDArray[np.float64]:
        """Return the positions of the default pose with those that are given by the places of their bodies."""
        return self._followed([given.get(place, motion.default) for place, motion in self._motions])

    def default_positions(self) -> NDArray[np.float64]:
        """Return the positions of the moving bodies in the default pose."""
        return self.positions_with({})

    def random_positions(self, generator: np.random.Generator) -> NDArray[np.float64]:
        """Return positions that are evenly distributed within the limits."""
        shares = generator.random(len(self._motions)).tolist()
        pairs = zip(self._motions, shares, strict=True)
        return self._followed([motion.lower * (1 - share) + motion.upper * share for (_, motion), share in pairs])

    def _followed(self, positions: Sequence[float]) -> NDArray[np.float64]:
        """Return positions with those of bodies that follow others, which may follow others themselves."""
        at = {place: position for (place, _), position in zip(self._motions, positions, strict=True)}
        for place, motion in self._followers:
            at[place] = motion.multiplier * at.get(motion.leader or 0, 0.0) + motion.offset
        return np.array(list(at.values()))

    def _switch(self, places: Iterable[int], *, is_on: bool) -> None:
        for place in places:
            if is_on:
                self._hull_data.activateCollisionPair(place)
            else:
                self._hull_data.deactivateCollisionPair(place)

    def _add_bodies(self, scene: Scene) -> Iterator[list[int]]:
        """Add the bodies to the models, and yield the numbers of the shapes of each."""
        joints: list[int] = []
        frames: list[pin.SE3] = []
        for body in scene:
            above, frame = (0, pin.SE3.Identity())
            if body.parent is not None:
                above, frame = joints[body.parent], frames[body.parent]
            frame = frame * _se3(body.pose)
            if body.motion:
                above = self._model.addJoint(above, _joint(body.motion), frame, body.link)
                frame = pin.SE3.Identity()
            joints.append(above)
            frames.append(frame)
            yield list(self._add_shapes(body, above, frame))

    def _add_shapes(self, body: Body, joint: int, frame: pin.SE3) -> Iterator[int]:
        for number, shape in enumerate(body.shapes):
            exact, hull = _geometries(shape)
            name, placement = f"{body.link}/{number}", frame * _se3(shape.pose)
            self._hulls.addGeometryObject(pin.GeometryObject(name, joint, placement, hull))
            yield self._exact.addGeometryObject(pin.GeometryObject(name, joint, placement, exact))


def _in_order_of_leaders(motions: Iterable[tuple[int, Motion]]) -> list[tuple[int, Motion]]:
    """Return the bodies that follow others, each after the one that it follows."""
    followers = {place: motion for place, motion in motions if motion.leader is not None}
    graph = nx.DiGraph((motion.leader, place) for place, motion in followers.items())
    return [(place, followers[place]) for place in nx.topological_sort(graph) if place in followers]


def _joint(motion: Motion) -> pin.JointModel:
    kind = pin.JointModelRevoluteUnaligned if motion.is_turning else pin.JointModelPrismaticUnaligned
    return kind(np.array(motion.axis))


def _se3(pose: Pose) -> pin.SE3:
    return pin.SE3(pin.rpy.rpyToMatrix(np.array(pose.rpy)), np.array(pose.xyz))


def _geometries(shape: Shape) -> tuple[coal.CollisionGeometry, coal.CollisionGeometry]:
    """Return a shape and its convex hull."""
    if shape.path is not None:
        mesh = load_mesh(shape.path, np.array(shape.sizes))
        return mesh, _hull(mesh)
    exact = _PRIMITIVES[shape.tag](*shape.sizes)
    return exact, exact


def _hull(mesh: coal.BVHModelBase) -> coal.CollisionGeometry:
    try:
        mesh.buildConvexHull(True, "Qt")
    except (RuntimeError, ValueError):  # a flat mesh has none
        return mesh
    return mesh.convex


_PRIMITIVES = {"box": coal.Box, "sphere": coal.Sphere, "cylinder": coal.Cylinder, "capsule": coal.Capsule}
"""The classes of coal by tag; each takes the sizes in the order of URDF, whole lengths and not halves."""
