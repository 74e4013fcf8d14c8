"""Does the robot make sense? Pure functions that look at a finished Robot and yield what is wrong with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

from linkforge_compile.checks import (
    gazebo,
    geometry,
    hardware,
    inertia,
    interfaces,
    joints,
    mass,
    meshes,
    names,
    plugins,
    sensors,
    tree,
)
from linkforge_compile.checks.mesh_files import RobotMeshes
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames

Check: TypeAlias = Callable[[Robot, UnresolvedNames], Iterator[Diagnostic]]
"""Looks at one question; its docstring is its manual page. It says nothing of names in the unresolved."""

MeshCheck: TypeAlias = Callable[[Robot, RobotMeshes], Iterator[Diagnostic]]
"""A check that looks at mesh files as well; all of them share what was seen."""

ROBOT_CHECKS: tuple[Check, ...] = (
    names.check_duplicates,
    names.check_link_and_joint_names,
    names.check_reserved_names,
    names.check_frame_names,
    tree.check_links,
    tree.check_joint_ends,
    tree.check_second_parents,
    tree.check_link_circles,
    tree.check_single_root,
    joints.check_joint_range,
    joints.check_mimic_joints,
    joints.check_mimic_circles,
    joints.check_mimic_freedom,
    joints.check_mimic_motion,
    joints.check_mimic_range,
    joints.check_endless_joints,
    joints.check_joint_power,
    joints.check_joint_speed,
    joints.check_soft_limits,
    inertia.check_inertia,
    mass.check_signs_of_products,
    geometry.check_untouched_visuals,
    geometry.check_unseen_collisions,
    sensors.check_sensor_links,
    sensors.check_sensor_frames,
    sensors.check_contacts,
    sensors.check_topics,
    sensors.check_shared_topics,
    hardware.check_transmission_joints,
    hardware.check_ros2_control_joints,
    hardware.check_fixed_joints_driven,
    hardware.check_interface_claims,
    interfaces.check_interface_names,
    interfaces.check_interface_parameters,
    interfaces.check_mimics_in_hardware,
    interfaces.check_hardware_is_used,
    hardware.check_gazebo_references,
    plugins.check_plugin_joints,
    plugins.check_simulated_hardware,
    gazebo.check_massless_bodies,
    gazebo.check_tiny_masses,
    gazebo.check_merged_joints,
    gazebo.check_merged_links,
    gazebo.check_tags_of_several_blocks,
)

MESH_CHECKS: tuple[MeshCheck, ...] = (
    mass.check_density,
    mass.check_inertia_scale,
    mass.check_centre_of_mass,
    meshes.check_mesh_files,
    meshes.check_mesh_formats,
    meshes.check_mirrored_collisions,
    meshes.check_fine_collisions,
)


def check(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """Yield all that is wrong with the robot, each fault once, in the order of the checks.

    `unresolved` are the names that the author wrote and the robot lacks, which has been told.
    """
    for one in ROBOT_CHECKS:
        yield from one(robot, unresolved)
    # To ask a robot for its semantic part makes one, and costs the import of its classes.
    if robot.says_semantic:
        from linkforge_compile.checks.semantic import SEMANTIC_CHECKS

        for one in SEMANTIC_CHECKS:
            yield from one(robot, unresolved)
    files = RobotMeshes(robot, unresolved)
    for looking in MESH_CHECKS:
        yield from looking(robot, files)
