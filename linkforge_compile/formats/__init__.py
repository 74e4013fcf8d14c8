"""A robot as text: one function a format."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.limits import srdf_limits, urdf_limits
from linkforge_compile.formats.srdf import render_srdf
from linkforge_compile.formats.urdf import render_urdf, require_dialect

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = ["BACKENDS", "render_srdf", "render_urdf", "require_dialect", "srdf_limits", "urdf_limits"]

BACKENDS: Mapping[str, Callable[..., str]] = {"urdf": render_urdf, "srdf": render_srdf}
"""The renderer of each format, by the name that is also its file's ending. All take `pretty` and `banner`."""
