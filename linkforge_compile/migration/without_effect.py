"""Elements that URDF allows and no reader of it acts on: the axis of a joint that has none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import HAVE_NO_AXIS, HAVE_NO_LIMITS
from linkforge_compile.source.xml_tree import first_tag

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.core.models.joint import Joint

WITHOUT_EFFECT: Mapping[str, frozenset[str]] = {
    str(kind): frozenset(tag for tag, kinds in (("axis", HAVE_NO_AXIS), ("limit", HAVE_NO_LIMITS)) if kind in kinds)
    for kind in {*HAVE_NO_AXIS, *HAVE_NO_LIMITS}
}
"""The tags of elements in a joint that have no effect, by its type."""


def leave_out(robot: Robot) -> None:
    """Remove these elements, which are raw XML there, from a robot."""
    robot.joints = [_without(joint) for joint in robot.joints]


def _without(joint: Joint) -> Joint:
    tags = WITHOUT_EFFECT.get(str(joint.type), frozenset())
    kept = [text for text in joint.extra_elements if first_tag(text) not in tags]
    return joint if len(kept) == len(joint.extra_elements) else replace(joint, extra_elements=kept)
