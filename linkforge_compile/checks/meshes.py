"""Mesh files: those that are at hand are there under the very name, hold something, and suit those who load them.

Nothing is parsed: a listing of the folder, the first bytes of a file and a few triangles out of a binary STL tell what
goes wrong most often, in a tenth of a millisecond each, so that a compile can afford it.
"""

from __future__ import annotations

import math
import os
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.checks.references import SHOWN, listed
from linkforge_compile.core.models.geometry import Mesh, Vector3
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.resolver import IResourceResolver
from linkforge_compile.diagnostics import Code, Diagnostic, Gaps, Note
from linkforge_compile.diagnostics.codes.physics import (
    CAD_MESH,
    FINE_COLLISIONS,
    HOLLOW_MESH_FILE,
    MIRRORED_COLLISIONS,
    MISSING_MESH,
    WIDE_MESH,
)
from linkforge_compile.diagnostics.codes.roots import UNSEEN_MESHES

CAD_FORMATS = frozenset(
    ("step", "stp", "iges", "igs", "sldprt", "sldasm", "ipt", "iam", "catpart", "catproduct", "f3d", "3dm", "fcstd")
)
"""Endings of what CAD programs work on, which nothing that reads URDF loads."""

WIDEST = 100.0
"""Beyond this a mesh was meant in millimetres [m]."""

FINE = 10_000
"""How many triangles make a collision costly where the same mesh is seen."""

HEADER, TRIANGLE, SAMPLES = 84, 50, 32

LFS_POINTER = b"version https://git-lfs"


class MeshFile(NamedTuple):
    """What the first look at a file tells: why it holds no shape, its triangles and its size along the axes [m].

    None for what cannot be told without reading it all.
    """

    hollow: str | None = None
    triangles: int | None = None
    size: Vector3 | None = None


class MeshUse(NamedTuple):
    """A shape that is a mesh."""

    link: Link
    shape: Visual | Collision
    mesh: Mesh


def check_mesh_files(robot: Robot, gaps: Gaps) -> Iterator[Diagnostic]:
    """A mesh that lies on this machine is there, under the very name, and holds a shape.

    RViz shows a link without it, and Gazebo refuses the link. A name in other capitals is found on Windows and
    macOS, and not on Linux. An empty file, or the pointer that Git LFS leaves where nothing was fetched, holds none; a
    mesh more than 100 m wide is in millimetres: write `scale: 0.001`. Meshes in packages that this machine does not
    have, and those of other schemes than `package` and `file`, are not looked for, nor are those outside of the
    folders that a spec may make us read. Each file is told of once, and a folder that is not there with all its files.
    """
    finder = MeshFinder(robot, gaps)
    missing: dict[Path, list[MeshUse]] = {}
    every = _mesh_uses(robot)
    read_already = {use.mesh.resource for use in every if _is_read_for_inertia(use)}
    for use in {(use.mesh.resource, use.mesh.scale): use for use in reversed(every)}.values():
        path = None if use.mesh.resource in read_already else finder.path(use.mesh.resource)
        if path and finder.names_instead_of(path) is not None:
            missing.setdefault(path if path.parent.is_dir() else path.parent, []).append(use)
        elif path and (diagnostic := _fault_in(look_at(path), use.mesh)):
            yield diagnostic
    for path, uses in missing.items():
        yield _missing(path, uses[::-1], finder)
    if unseen := [use for use in every if use.mesh.resource in finder.unseen]:
        yield _told_together(unseen, UNSEEN_MESHES, "file")


def _missing(path: Path, uses: Sequence[MeshUse], finder: MeshFinder) -> Diagnostic:
    """Tell of a file that is not there, or once of all files of a folder that is not."""
    first, *others = (use.mesh for use in uses)
    near = finder.names_instead_of(path) or ()
    sources = [(mesh.resource, mesh.source) for mesh in others[:SHOWN]]
    notes = [Note(f"looked for it at {path}")]
    notes += [Note(f"nor '{resource}'", source.at("file") if source else None) for resource, source in sources]
    return MISSING_MESH.at(first.source, "file", path=first.resource, name=path.name, near=near, notes=notes)


def _fault_in(file: MeshFile, mesh: Mesh) -> Diagnostic | None:
    if file.hollow:
        return HOLLOW_MESH_FILE.at(mesh.source, "file", path=mesh.resource, reason=file.hollow)
    if file.size is None:
        return None
    widest = max(abs(side * factor) for side, factor in zip(file.size, mesh.scale, strict=True))
    return WIDE_MESH.at(mesh.source, "file", path=mesh.resource, size=f"{widest:.2g}") if widest > WIDEST else None


