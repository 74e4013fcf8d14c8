"""Joints of one axis that others mimic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import SINGLE_AXIS

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot


def leader_of(joint: Joint, robot: Robot) -> Joint | None:
    """Return the joint that a joint mimics; None where one of them has other than one axis, as for LF5502."""
    if joint.mimic is None or joint.type not in SINGLE_AXIS or not robot.has_joint(joint.mimic.joint):
        return None
    leader = robot.joints[joint.mimic.joint]
    return leader if leader.type in SINGLE_AXIS else None
