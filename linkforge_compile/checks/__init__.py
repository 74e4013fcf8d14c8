"""Does the robot make sense? Pure functions that look at a finished Robot and yield what is wrong with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

from linkforge_compile.checks import groups, hardware, inertia, joints, names, srdf, tree
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Gaps

Check: TypeAlias = Callable[[Robot, Gaps], Iterator[Diagnostic]]
"""Looks at one question; its docstring is its manual page. It says nothing of names in the gaps."""

ROBOT_CHECKS: tuple[Check, ...] = (
    names.check_duplicates,
    tree.check_links,
    tree.check_joint_ends,
    tree.check_second_parents,
    tree.check_link_circles,
    tree.check_single_root,
    joints.check_joint_range,
    joints.check_mimic_joints,
    joints.check_mimic_circles,
    joints.check_mimic_freedom,
    inertia.check_inertia,
    inertia.check_massless_bodies,
    hardware.check_sensor_links,
    hardware.check_transmission_joints,
    hardware.check_ros2_control_joints,
    hardware.check_fixed_joints_driven,
    hardware.check_interface_claims,
    hardware.check_gazebo_references,
)

SEMANTIC_CHECKS: tuple[Check, ...] = (
    names.check_semantic_duplicates,
    srdf.check_semantic_links,
    srdf.check_semantic_joints,
    srdf.check_semantic_groups,
    srdf.check_virtual_joints,
    srdf.check_collision_pairs,
    srdf.check_passive_joints,
    groups.check_group_circles,
    groups.check_chains,
    groups.check_group_states,
    groups.check_end_effectors,
)

CHECKS = (*ROBOT_CHECKS, *SEMANTIC_CHECKS)
"""Every check, in the order in which they run."""


def check(robot: Robot, gaps: Gaps) -> Iterator[Diagnostic]:
    """Yield all that is wrong with the robot, each fault once, in the order of the checks.

    `gaps` are the names that the author wrote and the robot lacks, which has been told.
    """
    # To ask a robot for its semantic part makes one, and costs the import of its classes.
    for one in CHECKS if robot.says_semantic else ROBOT_CHECKS:
        yield from one(robot, gaps)
