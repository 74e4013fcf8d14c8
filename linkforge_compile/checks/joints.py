"""How far joints go, and joints that follow other joints."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.checks.circles import told_circles
from linkforge_compile.checks.references import Use, unknown
from linkforge_compile.core.models.joint import Joint, JointMimic, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Gaps
from linkforge_compile.diagnostics.codes.model import MIMIC_CIRCLE, MIMIC_FREEDOM, NO_RANGE
from linkforge_compile.diagnostics.codes.names import UNKNOWN_JOINT

AXIS_JOINTS = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)
"""The types whose position is one number, which is all that a mimic can multiply."""


BOUNDED_JOINTS = (JointType.REVOLUTE, JointType.PRISMATIC)


def check_mimic_joints(robot: Robot, gaps: Gaps) -> Iterator[Diagnostic]:
    """A joint mimics a joint of this robot.

    Readers refuse the robot or leave the joint free to dangle. Correct the name; a joint of a module bears
    the module's prefix.
    """
    yield from unknown(_mimics(robot).values(), UNKNOWN_JOINT, robot.joints.names, gaps)


def check_mimic_circles(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A joint may mimic one that mimics another, but at the end of the row one must be free.

    In a circle none leads: MoveIt drops every mimic of the robot, other readers never end. Let one joint of
    the circle lead, without `mimic`, and the others mimic that.
    """
    yield from told_circles({name: (use,) for name, use in _mimics(robot).items()}, MIMIC_CIRCLE)


def check_mimic_freedom(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """Both joints of a mimic move along or about one axis.

    A mimic multiplies one number. A fixed joint has none, a planar or floating one several, and readers drop
    the mimic. A prismatic joint may well mimic a revolute one; its `multiplier` is then [m/rad].
    """
    for joint in robot.joints:
        if joint.mimic is None:
            continue
        leader = robot.joints.get(joint.mimic.joint)
        if leader and leader is not joint and not {joint.type, leader.type}.issubset(AXIS_JOINTS):
            use = _mimic(joint, joint.mimic)
            yield use.told(MIMIC_FREEDOM, joint=joint.name, type=joint.type, leader=leader.name, led=leader.type)


def check_joint_range(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """A revolute or prismatic joint says how far it goes.

    URDF takes an unsaid `lower` or `upper` for 0, so a joint that says neither, or one on the wrong side of 0,
    cannot move. Write both, make the joint `continuous` if it turns without end, or `fixed` if it is not to move.
    """
    for joint in robot.joints:
        limits = joint.limits
        if joint.type not in BOUNDED_JOINTS or limits is None or None not in (limits.lower, limits.upper):
            continue
        if (limits.lower or 0.0) >= (limits.upper or 0.0):
            unsaid = " and ".join(side for side in ("lower", "upper") if getattr(limits, side) is None)
            yield NO_RANGE.at(joint.source, "limits", joint=joint.name, unsaid=unsaid)


def _mimics(robot: Robot) -> dict[str, Use]:
    return {joint.name: _mimic(joint, joint.mimic) for joint in robot.joints if joint.mimic}


def _mimic(joint: Joint, mimic: JointMimic) -> Use:
    return Use(mimic.joint, f"joint '{joint.name}'", joint.source, ("mimic", "joint"))
