"""Robots that were written elsewhere, as trees of the language: URDF."""

from __future__ import annotations

from linkforge_compile.importers.encoding import EncodingError, xml_text

__all__ = ["EncodingError", "xml_text"]
