"""The meshes of a robot that is built in Python, found by its resolver."""

from __future__ import annotations

from collections.abc import Iterable

from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.meshes.faults import MeshError
from linkforge_compile.core.meshes.read import solid_in
from linkforge_compile.core.models.geometry import Geometry, Mesh
from linkforge_compile.core.resolver import IResourceResolver
from linkforge_compile.core.solid import Solid


def solids_of(geometries: Iterable[Geometry], resolver: IResourceResolver) -> dict[Mesh, Solid]:
    """Return each mesh among shapes as a solid in its own frame [m], scaled.

    Raises:
        RobotPhysicsError: NOT_FOUND for a file that cannot be read; as MeshError says for one with no solid in it.

    """
    return {mesh: _solid(mesh, resolver).scaled(mesh.scale) for mesh in geometries if isinstance(mesh, Mesh)}


def _solid(mesh: Mesh, resolver: IResourceResolver) -> Solid:
    try:
        path = resolver.resolve(mesh.resource)
        content = path.read_bytes()
    except OSError as error:
        code, reason = ValidationErrorCode.NOT_FOUND, error.strerror or "there is no such file"
    else:
        try:
            return solid_in(content, path.name)
        except MeshError as error:
            code, reason = error.code, error.message
    raise RobotPhysicsError(
        code,
        f"the inertia of mesh '{mesh.resource}' cannot be computed: {reason}; state mass and inertia",
        target="Mesh",
        value=mesh.resource,
    )
