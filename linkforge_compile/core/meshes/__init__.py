"""Meshes as solid bodies: the only room that reads them, and only where an inertia is to be computed from one.

It needs the packages of the extra `mesh`; nothing else of the IR imports it before a mesh is to be read.
"""

from linkforge_compile.core.meshes.faults import MeshError, MeshFault
from linkforge_compile.core.meshes.read import solid_in

__all__ = ["MeshError", "MeshFault", "solid_in"]
