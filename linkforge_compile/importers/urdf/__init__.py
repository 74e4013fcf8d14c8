"""URDF as a tree of the language: an element a module, named as in every other stage."""

from linkforge_compile.importers.urdf.robot import read_urdf

__all__ = ["read_urdf"]
