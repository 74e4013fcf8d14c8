"""From the evaluated tree to the IR: one robot out of a file and all its modules."""

from linkforge_compile.lowering.assembly import lower
from linkforge_compile.lowering.lowered import Lowered
from linkforge_compile.lowering.mesh_solids import MeshSolids

__all__ = ["Lowered", "MeshSolids", "lower"]
