"""Finds the meshes and textures that a robot's shapes name, for commands that open them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.checks.mesh_files import MeshFinder
from linkforge_compile.core.resolver import FileSystemResolver
from linkforge_compile.diagnostics import UnresolvedNames
from linkforge_compile.formats.mesh_paths import reason_not_found
from linkforge_compile.roots import ANYWHERE, exists, is_file
from linkforge_compile.source.characters import UnreadableError

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

OUTSIDE = "it is outside of the folders that the robot may read; use --allow-outside"


class ShapeFiles:
    """Finds the files of one robot, only in the folders that it may read."""

    def __init__(self, robot: Robot) -> None:
        resolver = robot.resource_resolver
        self._robot = robot
        self._roots = resolver.roots if isinstance(resolver, FileSystemResolver) else ANYWHERE
        self._finder = MeshFinder(robot, UnresolvedNames().with_access(self._roots.hold))

    def place(self, resource: str) -> Path | None:
        """Return where a file is or should be; None where that is not known, or it may not be read."""
        return self._finder.path(resource)

    def find(self, resource: str) -> Path:
        """Return the file that a shape names.

        Raises:
            UnreadableError: There is none, or it may not be read; the message is the reason with the way out.

        """
        path = self.place(resource)
        # Asked before the file is looked up, so that no reason reveals whether it exists.
        if resource in self._finder.forbidden:
            raise UnreadableError(OUTSIDE)
        if path and is_file(path):
            return path
        is_other = path and exists(path)
        raise UnreadableError("it is not a regular file" if is_other else reason_not_found(self._robot, resource))

    def beside(self, folder: Path, name: str) -> Path:
        """Return the path that a file in a folder gives to another one, which may not exist; errors as for `find`."""
        path = folder / name
        if not self._roots.hold(path):
            raise UnreadableError(OUTSIDE)
        return path
