"""Joints of one axis, and those of them that others mimic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import Joint, JointType

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

SINGLE = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)
"""The types of joints that turn about one axis, or slide along one."""


def leader_of(joint: Joint, robot: Robot) -> Joint | None:
    """Return the joint that a joint mimics; None where one of them has other than one axis, as for LF5502."""
    if joint.mimic is None or joint.type not in SINGLE or not robot.has_joint(joint.mimic.joint):
        return None
    leader = robot.joints[joint.mimic.joint]
    return leader if leader.type in SINGLE else None
