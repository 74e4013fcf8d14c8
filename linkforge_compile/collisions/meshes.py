"""Find and read the meshes of a robot's collisions; a pair with an unknown shape must not count as free."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.checks.bounding import ScanBudget
from linkforge_compile.checks.mesh_files import MeshFinder, scan_mesh
from linkforge_compile.core.meshes import MAX_BYTES, MeshError, MeshFault, triangles_in
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.resolver import FileSystemResolver
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.collisions import UNKNOWN_SHAPE, UNREADABLE_SHAPE
from linkforge_compile.roots import ANYWHERE, is_file
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import read_bytes

if TYPE_CHECKING:
    import numpy as np
    from coal import BVHModelBase
    from numpy.typing import NDArray

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


def load_mesh(path: Path, scale: NDArray[np.float64]) -> BVHModelBase:
    """Return the triangles of a mesh; no other file is opened, as the loader of coal would do for materials.

    Raises:
        MeshError: The file holds no shape.
        UnreadableError: The file cannot be read.

    """
    import coal
    import numpy as np

    corners = _triangles_in(path) * scale
    vertices, places = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(corners), len(vertices))
    model.addVertices(vertices)
    model.addTriangles(places.reshape(-1, 3))
    model.endModel()
    return model


def _triangles_in(path: Path) -> NDArray[np.float64]:
    """Return the corners of a mesh's triangles, as (triangles, 3, 3); otherwise as `load_mesh`."""
    import numpy as np

    content = read_bytes(path, MAX_BYTES, only_regular=True)
    triangles = triangles_in(content or b"", path.name)
    if not len(triangles):
        raise MeshError(MeshFault.EMPTY, "it has no triangles")
    if not np.isfinite(triangles).all():
        raise MeshError(MeshFault.UNREADABLE, "the coordinates of a vertex are not finite")
    return triangles


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
    try:
        _triangles_in(path)
    except (MeshError, UnreadableError) as error:
        return error.message if isinstance(error, MeshError) else str(error)
    return None
