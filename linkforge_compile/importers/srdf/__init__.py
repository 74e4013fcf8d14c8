"""Read an SRDF as the semantic part of a spec."""

from linkforge_compile.importers.srdf.with_urdf import with_srdf

__all__ = ["with_srdf"]
