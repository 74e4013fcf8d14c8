"""Read the meshes that an inertia is computed from as solid bodies, once for all, and report their faults."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.core.meshes import MAX_BYTES, MeshError, MeshFault, solid_in
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.physics import (
    EMPTY_MESH,
    FLAT_MESH,
    INSIDE_OUT_MESH,
    MESH_OF_OTHER_FORMAT,
    MESH_TOO_LARGE,
    NO_MESH_LIBRARY,
    NO_SUCH_MESH,
    OPEN_MESH,
    TWISTED_MESH,
    UNREADABLE_MESH,
    WIDE_MESH,
)
from linkforge_compile.diagnostics.entry_fixes import add_to_short_form
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load.files_read import FilesRead
from linkforge_compile.load.loader import with_use_trace
from linkforge_compile.load.locations import FindMesh
from linkforge_compile.paths import as_typed, misspelt_part, path_base, searched_note
from linkforge_compile.roots import identity
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import TooLargeError, read_bytes
from linkforge_compile.syntax.nodes import YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.core.physics import Solid

_MAX_WIDTH = 100.0  # [m]

_BYTES_UNTIL_COLLECTION = 8 * 1024 * 1024
"""The garbage collector, paused during a compile, runs after this many bytes of meshes."""

_CODES = {
    MeshFault.NO_LIBRARY: NO_MESH_LIBRARY,
    MeshFault.NO_FORMAT: MESH_OF_OTHER_FORMAT,
    MeshFault.UNREADABLE: UNREADABLE_MESH,
    MeshFault.TOO_LARGE: MESH_TOO_LARGE,
    MeshFault.EMPTY: EMPTY_MESH,
    MeshFault.OPEN: OPEN_MESH,
    MeshFault.TWISTED: TWISTED_MESH,
    MeshFault.INSIDE_OUT: INSIDE_OUT_MESH,
    MeshFault.FLAT: FLAT_MESH,
}


class MeshSolids:
    """The solids of all mesh files of one compile, each read once."""

    def __init__(self, budget: Budget | None = None, files: FilesRead | None = None) -> None:
        """`budget` and `files` are those of the compile; None for new ones."""
        self._budget = budget or Budget()
        self._files = files or FilesRead()
        self._known: dict[str, Solid | MeshError] = {}  # by real path
        self._uncollected = 0
        self.is_without_library = False
        """Whether a package that reads meshes is missing, which is reported once."""

    @property
    def files(self) -> tuple[Path, ...]:
        """Every mesh file that was read, in that order, as its user would type it."""
        return tuple(dict.fromkeys(self._files.meshes))

    @property
    def unread(self) -> tuple[Path, ...]:
        """Every mesh file that is missing or too large, in the order of requests."""
        return tuple(dict.fromkeys(self._files.unread_meshes))

    def solid(self, path: Path, where: Span) -> Solid | None:
        """Return the solid in a file that is named at a place, in the unit of the file; None for a missing file.

        Raises:
            MeshError: The file holds no solid.
            BeyondLimitError: The meshes of the compile are too large together.

        """
        real = identity(path)
        known = self._known.get(real)
        if known is None and (known := self._read(path, where)) is not None:
            self._known[real] = known
        if known is not None:
            self._files.meshes.append(as_typed(path))
        if isinstance(known, MeshError):
            raise known
        return known

    def _read(self, path: Path, where: Span) -> Solid | MeshError | None:
        content = self._content(path)
        if content is None:
            return None
        self._budget.spend(Limit.MESH_BYTES, len(content), where)
        self._uncollected += len(content)
        if self._uncollected > _BYTES_UNTIL_COLLECTION:
            gc.collect()
            self._uncollected = 0
        try:
            return solid_in(content, path.name, times=self._budget.times)
        except MeshError as error:
            # The traceback of the error would keep its frames, and with them the mesh, in memory.
            return MeshError(error.fault, error.message)

    def _content(self, path: Path) -> bytes | None:
        """Return the content of a file, None for a missing one; record one that cannot be read."""
        try:
            content = read_bytes(path, MAX_BYTES, only_regular=True)
        except UnreadableError as error:
            self._files.unread_meshes.append(as_typed(path))
            fault = MeshFault.TOO_LARGE if isinstance(error, TooLargeError) else MeshFault.UNREADABLE
            raise MeshError(fault, str(error)) from error
        if content is None:
            self._files.unread_meshes.append(as_typed(path))
        return content


class MeshReader:
    """Reads the meshes of one imported file as solids."""

    def __init__(self, find: FindMesh, solids: MeshSolids) -> None:
        """`find` is that of the import, `solids` are those of the whole compile."""
        self._find = find
        self._solids = solids

    def solid(self, mesh: Mesh, inertial: SourceRef, sink: Diagnostics) -> Solid | None:
        """Return a mesh as a solid in its own frame [m], scaled; None after reporting a fault.

        `inertial` is the inertial that needs it.

        Raises:
            RobotPhysicsError: The scale leaves no volume.

        """
        written, where = _written(mesh)
        path = self._find(written, path_base(where.node), with_use_trace(sink, where.trail))
        if path is None:
            return None
        request = Note("its inertia is needed here", inertial.span)
        try:
            solid = self._solids.solid(path, where.span)
        except MeshError as error:
            if not self._solids.is_without_library:
                facts = {"path": written, "reason": error.message, "library": error.message}
                sink.report(_CODES[error.fault].at(where, notes=[request], **facts))
            self._solids.is_without_library |= error.fault is MeshFault.NO_LIBRARY
            return None
        if solid is None:
            name, near = misspelt_part(path)
            notes = [searched_note(path, written, where.node.span), request]
            sink.report(NO_SUCH_MESH.at(where, path=written, name=name, near=near, notes=notes))
            return None
        scaled = solid.scaled(mesh.scale)
        if (widest := max(scaled.size)) > _MAX_WIDTH:
            fix = add_to_short_form(mesh.source, "file", "scale: 0.001")
            sink.report(WIDE_MESH.at(where, path=written, size=f"{widest:.4g}").with_fix(fix))
        return scaled


def _written(mesh: Mesh) -> tuple[str, SourceRef]:
    """Return a mesh's path as its file writes it, and the place."""
    assert mesh.source is not None, "what is lowered was written"
    node = mesh.source.node
    file = node.child("file") or node
    assert isinstance(file, YamlScalar), "a mesh has a file"
    return file.text, SourceRef(file, None, mesh.source.trail)
