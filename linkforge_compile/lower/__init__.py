"""From the evaluated tree to the IR: one robot out of a file and all its modules."""

from linkforge_compile.lower.assembly import lower
from linkforge_compile.lower.lowered import Lowered
from linkforge_compile.lower.mesh_solids import MeshSolids

__all__ = ["Lowered", "MeshSolids", "lower"]
