"""Find and read the meshes of a robot's collisions; a pair with an unknown shape must not count as free."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkforge_compile.checks.bounding import ScanBudget
from linkforge_compile.checks.mesh_files import MeshFinder, scan_mesh
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.resolver import FileSystemResolver
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.collisions import UNKNOWN_SHAPE, UNREADABLE_SHAPE
from linkforge_compile.roots import ANYWHERE, is_file

if TYPE_CHECKING:
    from coal import BVHModelBase

_PACKAGE = "package://"


def find_meshes(robot: Robot, sink: Diagnostics) -> dict[str, Path]:
    """Return the files of the meshes of collisions, as they are written; report those that cannot be read."""
    resolver = robot.resource_resolver
    roots = resolver.roots if isinstance(resolver, FileSystemResolver) else ANYWHERE
    finder = MeshFinder(robot, UnresolvedNames().with_access(roots.hold))
    budget = ScanBudget()
    paths: dict[str, Path] = {}
    for mesh in _collision_meshes(robot):
        path = finder.path(mesh.resource)
        if path is None or not is_file(path):
            sink.report(_unknown(mesh, path, is_forbidden=mesh.resource in finder.forbidden))
        elif fault := scan_mesh(path, budget).fault or _fault_in(path):
            sink.report(UNREADABLE_SHAPE.at(mesh.source, "file", file=mesh.resource, reason=fault))
        else:
            paths[mesh.resource] = path
    return paths


def load_mesh(path: Path, scale: Any) -> BVHModelBase:  # Any: coal takes an array of numpy
    """Return the triangles of a mesh.

    Raises:
        ValueError: The file cannot be read.

    """
    import coal

    return coal.MeshLoader(coal.BV_OBBRSS).load(str(path), scale)


def _collision_meshes(robot: Robot) -> Iterator[Mesh]:
    """Yield each file of a mesh once."""
    meshes: dict[str, Mesh] = {}
    for link in robot.links:
        for collision in link.collisions:
            if isinstance(collision.geometry, Mesh):
                meshes.setdefault(collision.geometry.resource, collision.geometry)
    yield from meshes.values()


def _unknown(mesh: Mesh, path: Path | None, *, is_forbidden: bool) -> Diagnostic:
    if is_forbidden:
        reason, way_out = "is outside of the folders that a spec may read", "use --allow-outside"
    elif path is None and mesh.resource.startswith(_PACKAGE):
        package = mesh.resource.removeprefix(_PACKAGE).partition("/")[0]
        reason, way_out = "is not found", f"name the folder of its package with --package {package}=PATH"
    else:
        reason, way_out = "is not found", "correct its path"
    notes = [Note(f"looked for it at {path}")] if path else []
    return UNKNOWN_SHAPE.at(mesh.source, "file", file=mesh.resource, reason=reason, way_out=way_out, notes=notes)


def _fault_in(path: Path) -> str | None:
    import numpy as np

    try:
        load_mesh(path, np.ones(3))
    except (ValueError, RuntimeError) as error:
        # coal names its own files and lines first.
        return " ".join(str(error).rpartition("message:")[2].split())[:200]
    return None
