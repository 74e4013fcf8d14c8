"""The limits of joints that the template of joint_limits.yaml lays out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointLimits
from linkforge_compile.formats.element import placed
from linkforge_compile.formats.groups import actuated_joints
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.views import View

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot

_KINDS = ("velocity", "acceleration", "deceleration", "jerk")
_OFTEN_UNKNOWN = ("deceleration", "jerk")
"""Limits that are omitted where they are unknown; MoveIt takes an acceleration for a deceleration."""


def limits_view(robot: Robot) -> View:
    """Return what templates see of the joints; `bound` is a number [SI], None for a limit that is unknown.

    A deceleration is negative, as Pilz's planner requires.
    """
    joints = actuated_joints(robot)
    return View(joints=[View(name=placed(one.name, one.source), limits=tuple(_limits(one))) for one in joints])


def _limits(joint: Joint) -> Iterator[View]:
    for kind in _KINDS:
        bound = known_limit(joint, kind)
        if bound is not None or kind not in _OFTEN_UNKNOWN:
            place = origin_of(joint.source, "limits", kind)
            yield View(kind=kind, bound=-bound if bound and kind == "deceleration" else bound, place=place)


def known_limit(joint: Joint, kind: str) -> float | None:
    """Return a limit of a joint, None for one that is unknown, or 0, which a URDF has for no limit."""
    limit: float | None = getattr(joint.limits or JointLimits(velocity=0.0), kind)
    return float(limit) if limit else None
