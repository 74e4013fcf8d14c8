import math

import pytest

from linkforge_compile.core import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
    Transform,
    Vector3,
)
from tests.lower.specs import lowered, robot_of

LINKS = "name: arm\nlinks: {base: , arm: }\n"


def joint_of(fields: str) -> Joint:
    return robot_of(f"{LINKS}joints: {{shoulder: {{parent: base, child: arm, {fields}}}}}").joint("shoulder")


def test_a_revolute_joint_with_every_field():
    assert joint_of(
        """type: revolute, origin: [0, 0, 1], axis: -y,
        limits: {lower: -180 deg, upper: 1, effort: 50 N*m, velocity: 180 deg/s},
        dynamics: {damping: 0.1, friction: 20 N*cm}, mimic: {joint: elbow, multiplier: -1, offset: 180 deg},
        safety_controller: {soft_lower_limit: -180 deg, soft_upper_limit: 0.5, k_position: 15, k_velocity: 10},
        calibration: {rising: 180 deg}"""
    ) == Joint(
        "shoulder",
        JointType.REVOLUTE,
        "base",
        "arm",
        Transform(Vector3(0, 0, 1)),
        Vector3(0, -1, 0),
        JointLimits(-math.pi, 1, 50, math.pi),
        JointDynamics(0.1, 0.2),
        JointMimic("elbow", -1, math.pi),
        JointSafetyController(-math.pi, 0.5, 15, 10),
        JointCalibration(math.pi),
    )


def test_a_prismatic_joint_has_lengths_forces_and_velocities():
    joint = joint_of("type: prismatic, axis: x, limits: {upper: 40 mm, effort: 2 kN, velocity: 10 cm/s}")
    assert joint.limits == JointLimits(None, 0.04, 2000, 0.1)


@pytest.mark.parametrize("joint_type", ["planar, axis: z", "floating"])
def test_planar_and_floating_joints_take_bare_limits(joint_type):
    joint = joint_of(f"type: {joint_type}, limits: {{lower: 0, upper: 2000, effort: 1, velocity: 1}}")
    assert joint.limits == JointLimits(0, 2000, 1, 1)


@pytest.mark.parametrize("joint_type", ["continuous, axis: z", "planar, axis: z", "floating", "fixed"])
def test_other_types_need_no_limits(joint_type):
    assert joint_of(f"type: {joint_type}").limits is None


def test_an_axis_is_made_unit_and_kept_as_written():
    joint = joint_of("type: continuous, axis: [0, 3, -4]")
    assert joint.axis == Vector3(0, 0.6, -0.8)
    assert joint.axis_as_written == Vector3(0, 3, -4)


@pytest.mark.parametrize("axis", ["[0, 1, 0]", "y", "[0, 1.0000000001, 0]"])
def test_a_unit_axis_stays_as_it_is(axis):
    joint = joint_of(f"type: continuous, axis: {axis}")
    assert joint.axis.y == pytest.approx(1, abs=1e-9)
    assert joint.axis_as_written is None


def test_limits_that_stand_in_for_unsaid_ones_are_no_fault_of_their_own():
    result = lowered(
        LINKS
        + """
joints:
  wheel: {type: continuous, parent: base, child: arm, axis: y, limits: {}}
# ^E[LF5005]:72 joint 'wheel' has no 'limits.effort'; write one, such as 'effort: 50 N*m'
# ^^E[LF5005]:72 joint 'wheel' has no 'limits.velocity'; write one, such as 'velocity: 90 deg/s'
"""
    )
    assert result.robot.joint("wheel").limits == JointLimits(effort=1, velocity=1)


def test_a_joint_without_a_required_field_is_a_gap():
    result = lowered(
        LINKS
        + """
joints:
  elbow: {type: fixed, child: arm}   # E[LF5005]:3 joint 'elbow' has no 'parent'; write one, such as 'parent: base'
"""
    )
    assert "elbow" in result.unresolved
    assert result.robot.joints == ()


def test_crossed_limits_leave_the_joint_in_the_tree():
    result = lowered(
        LINKS
        + """
joints:
  elbow:
    type: revolute
    parent: base
    child: arm
    axis: z
    limits: {lower: 2, upper: 1, effort: 1, velocity: 1}   # E[LF5204]:21 lower must not be above upper, found 2 and 1
"""
    )
    limits = result.robot.joint("elbow").limits
    assert limits.lower < -1e300
    assert limits.upper > 1e300
    assert (limits.effort, limits.velocity) == (1, 1)


def test_a_frame_is_an_empty_link_and_a_fixed_joint():
    robot = robot_of(LINKS + "frames: {tool0: {parent: arm, origin: [0, 0, 1]}, cup: {parent: arm, joint: suction}}")
    assert [link.name for link in robot.links] == ["base", "arm", "tool0", "cup"]
    assert list(robot.joints) == [
        Joint("tool0_joint", JointType.FIXED, "arm", "tool0", Transform(Vector3(0, 0, 1))),
        Joint("suction", JointType.FIXED, "arm", "cup"),
    ]


def test_a_name_whose_expression_failed_may_be_any_that_begins_so():
    from linkforge_compile.lower.file import unresolved_of

    unresolved = unresolved_of(["elbow", "wheel_$(sid)"])
    assert "wheel_left" in unresolved
    assert "elbow" in unresolved
    assert "elbow_2" not in unresolved
