"""Meshes as solid bodies, read only where an inertia is to be computed from one; needs the extra `mesh`."""

from linkforge_compile.core.meshes.faults import MeshError, MeshFault
from linkforge_compile.core.meshes.read import solid_in, solids_of

__all__ = ["MeshError", "MeshFault", "solid_in", "solids_of"]
