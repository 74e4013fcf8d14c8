"""Find and read the meshes of a robot's collisions; a pair with an unknown shape must not count as free."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.checks.bounding import ScanBudget
from linkforge_compile.checks.mesh_files import scan_mesh
from linkforge_compile.core.meshes import MAX_BYTES, MeshError, MeshFault, triangles_in
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.collisions import UNKNOWN_SHAPE, UNREADABLE_SHAPE
from linkforge_compile.shape_files import ShapeFiles
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import read_bytes

if TYPE_CHECKING:
    import numpy as np
    from coal import BVHModelBase
    from numpy.typing import NDArray


def find_meshes(robot: Robot, sink: Diagnostics) -> dict[str, Path]:
    """Return the files of the meshes of collisions, as they are written; report those that cannot be read."""
    files, budget = ShapeFiles(robot), ScanBudget()
    paths: dict[str, Path] = {}
    for mesh in _collision_meshes(robot):
        try:
            path = files.find(mesh.resource)
        except UnreadableError as error:
            sink.report(UNKNOWN_SHAPE.at(mesh.source, "file", file=mesh.resource, reason=str(error)))
            continue
        if fault := scan_mesh(path, budget).fault or _fault_in(path):
            sink.report(UNREADABLE_SHAPE.at(mesh.source, "file", file=mesh.resource, reason=fault))
        else:
            paths[mesh.resource] = path
    return paths


def load_mesh(path: Path, scale: NDArray[np.float64]) -> BVHModelBase:
    """Return the triangles of a mesh; no other file is opened, as the loader of coal would do for materials.

    Raises:
        MeshError: The file contains no shape.
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


def _fault_in(path: Path) -> str | None:
    try:
        _triangles_in(path)
    except (MeshError, UnreadableError) as error:
        return error.message if isinstance(error, MeshError) else str(error)
    return None
