"""The view of a robot that the templates of MJCF lay out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.mjcf.bodies import body_views, shape_elements
from linkforge_compile.formats.mjcf.joints import equality_elements
from linkforge_compile.formats.mjcf.meshes import mesh_assets
from linkforge_compile.formats.mjcf.tree import WORLD, BodyTree
from linkforge_compile.formats.views import View

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


def robot_view(robot: Robot, *, is_free: bool) -> View:
    """Return what templates see of a robot in MJCF; one that `is_free` has six degrees of freedom more."""
    tree, meshes = BodyTree.of(robot), mesh_assets(robot)
    return View(
        attributes=attributes_at(robot.source, "name", model=robot.name),
        mesh_folder=meshes.folder,
        meshes=meshes.elements,
        world_shapes=shape_elements(robot.links[WORLD], meshes.names) if robot.has_link(WORLD) else (),
        bodies=tuple(body_views(robot, tree, meshes.names, is_free=is_free)),
        equalities=equality_elements(robot),
    )
