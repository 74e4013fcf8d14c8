"""The mesh files of a robot: where they are, and what a first look at each tells.

Nothing is parsed: a listing of the folder, the first bytes of a file and a few of its corners tell what goes wrong most
often, in less than a millisecond each, so that a compile can afford it.
"""

from __future__ import annotations

import math
import os
import re
import struct
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

from linkforge_compile.checks.extents import Extent, Room, room_of
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.resolver import FileSystemResolver, IResourceResolver
from linkforge_compile.diagnostics import UnresolvedNames
from linkforge_compile.roots import exists, is_file

HEADER, TRIANGLE, SAMPLES = 84, 50, 128
"""How many bytes of a binary STL are before its triangles and in each, and how many of them are looked at."""

WIDEST = 100.0
"""Beyond this a mesh was meant in millimetres [m]."""

LARGEST = 8 * 1024 * 1024
"""Of a larger COLLADA file, which is looked at as a whole, no corners are taken [bytes]."""

PIECES, PIECE = 8, 8192
"""How many pieces of a mesh that is text are looked at, and how many bytes each has."""

MOST_NOWHERE = 500
"""Behind so many packages that are nowhere only those are looked for whose folders are declared."""

LFS_POINTER = b"version https://git-lfs"

_CORNER = re.compile(rb"^[ \t]*v(?:ertex)?[ \t]+(\S{1,40})[ \t]+(\S{1,40})[ \t]+(\S{1,40})(?=\s)", re.MULTILINE)
"""A corner in OBJ, or in an STL of text."""


class MeshFile(NamedTuple):
    """What the first look at a file tells: why it holds no shape, its triangles, and the box of corners from all over
    it, in the unit of the file.

    None for what cannot be told without reading it all.
    """

    hollow: str | None = None
    triangles: int | None = None
    box: Extent | None = None


class MeshUse(NamedTuple):
    """A shape that is a mesh."""

    link: Link
    shape: Visual | Collision
    mesh: Mesh


class Effort:
    """How much is looked at in all scenes of a robot, in tags, nodes and corners: half a million take a second."""

    def __init__(self, room: int = 500_000) -> None:
        self._room = room

    def takes(self, count: int) -> bool:
        """Count what is to be looked at; False where there is no room for it, nor for anything behind it."""
        self._room -= count
        return self._room >= 0


class RobotMeshes:
    """The meshes of one robot, and the room of its links: each looked for and looked at once, when somebody asks."""

    def __init__(self, robot: Robot, unresolved: UnresolvedNames) -> None:
        self.uses: Sequence[MeshUse] = tuple(_uses(robot))
        self.finder = MeshFinder(robot, unresolved)
        self._looked_at: dict[Path, MeshFile] = {}
        self._rooms: dict[str, Room | None] = {}
        self._effort = Effort()

    def file(self, mesh: Mesh) -> MeshFile | None:
        """Return what a look at the file tells; None where it is not at hand."""
        path = self.finder.path(mesh.resource)
        if path is None or self.finder.names_instead_of(path) is not None:
            return None
        if path not in self._looked_at:
            self._looked_at[path] = look_at(path, self._effort)
        return self._looked_at[path]

    def box(self, mesh: Mesh) -> Extent | None:
        """Return the box around a mesh in its own frame, scaled [m]; somewhat too small, as not all is looked at."""
        file = self.file(mesh)
        if file is None or file.box is None:
            return None
        corners = [[at * factor for at, factor in zip(corner, mesh.scale, strict=True)] for corner in file.box]
        return _around(corners)

    def fitting_box(self, mesh: Mesh) -> Extent | None:
        """Return the box of a mesh for who measures others by it: not of one that is told to be too wide itself."""
        box = self.box(mesh)
        return box if box and max(box.sides) <= WIDEST else None

    def room(self, link: Link) -> Room | None:
        """Return the room of a link of the robot, by the boxes of meshes that fit; None where it is not known."""
        if link.name not in self._rooms:
            self._rooms[link.name] = room_of(link, self.fitting_box)
        return self._rooms[link.name]


