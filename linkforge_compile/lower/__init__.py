"""Lower an expanded spec to the model: one robot from a file and all its modules."""

from linkforge_compile.lower.assembly import lower
from linkforge_compile.lower.merge_modules import Lowered
from linkforge_compile.lower.mesh_solids import MeshSolids

__all__ = ["Lowered", "MeshSolids", "lower"]
