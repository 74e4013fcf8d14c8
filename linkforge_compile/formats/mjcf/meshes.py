"""Meshes in MJCF: their files on this machine, under names that geoms refer to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.core.meshes.stl import HEADER, TRIANGLE
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.naming import unique_name
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.mesh_paths import is_relative, mesh_paths, reason_not_found
from linkforge_compile.formats.xml_text import Xml

_ENDINGS = (".stl", ".obj", ".msh")

_MAX_TRIANGLES = 200_000

_CONVERT = "'linkforge explain LF7404' has a command that converts it"


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
    for mesh, path in mesh_paths(robot):
        yield MeshFile(mesh, path, _fault(robot, mesh, path))


def _fault(robot: Robot, mesh: Mesh, path: Path | None) -> str | None:
    ending = Path(mesh.resource).suffix.lower()
    if ending not in _ENDINGS:
        return f"MuJoCo reads STL, OBJ and MSH; {_CONVERT}"
    if path is None:
        return reason_not_found(robot, mesh.resource)
    # The size alone shows a binary STL; no file of a stranger's spec is opened.
    triangles, rest = divmod(path.stat().st_size - HEADER, TRIANGLE)
    if ending == ".stl" and not rest and triangles == 1:
        return "MuJoCo refuses a mesh of one triangle"
    if ending == ".stl" and (rest or not 0 < triangles <= _MAX_TRIANGLES):
        return f"MuJoCo reads binary STL of up to {_MAX_TRIANGLES:,} triangles; {_CONVERT}"
    return None


def mesh_assets(robot: Robot) -> MeshAssets:
    """Return the meshes that MuJoCo can read, each with a name of its own."""
    found = [(one.mesh, one.path) for one in mesh_files(robot) if one.path and not one.fault]
    if all(is_relative(mesh.resource) for mesh, _ in found):
        folder, files = None, [mesh.resource for mesh, _ in found]
    else:
        folder = os.path.commonpath([path.parent for _, path in found])
        files = [path.relative_to(folder).as_posix() for _, path in found]
    names: dict[Mesh, str] = {}
    for mesh, _ in found:
        names[mesh] = unique_name(Path(mesh.resource).stem, set(names.values()))
    elements = [
        leaf_at("mesh", mesh.source, name=names[mesh], file=file, scale=mesh.scale if mesh.is_scale_written else None)
        for (mesh, _), file in zip(found, files, strict=True)
    ]
    return MeshAssets(elements, names, Path(folder).as_posix() if folder else None)
