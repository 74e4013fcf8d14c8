"""Checks of a finished robot: pure functions that yield diagnostics."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

from linkforge_compile.checks import (
    controllers,
    gazebo,
    groups,
    inertia,
    joints,
    names,
    ros2_control,
    sensors,
    shapes,
    srdf,
    tree,
)
from linkforge_compile.checks.groups import LinkSets
from linkforge_compile.checks.mesh_files import RobotMeshes
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames

Check: TypeAlias = Callable[[Robot, UnresolvedNames], Iterator[Diagnostic]]
"""Checks one rule, which the first line of its docstring states; the rest is its manual page."""

GroupCheck: TypeAlias = Callable[[Robot, UnresolvedNames, LinkSets], Iterator[Diagnostic]]
"""A check of planning groups or their states; all of them share the sets of links."""

MeshCheck: TypeAlias = Callable[[Robot, RobotMeshes], Iterator[Diagnostic]]
"""A check that needs mesh files; all of them share what was read."""

ROBOT_CHECKS: tuple[Check, ...] = (
    names.check_duplicates,
    names.check_frame_names,
    tree.check_links,
    tree.check_joint_ends,
    tree.check_second_parents,
    tree.check_link_cycles,
    tree.check_single_root,
    joints.check_joint_range,
    joints.check_mimic_joints,
    joints.check_mimic_cycles,
    joints.check_mimic_freedom,
    joints.check_mimic_motion,
    joints.check_mimic_range,
    joints.check_endless_joints,
    joints.check_joint_power,
    joints.check_joint_speed,
    joints.check_soft_limits,
    inertia.check_inertia,
    inertia.check_signs_of_products,
    shapes.check_untouched_visuals,
    shapes.check_unseen_collisions,
    sensors.check_sensor_links,
    sensors.check_sensor_frames,
    sensors.check_scanners,
    sensors.check_contacts,
    sensors.check_topics,
    sensors.check_shared_topics,
    ros2_control.check_transmission_joints,
    ros2_control.check_ros2_control_joints,
    ros2_control.check_fixed_joints_driven,
    ros2_control.check_interface_claims,
    ros2_control.check_interface_names,
    ros2_control.check_interface_parameters,
    ros2_control.check_mimics_in_hardware,
    ros2_control.check_hardware_is_used,
    controllers.check_names_in_controllers,
    controllers.check_names_of_manager,
    sensors.check_gazebo_references,
    sensors.check_plugin_joints,
    sensors.check_plugin_files,
    sensors.check_simulated_hardware,
    gazebo.check_tags_of_several_blocks,
)

URDF_CHECKS: tuple[Check, ...] = (
    names.check_link_and_joint_names,
    names.check_reserved_names,
    gazebo.check_massless_bodies,
    gazebo.check_tiny_masses,
    gazebo.check_merged_joints,
    gazebo.check_merged_links,
)
"""Checks of what Gazebo makes of a URDF."""

SEMANTIC_CHECKS: tuple[Check, ...] = (
    names.check_semantic_duplicates,
    srdf.check_semantic_links,
    srdf.check_semantic_joints,
    srdf.check_semantic_groups,
    srdf.check_virtual_joints,
    srdf.check_virtual_joint_names,
    srdf.check_collision_pairs,
    srdf.check_enabled_pairs,
    ros2_control.check_passive_joints,
    groups.check_group_cycles,
)

GROUP_CHECKS: tuple[GroupCheck, ...] = (
    groups.check_chains,
    groups.check_empty_groups,
    groups.check_end_effectors,
    groups.check_arms_of_end_effectors,
    srdf.check_group_states,
    srdf.check_states_taken_over,
    srdf.check_states_of_mimics,
    srdf.check_states_are_whole,
)

MESH_CHECKS: tuple[MeshCheck, ...] = (
    inertia.check_density,
    inertia.check_inertia_scale,
    inertia.check_centre_of_mass,
    shapes.check_mesh_files,
    shapes.check_mesh_formats,
    shapes.check_mirrored_collisions,
    shapes.check_fine_collisions,
)


def check(robot: Robot, unresolved: UnresolvedNames, *, has_urdf: bool = True) -> Iterator[Diagnostic]:
    """Yield all faults of a robot in the order of the checks; nothing about names whose errors are already reported.

    `has_urdf` is whether a URDF is written of it.
    """
    for check_robot in (*ROBOT_CHECKS, *URDF_CHECKS) if has_urdf else ROBOT_CHECKS:
        yield from check_robot(robot, unresolved)
    # Reading the semantic part of a robot that has none creates one, and imports its classes.
    if robot.has_semantic:
        for check_semantic in SEMANTIC_CHECKS:
            yield from check_semantic(robot, unresolved)
        links = LinkSets(robot)
        for check_groups in GROUP_CHECKS:
            yield from check_groups(robot, unresolved, links)
    meshes = RobotMeshes(robot, unresolved)
    for check_meshes in MESH_CHECKS:
        yield from check_meshes(robot, meshes)
