"""Read a URDF as the tree of a spec."""

from linkforge_compile.importers.urdf.robot import read_urdf

__all__ = ["read_urdf"]
