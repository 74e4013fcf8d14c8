"""What the objects of one file need to know of the file that they stand in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from linkforge_compile.core.models.material import Material
from linkforge_compile.diagnostics import UnresolvedNames
from linkforge_compile.expand.paths import path_base
from linkforge_compile.expand.uses import from_base, no_mesh
from linkforge_compile.lower.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.source import SourceFile
from linkforge_compile.source.ref import Located


@dataclass(frozen=True)
class FileScope:
    """`mesh_bases` are as in Instance, `materials` are those that the file declares, without those that are lost.

    `meshes` reads those that an inertia is to be computed from.
    """

    mesh_bases: Mapping[SourceFile, str] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    lost_materials: UnresolvedNames = field(default_factory=UnresolvedNames)
    meshes: MeshReader = field(default_factory=lambda: MeshReader(no_mesh, MeshSolids()))

    def resource(self, path: str, node: Located) -> str:
        """Return a relative path, which stands at a node, as the compiled file would; any other path as written."""
        return from_base(path, self.mesh_bases.get(path_base(node).file, ""))
