"""SRDF as the semantic part of a spec: an element a module where it has more than attributes."""

from linkforge_compile.importers.srdf.beside_urdf import with_srdf

__all__ = ["with_srdf"]
