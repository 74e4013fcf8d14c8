"""Mesh files: those that are at hand are there under the very name, hold something, and suit those who load them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from linkforge_compile.checks.mesh_files import WIDEST, MeshFinder, MeshUse, RobotMeshes
from linkforge_compile.checks.references import SHOWN, listed
from linkforge_compile.core.models.geometry import Mesh, Vector3
from linkforge_compile.core.models.link import Collision
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, Note
from linkforge_compile.diagnostics.codes.physics import (
    CAD_MESH,
    FINE_COLLISIONS,
    HOLLOW_MESH_FILE,
    MIRRORED_COLLISIONS,
    MISSING_MESH,
    WIDE_MESH,
)
from linkforge_compile.diagnostics.codes.roots import UNSEEN_MESHES, UNSOUGHT_MESHES
from linkforge_compile.roots import is_folder

CAD_FORMATS = frozenset(
    ("step", "stp", "iges", "igs", "sldprt", "sldasm", "ipt", "iam", "catpart", "catproduct", "f3d", "3dm", "fcstd")
)
"""Endings of what CAD programs work on, which nothing that reads URDF loads."""

MOST_ALONE = 100
"""So many files that are missing in folders that are there are told one by one, and the rest by their folders."""

FINE = 10_000
"""How many triangles make a collision costly where the same mesh is seen."""


def check_mesh_files(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A mesh that lies on this machine is there, under the very name, and holds a shape.

    RViz shows a link without it, and Gazebo refuses the link. A name in other capitals is found on Windows and
    macOS, and not on Linux. An empty file, or the pointer that Git LFS leaves where nothing was fetched, holds none; a
    mesh more than 100 m wide is in millimetres: write `scale: 0.001`. Meshes in packages that this machine does not
    have, and those of other schemes than `package` and `file`, are not looked for, nor are those outside of the
    folders that a spec may make us read. Each file is told of once. The files of a folder that is not there are told
    together, the first by name and with the rest counted, and so, behind a hundred, are those of one that is there.
    """
    finder = meshes.finder
    missing: dict[Path, dict[str, Mesh]] = {}
    read_already = {use.mesh.resource for use in meshes.uses if _is_read_for_inertia(use)}
    judged = [use for use in meshes.uses if use.mesh.resource not in read_already]
    firsts: dict[tuple[str, Vector3], MeshUse] = {}
    for use in judged:
        firsts.setdefault((use.mesh.resource, use.mesh.scale), use)
    for use in firsts.values():
        path = finder.path(use.mesh.resource)
        if path and finder.names_instead_of(path) is not None:
            is_alone = len(missing) < MOST_ALONE and is_folder(path.parent)
            together = missing.setdefault(path if is_alone else path.parent, {})
            together.setdefault(use.mesh.resource, use.mesh)
        elif diagnostic := _fault_in(meshes, use.mesh):
            yield diagnostic
    for path, by_resource in missing.items():
        yield _missing(path, by_resource.values(), finder)
    if unseen := [use for use in judged if use.mesh.resource in finder.unseen]:
        yield _told_together(unseen, UNSEEN_MESHES, "file")
    if unsought := [use for use in judged if use.mesh.resource in finder.unsought]:
        count = len({finder.unsought[use.mesh.resource] for use in unsought})
        packages = f"{count:,} package{'s' if count > 1 else ''}"
        yield _told_together(unsought, UNSOUGHT_MESHES, "file", packages=packages)


def _missing(path: Path, meshes: Iterable[Mesh], finder: MeshFinder) -> Diagnostic:
    """Tell of a file that is not there, or once of all such files of a folder."""
    first, *others = meshes
    if is_folder(path):
        path = finder.path(first.resource) or path
    near = finder.names_instead_of(path) or ()
    sources = [(mesh.resource, mesh.source) for mesh in others[:SHOWN]]
    notes = [Note(f"looked for it at {path}")]
    notes += [Note(f"nor '{resource}'", source.at("file") if source else None) for resource, source in sources]
    if (more := len(others) - SHOWN) > 0:
        notes.append(Note(f"and {more:,} more in this folder"))
    return MISSING_MESH.at(first.source, "file", path=first.resource, name=path.name, near=near, notes=notes)


def _fault_in(meshes: RobotMeshes, mesh: Mesh) -> Diagnostic | None:
    file, box = meshes.file(mesh), meshes.box(mesh)
    if file and file.hollow:
        return HOLLOW_MESH_FILE.at(mesh.source, "file", path=mesh.resource, reason=file.hollow)
    widest = max(box.sides) if box else 0.0
    return WIDE_MESH.at(mesh.source, "file", path=mesh.resource, size=f"{widest:.2g}") if widest > WIDEST else None


def check_mesh_formats(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A mesh is in a format of triangles: .stl, .dae or .obj.

    RViz, Gazebo and MoveIt load no files of CAD programs. Export the part as a mesh, in metres.
    """
    for use in meshes.uses:
        ending = use.mesh.resource.rpartition(".")[2].lower()
        if ending in CAD_FORMATS:
            yield CAD_MESH.at(use.mesh.source, "file", path=use.mesh.resource, ending=ending)


def check_mirrored_collisions(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A collision is no mirror image.

    A negative `scale` turns the triangles of a mesh inside out, and Gazebo Sim makes no collision of such a mesh.
    Export a mirrored mesh for the other side, or take primitive shapes. Told once for all links.
    """
    mirrored = [use for use in meshes.uses if isinstance(use.shape, Collision) and math.prod(use.mesh.scale) < 0]
    if mirrored:
        yield _told_together(mirrored, MIRRORED_COLLISIONS, "scale")


def check_fine_collisions(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A collision is coarser than what is seen.

    Contacts cost time for each triangle. Told once for all links whose collision is the mesh of their visual and
    has 10,000 triangles or more, as far as binary STL files that are at hand tell. Take primitive shapes, the convex
    hull, or a mesh of some hundred triangles.
    """
    fine: list[tuple[MeshUse, int]] = []
    seen = {(use.link.name, use.mesh) for use in meshes.uses if not isinstance(use.shape, Collision)}
    for use in meshes.uses:
        is_both = isinstance(use.shape, Collision) and (use.link.name, use.mesh) in seen
        file = meshes.file(use.mesh) if is_both else None
        if file and file.triangles and file.triangles >= FINE:
            fine.append((use, file.triangles))
    if fine:
        triangles = f"{sum(count for _, count in fine):,}"
        yield _told_together([use for use, _ in fine], FINE_COLLISIONS, "file", triangles=triangles)


def _told_together(uses: Sequence[MeshUse], code: Code, key: str, **facts: str) -> Diagnostic:
    sources = [(use.link.name, use.mesh.source) for use in uses[1 : SHOWN + 1]]
    notes = [Note(f"link '{name}'", source.at(key)) for name, source in sources if source]
    links = listed(dict.fromkeys(use.link.name for use in uses))
    return code.at(uses[0].mesh.source, key, near=(), notes=notes, links=links, **facts)


def _is_read_for_inertia(use: MeshUse) -> bool:
    """Whether an inertia was, or was to be, computed from the mesh: who did so has told what is wrong with it."""
    link, inertial = use.link, use.link.inertial
    if link.source is None or inertial is None or use.shape not in (link.collisions or link.visuals):
        return False
    return inertial.source is None or inertial.source.node.child("inertia") is None
