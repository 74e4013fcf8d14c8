"""URIs of meshes and textures in SDF, as Gazebo finds them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.mesh_paths import find_file

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

_PACKAGE, _MODEL = "package://", "model://"


class MeshUris:
    """Makes the URIs of files: `model://` for those of packages, or the files on this machine."""

    def __init__(self, robot: Robot, *, is_resolved: bool) -> None:
        self._robot, self._is_resolved = robot, is_resolved

    def of(self, resource: str) -> str:
        """Return the URI of a file; one that is not found on this machine is not resolved."""
        path = find_file(self._robot, resource) if self._is_resolved else None
        if path:
            return path.as_posix()  # Gazebo decodes no `%20` of a URI
        return _MODEL + resource.removeprefix(_PACKAGE) if resource.startswith(_PACKAGE) else resource
