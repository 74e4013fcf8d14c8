"""What lowering an element needs to know about its file: materials, meshes, and the base of relative paths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from linkforge_compile.core.models.material import Material
from linkforge_compile.diagnostics import UnresolvedNames
from linkforge_compile.expand.paths import path_base
from linkforge_compile.expand.uses import from_base, no_mesh
from linkforge_compile.lower.mesh_solids import MeshReader, MeshSolids
from linkforge_compile.source import SourceFile
from linkforge_compile.source.span import Located


@dataclass(frozen=True)
class FileScope:
    """`materials` are those that the file declares, `unresolved_materials` the faulty ones.

    `mesh_bases` are as in Instance. `meshes` reads the meshes that an inertia is computed from.
    """

    mesh_bases: Mapping[SourceFile, str] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    unresolved_materials: UnresolvedNames = field(default_factory=UnresolvedNames)
    meshes: MeshReader = field(default_factory=lambda: MeshReader(no_mesh, MeshSolids()))

    def resource(self, path: str, node: Located) -> str:
        """Return a path as the compiled file would write it, relative to the file that `node` was written in."""
        return from_base(path, self.mesh_bases.get(path_base(node).file, ""))
