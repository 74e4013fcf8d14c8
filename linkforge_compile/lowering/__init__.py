"""From the evaluated tree to the IR: one robot out of a file and all its modules."""

from linkforge_compile.lowering.assembly import Lowered, lower
from linkforge_compile.lowering.mesh_solids import MeshSolids

__all__ = ["Lowered", "MeshSolids", "lower"]
