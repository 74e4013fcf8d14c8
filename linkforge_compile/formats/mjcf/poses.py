"""Poses as attributes of MJCF."""

from __future__ import annotations

from linkforge_compile.core.models.geometry import IDENTITY, Transform
from linkforge_compile.formats.xml_text import Spellable

NO_OFFSET, NO_TURN = IDENTITY.xyz, IDENTITY.rpy


def pose(origin: Transform) -> dict[str, Spellable | None]:
    """Return the attributes of a pose; those that move nothing are None."""
    return {
        "pos": None if origin.xyz == NO_OFFSET else origin.xyz,
        "euler": None if origin.rpy == NO_TURN else origin.rpy,
    }
