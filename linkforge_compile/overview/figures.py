"""Key figures of a robot: counts, masses, sizes, files and parts by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.poses import Pose
from linkforge_compile.formats.groups import joints_by_group
from linkforge_compile.formats.mesh_paths import meshes_of
from linkforge_compile.overview.extent import Extent, Reach, farthest, measure_extent, reaches_from, zero_poses
from linkforge_compile.overview.graph import module_boxes, walk_boxes
from linkforge_compile.overview.tree import tree_rows
from linkforge_compile.shape_files import ShapeFiles
from linkforge_compile.source.characters import UnreadableError


class Mass(NamedTuple):
    """The mass of all links [kg] and its centre in the frame of the root [m], None without mass; links without any."""

    total: float
    centre: tuple[float, ...] | None
    links_without: Sequence[str]


class MeshFile(NamedTuple):
    """The file of a mesh as it is written, its size [bytes], and the reason if that is None."""

    resource: str
    size: int | None
    missing: str | None


class Part(NamedTuple):
    """A part with its kind, and the link or the parts that it is about."""

    name: str
    kind: str
    about: Sequence[str] = ()


class Group(NamedTuple):
    """A planning group with its joints, its states, and the reach of its chain, None for a group of another kind."""

    name: str
    joints: Sequence[str]
    states: Sequence[str]
    reach: Reach | None


class Figures(NamedTuple):
    """What `linkforge info` shows.

    - `joints`: how many there are of each type; `degrees_of_freedom` leaves out joints that follow others.
    - `reach`: the largest from the root, of the links that are not below planar and floating joints.
    - `modules`: the number of links by the name of the module, inner ones after a slash.
    """

    name: str
    root: str
    links: int
    joints: Mapping[str, int]
    degrees_of_freedom: int
    mimics: int
    mass: Mass
    reach: Reach
    extent: Extent
    meshes: Sequence[MeshFile]
    sensors: Sequence[Part]
    hardware: Sequence[Part]
    controllers: Sequence[Part]
    groups: Sequence[Group]
    end_effectors: Sequence[Part]
    modules: Mapping[str, int]


def figures_of(robot: Robot) -> Figures:
    """Return the figures of a robot that is one tree; mesh files are read if the library is installed."""
    poses = zero_poses(robot)
    root = next(iter(poses))
    files = mesh_files(robot)
    modules = [box for box in walk_boxes(module_boxes(tree_rows(robot))) if box.module]
    semantic = robot.semantic
    return Figures(
        name=robot.name,
        root=root,
        links=len(robot.links),
        joints=Counter(str(joint.type) for joint in robot.joints),
        degrees_of_freedom=sum(joint.degrees_of_freedom for joint in robot.joints if not joint.mimic),
        mimics=sum(1 for joint in robot.joints if joint.mimic),
        mass=mass_of(robot, poses),
        reach=farthest(reaches_from(robot, root)),
        extent=measure_extent(robot, poses, files),
        meshes=[_mesh_file(resource, file) for resource, file in files.items()],
        sensors=[Part(one.name, str(one.type), (one.link_name,)) for one in robot.sensors],
        hardware=[
            Part(one.name, f"{one.type} {one.hardware_plugin}", tuple(joint.name for joint in one.joints))
            for one in robot.ros2_controls
        ],
        controllers=[Part(one.name, one.type, one.joints) for one in robot.controllers if one.type],
        groups=_groups(robot),
        end_effectors=[Part(one.name, one.group, (one.parent_link,)) for one in semantic.end_effectors],
        modules={"/".join(box.module): len(box.links) for box in modules},
    )


def mass_of(robot: Robot, poses: Mapping[str, Pose]) -> Mass:
    """Return the mass of a robot and its centre, with the links at some poses."""
    bodies = [(link.mass, poses[link.name], link.inertial_origin) for link in robot.links if link.mass]
    total = sum(mass for mass, _, _ in bodies)
    centre = None
    if total:
        placed = []
        for mass, pose, origin in bodies:
            turned = pose.turn.turned(origin.xyz.to_tuple())
            placed.append([mass * (at + inside) for at, inside in zip(pose.xyz, turned, strict=True)])
        centre = tuple(sum(axis) / total for axis in zip(*placed, strict=True))
    return Mass(total, centre, [link.name for link in robot.links if not link.mass])


def mesh_files(robot: Robot) -> dict[str, Path | str]:
    """Return the file of each mesh as it is written, or the reason why there is none."""
    files, found = ShapeFiles(robot), dict[str, Path | str]()
    for mesh in meshes_of(robot):
        try:
            found[mesh.resource] = files.find(mesh.resource)
        except UnreadableError as error:
            found[mesh.resource] = str(error)
    return found


def _mesh_file(resource: str, file: Path | str) -> MeshFile:
    if isinstance(file, str):
        return MeshFile(resource, None, file)
    return MeshFile(resource, file.stat().st_size, None)


def _groups(robot: Robot) -> list[Group]:
    semantic, by_group = robot.semantic, joints_by_group(robot)
    states = [(state.group, state.name) for state in semantic.group_states]
    return [
        Group(
            group.name,
            [joint.name for joint in by_group.get(group.name, ())],
            [state for owner, state in states if owner == group.name],
            _reach_of_chain(robot, [(chain.base_link, chain.tip_link) for chain in group.chains]),
        )
        for group in semantic.groups
    ]


def _reach_of_chain(robot: Robot, chains: Iterable[tuple[str, str]]) -> Reach | None:
    """Return the reach of the tip of one chain from its base; None for several chains, and one that leads upwards."""
    match list(chains):
        case [(base, tip)]:
            return reaches_from(robot, base).get(tip)
    return None
