"""The box around the shapes of a robot while every joint is at 0, exact also for meshes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.checks.bounding import BoundingBox
from linkforge_compile.core.meshes import MAX_BYTES, MeshError, MeshFault, triangles_in
from linkforge_compile.core.models.geometry import IDENTITY, Box, Capsule, Cylinder, Geometry, Mesh, Sphere
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_depth_first
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.poses import Pose
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import read_bytes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from linkforge_compile.core.models.robot import Robot


NO_LIBRARY = "the extra `mesh` is not installed: pip install 'linkforge-compile[mesh]'"


class Extent(NamedTuple):
    """The box around visuals and collisions in the root's frame, None without any; meshes it leaves out, and why."""

    box: BoundingBox | None
    left_out: Mapping[str, str]


def measure_extent(robot: Robot, poses: Mapping[str, Pose], files: Mapping[str, Path | str]) -> Extent:
    """Return the extent of a robot; `files` has the file of each mesh as it is written, or why there is none."""
    left_out: dict[str, str] = {}
    points: dict[str, NDArray[np.float64]] = {}
    corners: list[tuple[float, ...]] = []
    for geometry, pose in _placed_shapes(robot, poses):
        if not isinstance(geometry, Mesh):
            corners += _box(geometry, pose)
            continue
        name = geometry.resource
        try:
            if name not in points and name not in left_out:
                points[name] = _points_in(files[name])
        except (MeshError, UnreadableError) as error:
            left_out[name] = _reason(error)
        if name in points:
            corners += _box_of_points(points[name], geometry, pose)
    return Extent(BoundingBox.around(corners), left_out)


def _reason(error: MeshError | UnreadableError) -> str:
    if isinstance(error, MeshError):
        return NO_LIBRARY if error.fault is MeshFault.NO_LIBRARY else error.message
    return str(error)


def _placed_shapes(robot: Robot, poses: Mapping[str, Pose]) -> Iterator[tuple[Geometry, Pose]]:
    for link in robot.links:
        for shape in link.shapes if link.name in poses else ():
            yield shape.geometry, poses[link.name].times(Pose.of(shape.origin))