class MeshFinder:
    """Finds the mesh files of a robot: relative ones beside its spec, those of packages as its resolver does."""

    def __init__(self, robot: Robot, unresolved: UnresolvedNames) -> None:
        self.unseen: set[str] = set()
        """Paths of meshes, as written, that lead to where a check may not look."""
        self.unsought: dict[str, str] = {}
        """The package of each mesh, as written, whose package was not looked for: too many others are nowhere."""
        self._may_look = unresolved.may_look
        resolver = robot.resource_resolver
        self._resolver: IResourceResolver = resolver
        self._declared = frozenset(resolver.packages if isinstance(resolver, FileSystemResolver) else ())
        self._nowhere = 0
        self._folder = _folder_of(robot)
        self._packages: dict[str, Path | None] = {}
        self._names: dict[Path, frozenset[str] | None] = {}
        self._open_folders: dict[Path, bool] = {}

    def path(self, resource: str) -> Path | None:
        """Return where a mesh is or should be; None where this machine cannot tell, or a check may not look."""
        path = self._path(resource)
        if path is None or self._may_look_at(path):
            return path
        self.unseen.add(resource)
        return None

    def _may_look_at(self, path: Path) -> bool:
        """Whether a check may look at a file; to follow the way to its folder takes long, so what that gave is kept."""
        folder = path.parent
        if folder not in self._open_folders:
            self._open_folders[folder] = self._may_look(folder)
        is_plain = self._open_folders[folder] and path.name != ".." and not os.path.islink(path)  # noqa: PTH114 see roots
        return is_plain or self._may_look(path)

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
            if self._nowhere >= MOST_NOWHERE and package not in self._declared:
                self.unsought[f"package://{package}/{inside}"] = package
                return None
            self._packages[package] = self._resolved(f"package://{package}/")
            self._nowhere += self._packages[package] is None
        folder = self._packages[package]
        if folder is None or not inside:
            return None
        # A package may lie in several places, and the resolver takes the one that holds the file.
        path = folder / inside
        return path if exists(path) else self._resolved(f"package://{package}/{inside}") or path

    def _resolved(self, uri: str) -> Path | None:
        try:
            return self._resolver.resolve(uri, relative_to=self._folder)
        except OSError:
            return None

    def names_instead_of(self, path: Path) -> frozenset[str] | None:
        """Return what lies in a folder that lacks this file, spelt like this; None where it is there."""
        names = self._listed(path.parent)
        if names is None:
            return None if is_file(path) else frozenset()
        return None if path.name in names and is_file(path) else names

    def _listed(self, folder: Path) -> frozenset[str] | None:
        if folder not in self._names:
            try:
                self._names[folder] = frozenset(os.listdir(folder))  # noqa: PTH208 a tenth of iterdir
            except OSError:
                self._names[folder] = None
        return self._names[folder]


def look_at(path: Path, effort: Effort) -> MeshFile:
    """Return what the beginning of a mesh file and a few of its corners tell; nothing if it is closed to us.

    `effort` is what may be spent on scenes.
    """
    try:
        with path.open("rb") as stream:
            length = os.fstat(stream.fileno()).st_size
            start = stream.read(HEADER)
            if not start.strip():
                return MeshFile(hollow="it is empty")
            if start.startswith(LFS_POINTER):
                return MeshFile(hollow="it is a pointer of Git LFS; run 'git lfs pull'")
            ending, count = path.suffix.lower(), int.from_bytes(start[80:], "little")
            if ending == ".stl" and len(start) == HEADER and length == HEADER + TRIANGLE * count:
                corners = _corners_of_triangles(stream, count)
                return MeshFile(None, count, _around(corners)) if count else MeshFile(hollow="it has no triangles")
            if ending == ".obj" or (ending == ".stl" and start.lstrip().lower().startswith(b"solid")):
                return MeshFile(box=_around(_corners_in_text(stream, length)))
            if ending == ".dae" and length <= LARGEST:
                from linkforge_compile.checks.collada import corners_of_scene

                stream.seek(0)
                return MeshFile(box=_around(corners_of_scene(stream.read(LARGEST), effort)))
    except (OSError, struct.error):
        pass
    return MeshFile()


def _corners_of_triangles(stream: BinaryIO, count: int) -> Iterator[Sequence[float]]:
    """Yield the corners of a few triangles from all over a binary STL."""
    samples = min(SAMPLES, count)
    for sample in range(samples):
        stream.seek(HEADER + TRIANGLE * (sample * count // samples) + 12)
        numbers = struct.unpack("<9f", stream.read(36))
        yield from (numbers[:3], numbers[3:6], numbers[6:])


def _corners_in_text(stream: BinaryIO, length: int) -> Iterator[Sequence[float]]:
    """Yield the corners in a few pieces from all over a mesh that is text, in all of it if it is short."""
    pieces = PIECES if length > PIECES * PIECE else 1
    for piece in range(pieces):
        stream.seek(piece * (length // pieces))
        text = stream.read(PIECE if pieces > 1 else length)
        # A piece begins within a line, which may look like another one.
        text = text.partition(b"\n")[2] if piece else text
        for corner in _CORNER.finditer(text):
            try:
                yield tuple(map(float, corner.groups()))
            except ValueError:
                continue


def _around(corners: Iterable[Sequence[float]]) -> Extent | None:
    """Return the box around corners; None for none, and for what no shape has."""
    axes = list(zip(*corners, strict=True))
    if not axes or not all(math.isfinite(sum(map(abs, axis))) for axis in axes):
        return None
    (x, y, z), (to_x, to_y, to_z) = map(min, axes), map(max, axes)
    return Extent((x, y, z), (to_x, to_y, to_z))


def _uses(robot: Robot) -> Iterator[MeshUse]:
    for link in robot.links:
        shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
        for shape in shapes:
            if isinstance(shape.geometry, Mesh):
                yield MeshUse(link, shape, shape.geometry)


def _folder_of(robot: Robot) -> Path | None:
    path = robot.source.span.file.path if robot.source else None
    return path.parent if path else None