def check_mesh_formats(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A mesh is in a format of triangles: .stl, .dae or .obj.

    RViz, Gazebo and MoveIt load no files of CAD programs. Export the part as a mesh, in metres.
    """
    for use in _mesh_uses(robot):
        ending = use.mesh.resource.rpartition(".")[2].lower()
        if ending in CAD_FORMATS:
            yield CAD_MESH.at(use.mesh.source, "file", path=use.mesh.resource, ending=ending)


def check_mirrored_collisions(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A collision is no mirror image.

    A negative `scale` turns the triangles of a mesh inside out, and Gazebo Sim makes no collision of such a mesh.
    Export a mirrored mesh for the other side, or take primitive shapes. Told once for all links.
    """
    mirrored = [use for use in _mesh_uses(robot) if isinstance(use.shape, Collision) and math.prod(use.mesh.scale) < 0]
    if mirrored:
        yield _told_together(mirrored, MIRRORED_COLLISIONS, "scale")


def check_fine_collisions(robot: Robot, gaps: Gaps) -> Iterator[Diagnostic]:
    """A collision is coarser than what is seen.

    Contacts cost time for each triangle. Told once for all links whose collision is the mesh of their visual and
    has 10,000 triangles or more, as far as binary STL files that are at hand tell. Take primitive shapes, the convex
    hull, or a mesh of some hundred triangles.
    """
    finder = MeshFinder(robot, gaps)
    fine: list[tuple[MeshUse, int]] = []
    for use in _mesh_uses(robot):
        is_seen = any(visual.geometry == use.mesh for visual in use.link.visuals)
        if isinstance(use.shape, Collision) and is_seen and (path := finder.path(use.mesh.resource)):
            count = look_at(path).triangles if finder.names_instead_of(path) is None else None
            if count and count >= FINE:
                fine.append((use, count))
    if fine:
        triangles = f"{sum(count for _, count in fine):,}"
        yield _told_together([use for use, _ in fine], FINE_COLLISIONS, "file", triangles=triangles)


def _told_together(uses: Sequence[MeshUse], code: Code, key: str, **facts: str) -> Diagnostic:
    sources = [(use.link.name, use.mesh.source) for use in uses[1 : SHOWN + 1]]
    notes = [Note(f"link '{name}'", source.at(key)) for name, source in sources if source]
    links = listed(dict.fromkeys(use.link.name for use in uses))
    return code.at(uses[0].mesh.source, key, near=(), notes=notes, links=links, **facts)


class MeshFinder:
    """Finds the mesh files of a robot: relative ones beside its spec, those of packages as its resolver does."""

    def __init__(self, robot: Robot, gaps: Gaps) -> None:
        self.unseen: set[str] = set()
        """Paths of meshes, as written, that lead to where a check may not look."""
        self._may_look = gaps.may_look
        self._resolver: IResourceResolver = robot.resource_resolver
        self._folder = _folder_of(robot)
        self._packages: dict[str, Path | None] = {}
        self._names: dict[Path, frozenset[str] | None] = {}

    def path(self, resource: str) -> Path | None:
        """Return where a mesh is or should be; None where this machine cannot tell, or a check may not look."""
        path = self._path(resource)
        if path is None or self._may_look(path):
            return path
        self.unseen.add(resource)
        return None

    def _path(self, resource: str) -> Path | None:
        if not resource or "\0" in resource:
            return None
        scheme, separator, rest = resource.partition("://")
        if not separator:
            path = Path(resource)
            return path if path.is_absolute() else self._folder / path if self._folder else None
        if scheme == "package":
            package, _, inside = rest.partition("/")
            return self._in_package(package, inside)
        return Path(rest) if scheme == "file" else None

    def _in_package(self, package: str, inside: str) -> Path | None:
        if package not in self._packages:
            self._packages[package] = self._resolved(f"package://{package}/")
        folder = self._packages[package]
        if folder is None or not inside:
            return None
        # A package may lie in several places, and the resolver takes the one that holds the file.
        path = folder / inside
        return path if path.exists() else self._resolved(f"package://{package}/{inside}") or path

    def _resolved(self, uri: str) -> Path | None:
        try:
            return self._resolver.resolve(uri, relative_to=self._folder)
        except OSError:
            return None

    def names_instead_of(self, path: Path) -> frozenset[str] | None:
        """Return what lies in a folder that lacks this file, spelt like this; None where it is there."""
        names = self._listed(path.parent)
        if names is None:
            return None if path.is_file() else frozenset()
        return None if path.name in names and path.is_file() else names

    def _listed(self, folder: Path) -> frozenset[str] | None:
        if folder not in self._names:
            try:
                self._names[folder] = frozenset(os.listdir(folder))  # noqa: PTH208 a tenth of iterdir
            except OSError:
                self._names[folder] = None
        return self._names[folder]


def look_at(path: Path) -> MeshFile:
    """Return what the beginning of a mesh file tells, and a few triangles of a binary STL; nothing if it is closed."""
    try:
        with path.open("rb") as stream:
            length = os.fstat(stream.fileno()).st_size
            start = stream.read(HEADER)
            if not start.strip():
                return MeshFile(hollow="it is empty")
            if start.startswith(LFS_POINTER):
                return MeshFile(hollow="it is a pointer of Git LFS; run 'git lfs pull'")
            count = int.from_bytes(start[80:], "little")
            if path.suffix.lower() != ".stl" or len(start) < HEADER or length != HEADER + TRIANGLE * count:
                return MeshFile()
            if not count:
                return MeshFile(hollow="it has no triangles")
            corners = []
            for sample in range(min(SAMPLES, count)):
                stream.seek(HEADER + TRIANGLE * (sample * count // min(SAMPLES, count)) + 12)
                corners.append(struct.unpack("<9f", stream.read(36)))
    except (OSError, struct.error):
        return MeshFile()
    sides = [[number for corner in corners for number in corner[axis::3]] for axis in range(3)]
    x, y, z = (max(side) - min(side) for side in sides)
    size = Vector3(x, y, z) if x + y + z < float("inf") else None
    return MeshFile(triangles=count, size=size)


def _mesh_uses(robot: Robot) -> Sequence[MeshUse]:
    uses = []
    for link in robot.links:
        shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
        uses += [MeshUse(link, shape, shape.geometry) for shape in shapes if isinstance(shape.geometry, Mesh)]
    return uses


def _is_read_for_inertia(use: MeshUse) -> bool:
    """Whether an inertia was, or was to be, computed from the mesh: who did so has told what is wrong with it."""
    link, inertial = use.link, use.link.inertial
    if link.source is None or inertial is None or use.shape not in (link.collisions or link.visuals):
        return False
    return inertial.source is None or inertial.source.node.child("inertia") is None


def _folder_of(robot: Robot) -> Path | None:
    path = robot.source.span.file.path if robot.source else None
    return path.parent if path else None
