"""The view of a robot that the templates of MJCF lay out."""

from __future__ import annotations

from linkforge_compile.core.models.joint import SINGLE_AXIS
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.kinematic_tree import KinematicTree
from linkforge_compile.formats.mjcf.bodies import body_views, sensor_elements, world_elements
from linkforge_compile.formats.mjcf.contacts import exclusion_elements
from linkforge_compile.formats.mjcf.joints import (
    JointClass,
    actuator_element,
    actuator_settings,
    drives,
    equality_elements,
    joint_settings,
)
from linkforge_compile.formats.mjcf.keyframes import key_elements
from linkforge_compile.formats.mjcf.meshes import mesh_assets
from linkforge_compile.formats.views import View


def robot_view(robot: Robot, *, is_free: bool) -> View:
    """Return what templates see of a robot in MJCF; one that `is_free` has six degrees of freedom more."""
    tree, meshes = KinematicTree.of(robot), mesh_assets(robot)
    driven = tuple(drives(robot))
    joints = (joint_settings(joint) for joint in robot.joints if joint.type in SINGLE_AXIS)
    joint_class = JointClass.of((*joints, *map(actuator_settings, driven)))
    return View(
        attributes=attributes_at(robot.source, "name", model=robot.name),
        mesh_folder=meshes.folder,
        meshes=meshes.elements,
        joint_class=joint_class.elements(),
        world=world_elements(robot, meshes.names),
        bodies=tuple(body_views(robot, tree, meshes.names, joint_class, is_free=is_free)),
        exclusions=exclusion_elements(robot, tree, is_free=is_free),
        equalities=equality_elements(robot),
        actuators=[actuator_element(drive, joint_class) for drive in driven],
        sensors=tuple(sensor_elements(robot)),
        keys=tuple(key_elements(robot, tree, is_free=is_free)),
    )
