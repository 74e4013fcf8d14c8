"""Poses of links in frames that are not those of their joints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.poses import NO_TURN, Pose

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint


_HERE = Pose((0.0, 0.0, 0.0), NO_TURN)


def relative_pose(link: str, base: str, above: Mapping[str, Joint]) -> Pose:
    """Return the pose of a link in the frame of another one of its tree, while all joints are at zero."""
    pose, top = _pose_below(base, link, above)
    return pose if top == base else _pose_below(top, base, above)[0].inverse.times(pose)


def _pose_below(base: str, link: str, above: Mapping[str, Joint]) -> tuple[Pose, str]:
    """Return the pose of a link in the frame of one above it, and that link: the root if the base is not above it."""
    pose, seen = _HERE, {base}
    while link not in seen and link in above:
        seen.add(link)
        pose, link = Pose.of(above[link].origin).times(pose), above[link].parent
    return pose, link