def _rows(pose: Pose) -> list[tuple[float, ...]]:
    """Return the rotation as a matrix."""
    columns = [pose.turn.turned(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    return list(zip(*columns, strict=True))


def _box(geometry: Geometry, pose: Pose) -> list[tuple[float, ...]]:
    """Return the lowest and the highest corner of a primitive shape."""
    half = [_half_width(geometry, row) for row in _rows(pose)]
    low = tuple(at - width for at, width in zip(pose.xyz, half, strict=True))
    return [low, tuple(at + width for at, width in zip(pose.xyz, half, strict=True))]


def _half_width(geometry: Geometry, row: tuple[float, ...]) -> float:
    """Return how far a shape reaches from its centre along an axis, given in the shape's frame."""
    match geometry:
        case Box(size=size):
            return sum(abs(part) * side for part, side in zip(row, size, strict=True)) / 2
        case Sphere(radius=radius):
            return radius
        case Cylinder(radius=radius, length=length):
            return abs(row[2]) * length / 2 + math.hypot(row[0], row[1]) * radius
        case Capsule(radius=radius, length=length):
            return abs(row[2]) * length / 2 + radius
    raise TypeError(geometry)


def _points_in(file: Path | str) -> NDArray[np.float64]:
    """Return the corners of a mesh as (corners, 3), each once.

    Raises:
        MeshError, UnreadableError: with the reason why there are none.

    """
    if isinstance(file, str):
        raise UnreadableError(file)
    triangles = triangles_in(read_bytes(file, MAX_BYTES, only_regular=True) or b"", file.name)
    import numpy as np  # after `triangles_in`, which reports that it is not installed

    if not len(triangles) or not np.isfinite(triangles).all():
        raise MeshError(MeshFault.EMPTY, "it has no triangles, or coordinates that are not finite")
    return np.unique(triangles.reshape(-1, 3), axis=0)


def _box_of_points(points: NDArray[np.float64], mesh: Mesh, pose: Pose) -> list[tuple[float, ...]]:
    """Return the lowest and the highest corner of a mesh."""
    import numpy as np

    placed = points * np.array(mesh.scale.to_tuple()) @ np.array(_rows(pose)).T + np.array(pose.xyz)
    return [tuple(map(float, placed.min(axis=0))), tuple(map(float, placed.max(axis=0)))]


AT_REST = Pose.of(IDENTITY)
"""The pose of a frame relative to itself."""


class Reach(NamedTuple):
    """An upper bound of the distance between the origins of a link and of a start link [m].

    It is the sum of the lengths between the movable joints from `start` to `link`, with each prismatic joint at the
    farther end of its range. The true distance may be less, as limits may keep the robot from
    stretching out.
    """

    bound: float
    start: str
    link: str


class _Span(NamedTuple):
    """The greatest distance of the last movable joint [m], and the pose of a link in its frame."""

    bound: float
    fixed: Pose

    @property
    def end(self) -> float:
        return self.bound + math.hypot(*self.fixed.xyz)


def zero_poses(robot: Robot) -> dict[str, Pose]:
    """Return the pose of each link in the frame of the root above it, with every joint at 0."""
    above, below = parent_joints(robot.joints), child_joints(robot.joints)
    poses: dict[str, Pose] = {}
    for visit in walk_depth_first((link.name for link in robot.links if link.name not in above), below):
        if not visit.is_again:
            joint = visit.joint
            poses[visit.link] = poses[joint.parent].times(Pose.of(joint.origin)) if joint else AT_REST
    return poses


def reaches_from(robot: Robot, start: str) -> dict[str, Reach]:
    """Return the reach of each link below a start link, except those below planar and floating joints."""
    spans: dict[str, _Span] = {start: _Span(0.0, AT_REST)}
    for visit in walk_depth_first((start,), child_joints(robot.joints)):
        joint = visit.joint
        if joint and not visit.is_again and joint.parent in spans:
            span = _next_span(robot, spans[joint.parent], joint)
            if span:
                spans[visit.link] = span
    return {link: Reach(span.end, start, link) for link, span in spans.items()}


def _next_span(robot: Robot, span: _Span, joint: Joint) -> _Span | None:
    pose = span.fixed.times(Pose.of(joint.origin))
    match joint.type:
        case JointType.FIXED:
            return _Span(span.bound, pose)
        case JointType.REVOLUTE | JointType.CONTINUOUS:
            return _Span(span.bound + math.hypot(*pose.xyz), AT_REST)
        case JointType.PRISMATIC if joint.axis:
            axis = pose.turn.turned(joint.axis.to_tuple())
            if not all(map(math.isfinite, _range(robot, joint))):
                return None
            ends = (tuple(a + end * b for a, b in zip(pose.xyz, axis, strict=True)) for end in _range(robot, joint))
            return _Span(span.bound + max(math.hypot(*end) for end in ends), AT_REST)
    return None


def _range(robot: Robot, joint: Joint, followers: Sequence[str] = ()) -> tuple[float, float]:
    """Return the range of a joint, with the positions to which the joint that it follows drives it; 0 for no limit.

    A continuous joint has no end.
    """
    if joint.type is JointType.CONTINUOUS:
        return -math.inf, math.inf
    limits = joint.limits
    lower, upper = (limits.lower or 0.0, limits.upper or 0.0) if limits else (0.0, 0.0)
    mimic, leader = joint.mimic, robot.get_joint(joint.mimic.joint) if joint.mimic else None
    if not mimic or not leader or joint.name in followers:
        return lower, upper
    driven = [mimic.multiplier * end + mimic.offset for end in _range(robot, leader, (*followers, joint.name))]
    return min(lower, *driven), max(upper, *driven)


def farthest(reaches: Mapping[str, Reach]) -> Reach:
    """Return the largest reach of a link, the first of several."""
    return max(reaches.values(), key=lambda reach: reach.bound)
