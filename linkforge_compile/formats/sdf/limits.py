"""What SDF or Gazebo Sim cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics.codes.simulators import (
    CLASSIC_IN_SDF,
    FREE_IN_SDF,
    IMPOSSIBLE_FOR_GAZEBO,
    MIMIC_OF_ENGINE,
    NO_BODY_IN_SDF,
    NO_MIMIC_IN_SDF,
    NOT_IN_ITS_MODULE,
    NOT_IN_SDF,
    RESERVED_IN_SDF,
    STAYS_A_URI,
    WEIGHTLESS_IN_SDF,
)
from linkforge_compile.formats.limits import check_attributes, check_texts
from linkforge_compile.formats.mesh_paths import mesh_paths, reason_not_found, texture_paths
from linkforge_compile.formats.parts import doubtful_parts_of_urdf
from linkforge_compile.formats.sdf.check_names import check_names, is_reserved
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.links import has_possible_inertia
from linkforge_compile.formats.sdf.losses import lost_parts
from linkforge_compile.formats.sdf.models import ROBOT, Models, moved_by_gazebo
from linkforge_compile.formats.sdf.view import WITH_MIMIC, SdfChoices, sdf_version
from linkforge_compile.formats.single_axis import leader_of

if TYPE_CHECKING:
    from linkforge_compile.diagnostics import Diagnostic


def missing_body(robot: Robot) -> Diagnostic | None:
    """Return why a robot is no model of Gazebo; None where it is."""
    layout = Layout.of(robot)
    if any(layout.is_body(link) for link in robot.links):
        return None
    return NO_BODY_IN_SDF.at(robot.source, "name", robot=robot.name)


def sdf_limits(robot: Robot, choices: SdfChoices, render: Callable[[], str]) -> Iterator[Diagnostic]:
    """Yield what `render` leaves out, changes or refuses in the SDF of a robot, and what Gazebo refuses."""
    doubtful = doubtful_parts_of_urdf(robot)
    yield from check_texts(robot, doubtful)
    yield from check_attributes(doubtful.with_extras, robot, render)
    layout = Layout.of(robot)
    yield from check_names(robot, layout)
    yield from check_bodies(robot, layout)
    yield from check_joints(robot, has_mimic=sdf_version(robot, choices) == WITH_MIMIC)
    yield from check_plugins(robot)
    if choices.has_files:
        yield from check_files(robot)
    if choices.is_nested:
        yield from check_nested(robot, layout)
    for parts, name, source, path in lost_parts(robot, layout):
        yield NOT_IN_SDF.at(source, *path, parts=parts, name=name)


def check_bodies(robot: Robot, layout: Layout) -> Iterator[Diagnostic]:
    """A body that moves has a mass and a tensor that are possible; the world has none."""
    for link in robot.links:
        joint = layout.above.get(link.name)
        is_fixed_to_world = joint and joint.type == JointType.FIXED and layout.is_world(joint.parent)
        if link.name in layout.weightless and not is_fixed_to_world:
            yield WEIGHTLESS_IN_SDF.at(link.source, link=link.name)
        elif layout.is_body(link) and link.mass > 0 and not has_possible_inertia(link):
            yield IMPOSSIBLE_FOR_GAZEBO.at(link.source, "inertial", "inertia", link=link.name)


def check_joints(robot: Robot, *, has_mimic: bool) -> Iterator[Diagnostic]:
    """SDF has no planar joints, and mimic joints in its later versions, which not every engine moves."""
    for joint in robot.joints:
        if joint.type == JointType.PLANAR:
            yield FREE_IN_SDF.at(joint.source, "type", joint=joint.name, link=joint.child)
        if leader_of(joint, robot):
            code = MIMIC_OF_ENGINE if has_mimic else NO_MIMIC_IN_SDF
            yield code.at(joint.source, "mimic", joint=joint.name)


def check_plugins(robot: Robot) -> Iterator[Diagnostic]:
    """Gazebo Sim loads no plugin of Gazebo Classic, whose libraries have names of their own."""
    of_robot = (plugin for block in robot.gazebo_elements if block.reference is None for plugin in block.plugins)
    of_sensors = (sensor.plugin for sensor in robot.sensors if sensor.plugin)
    for plugin in (*of_robot, *of_sensors):
        if _CLASSIC_FILE.fullmatch(plugin.filename):
            yield CLASSIC_IN_SDF.at(plugin.source, "filename", file=plugin.filename)


_CLASSIC_FILE = re.compile(r"(?:.*/)?libgazebo_\w+\.so")


def check_nested(robot: Robot, layout: Layout) -> Iterator[Diagnostic]:
    """A module has a name that SDF keeps for nothing else; a joint that gz_ros2_control moves is in no nested model."""
    models = Models(layout, is_nested=True)
    uses = {use.module: use for link in robot.links if link.source for use in link.source.trail}
    for name in dict.fromkeys(model[-1] for model in models.all if model):
        if is_reserved(name):
            yield RESERVED_IN_SDF.at(uses[name], name=name)
    for joint in moved_by_gazebo(robot):
        if models.innermost(robot.joints[joint.name]) != ROBOT:
            yield NOT_IN_ITS_MODULE.at(joint.source, joint=joint.name)


def check_files(robot: Robot) -> Iterator[Diagnostic]:
    """A mesh or texture that is not on this machine has no file that an SDF could refer to."""
    for mesh, path in mesh_paths(robot):
        if path is None and "://" in mesh.resource:
            reason = reason_not_found(robot, mesh.resource)
            yield STAYS_A_URI.at(mesh.source, "file", what="mesh", file=mesh.resource, reason=reason)
    for material, texture, path in texture_paths(robot):
        if path is None and "://" in texture:
            reason = reason_not_found(robot, texture)
            yield STAYS_A_URI.at(material.source, "texture", what="texture", file=texture, reason=reason)
