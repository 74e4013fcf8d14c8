"""Elements of SDF: most of its values are texts of elements, and poses say what they are relative to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.xml_text import NOTHING, Spellable, Xml, escaped, spelled

if TYPE_CHECKING:
    from linkforge_compile.core.models.geometry import Transform
    from linkforge_compile.core.poses import Pose
    from linkforge_compile.source import SourceRef


def text(tag: str, value: Spellable | None, source: SourceRef | None, *path: str | int) -> Xml:
    """Return an element with a text that is written under a path of a part; nothing for None."""
    if value is None:
        return NOTHING
    return Xml(f"<{tag}{origin_of(source, *path)}>{escaped(spelled(value))}</{tag}>")


def parent(tag: str, *children: Xml) -> Xml:
    """Return an element with others inside; nothing if there are none."""
    inner = "".join(children)
    return Xml(f"<{tag}>{inner}</{tag}>") if inner else NOTHING


def pose(origin: Transform, relative_to: str | None = None) -> Xml:
    """Return a pose in a frame, None for that of what holds it; nothing for one that is the default.

    The numbers are those of the spec: SDF turns about the fixed axes x, y, z, as URDF does.
    """
    if not origin.is_written and relative_to is None:
        return NOTHING
    attributes = attributes_at(origin.source, relative_to=relative_to)
    return Xml(f"<pose{attributes}>{spelled((*origin.xyz, *origin.rpy))}</pose>")


def pose_between(found: Pose, relative_to: str) -> Xml:
    """Return a pose that is computed: a quaternion has no angles for which its numbers are inexact."""
    attributes = attributes_at(None, relative_to=relative_to, rotation_format="quat_xyzw")
    return Xml(f"<pose{attributes}>{spelled((*found.xyz, *found.turn))}</pose>")


def pose_of_frame(relative_to: str | None) -> Xml:
    """Return the pose of what is where a frame is; nothing for that of what holds it."""
    return Xml(f"<pose{attributes_at(None, relative_to=relative_to)}/>") if relative_to else NOTHING
