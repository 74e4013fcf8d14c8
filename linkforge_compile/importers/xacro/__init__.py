"""xacro files: expanded by the xacro package in a process of its own, each element led back to where it was written."""

from linkforge_compile.importers.xacro.places import moved_back
from linkforge_compile.importers.xacro.run import Expanded, Failed, Place, run_xacro

__all__ = ["Expanded", "Failed", "Place", "moved_back", "run_xacro"]
