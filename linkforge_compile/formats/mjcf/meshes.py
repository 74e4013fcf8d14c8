"""Meshes in MJCF: their files on this machine, under names that geoms refer to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

_ENDINGS = (".stl", ".obj", ".msh")

_STL_HEADER, _STL_TRIANGLE = 84, 50
"""The sizes of the header and of a triangle of a binary STL file [bytes]."""

_MAX_TRIANGLES = 200_000


class MeshFile(NamedTuple):
    """A mesh with its file, None for one that is not found, and why MuJoCo cannot read it, None if it can."""

    mesh: Mesh
    path: Path | None
    fault: str | None


class MeshAssets(NamedTuple):
    """The meshes of an MJCF: their elements, their names for geoms, and the folder of their files.

    The folder is None where all paths are relative to the document, as they are in the spec.
    """

    elements: Sequence[Xml]
    names: Mapping[Mesh, str]
    folder: str | None


def mesh_files(robot: Robot) -> Iterator[MeshFile]:
    """Yield each mesh of a robot once."""
    spec = robot.source.span.file.path if robot.source else None
    folder = spec.parent if spec else None
    for mesh in dict.fromkeys(shape.geometry for link in robot.links for shape in link.shapes):
        if isinstance(mesh, Mesh):
            path = _resolved(robot, mesh.resource, folder)
            yield MeshFile(mesh, path, _fault(mesh, path))


def _resolved(robot: Robot, resource: str, folder: Path | None) -> Path | None:
    try:
        return Path(os.path.normpath(robot.resource_resolver.resolve(resource, relative_to=folder)))
    except (OSError, ValueError):  # ValueError: a name that no file can have
        return None


def _fault(mesh: Mesh, path: Path | None) -> str | None:
    ending = Path(mesh.resource).suffix.lower()
    if ending not in _ENDINGS:
        return "MuJoCo reads STL, OBJ and MSH"
    if path is None:
        return "the file is not found"
    # The size alone shows a binary STL; no file of a stranger's spec is opened.
    triangles, rest = divmod(path.stat().st_size - _STL_HEADER, _STL_TRIANGLE)
    if ending == ".stl" and (rest or not 0 < triangles <= _MAX_TRIANGLES):
        return f"MuJoCo reads binary STL of up to {_MAX_TRIANGLES:,} triangles"
    return None


def mesh_assets(robot: Robot) -> MeshAssets:
    """Return the meshes that MuJoCo can read, each with a name of its own."""
    found = [(one.mesh, one.path) for one in mesh_files(robot) if one.path and not one.fault]
    if all(_is_relative(mesh.resource) for mesh, _ in found):
        folder, files = None, [mesh.resource for mesh, _ in found]
    else:
        folder = os.path.commonpath([path.parent for _, path in found])
        files = [path.relative_to(folder).as_posix() for _, path in found]
    names: dict[Mesh, str] = {}
    for mesh, _ in found:
        names[mesh] = _new_name(Path(mesh.resource).stem, set(names.values()))
    elements = [
        leaf_at("mesh", mesh.source, name=names[mesh], file=file, scale=mesh.scale if mesh.is_scale_written else None)
        for (mesh, _), file in zip(found, files, strict=True)
    ]
    return MeshAssets(elements, names, Path(folder).as_posix() if folder else None)


def _is_relative(resource: str) -> bool:
    return "://" not in resource and not Path(resource).is_absolute()


def _new_name(stem: str, taken: set[str]) -> str:
    name, number = stem, 1
    while name in taken:
        number += 1
        name = f"{stem}_{number}"
    return name
