"""What SDF or Gazebo Sim cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.geometry import Mesh, Transform
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.diagnostics.codes.formats import (
    FREE_IN_SDF,
    IMPOSSIBLE_FOR_GAZEBO,
    MESH_STAYS_A_URI,
    NO_BODY_IN_SDF,
    NO_MIMIC_IN_SDF,
    NOT_FOUND_NESTED,
    NOT_IN_SDF,
    RENAMED_IN_SDF,
    RESERVED_IN_SDF,
    WEIGHTLESS_IN_SDF,
)
from linkforge_compile.formats.kinematic_tree import WORLD
from linkforge_compile.formats.parts import doubtful_parts_of_urdf
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.links import has_possible_inertia
from linkforge_compile.formats.sdf.meshes import MeshUris
from linkforge_compile.formats.sdf.models import ROBOT, SEPARATOR, Models
from linkforge_compile.formats.sdf.settings import lost_settings, replaced_settings, settings_by_reference
from linkforge_compile.formats.sdf.view import WITH_MIMIC, SdfChoices, sdf_version
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.diagnostics import Diagnostic

Loss: TypeAlias = tuple[str, str, SourceRef | None, tuple[str | int, ...]]
"""What SDF has no place for, the name of the part, and where it was written."""


def missing_body(robot: Robot) -> Diagnostic | None:
    """Return why a robot is no model of Gazebo; None where it is."""
    layout = Layout.of(robot)
    if any(layout.is_body(link) for link in robot.links):
        return None
    return NO_BODY_IN_SDF.at(robot.source, "name", robot=robot.name)


def sdf_limits(robot: Robot, choices: SdfChoices) -> Iterator[Diagnostic]:
    """Yield what is left out or changed in the SDF of a robot, and what Gazebo refuses."""
    layout = Layout.of(robot)
    yield from check_names(robot, layout)
    yield from check_bodies(robot, layout)
    yield from check_joints(robot, has_mimic=sdf_version(robot, choices) == WITH_MIMIC)
    if choices.has_files:
        yield from check_files(robot)
    if choices.is_nested:
        yield from check_nested(robot, layout)
    for parts, name, source, path in _losses(robot, layout):
        yield NOT_IN_SDF.at(source, *path, parts=parts, name=name)


def check_names(robot: Robot, layout: Layout) -> Iterator[Diagnostic]:
    """Links, joints and frames of a model share their names; SDF has `world`, `__…__` and `…::…` for itself."""
    parts: tuple[Link | Joint, ...] = (*robot.links, *robot.joints)
    for part in parts:
        is_world = isinstance(part, Link) and layout.is_world(part.name)
        if not is_world and _is_reserved(part.name):
            yield RESERVED_IN_SDF.at(part.source, name=part.name)
    for sensor in robot.sensors:
        if SEPARATOR in sensor.name:
            yield RESERVED_IN_SDF.at(sensor.source, name=sensor.name)
    for settings in settings_by_reference(robot).values():
        for setting in settings:
            if setting.tag != "plugin" and (name := next((one for one in setting.names if SEPARATOR in one), None)):
                yield RESERVED_IN_SDF.at(setting.source, *setting.path, name=name)
    for joint in robot.joints:
        if (name := layout.joint_names[joint.name]) != joint.name:
            yield RENAMED_IN_SDF.at(joint.source, joint=joint.name, name=name)


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
    """SDF has no planar joints, and mimic joints in its later versions."""
    for joint in robot.joints:
        if joint.type == JointType.PLANAR:
            yield FREE_IN_SDF.at(joint.source, "type", joint=joint.name, link=joint.child)
        if joint.mimic and not has_mimic:
            yield NO_MIMIC_IN_SDF.at(joint.source, "mimic", joint=joint.name)


def check_nested(robot: Robot, layout: Layout) -> Iterator[Diagnostic]:
    """A module has a name that SDF keeps for nothing else, and gz_ros2_control looks into the outermost model alone."""
    models = Models(layout, is_nested=True)
    uses = {use.module: use for link in robot.links if link.source for use in link.source.trail}
    for name in dict.fromkeys(model[-1] for model in models.all if model):
        if _is_reserved(name) or SEPARATOR in name:
            yield RESERVED_IN_SDF.at(uses[name], name=name)
    for hardware in robot.ros2_controls:
        for joint in hardware.joints if hardware.hardware_plugin.startswith(_OF_GAZEBO) else ():
            if robot.has_joint(joint.name) and models.of_joint(robot.joints[joint.name]) != ROBOT:
                yield NOT_FOUND_NESTED.at(joint.source, joint=joint.name)


_OF_GAZEBO = ("gz_ros2_control/", "ign_ros2_control/")


def _is_reserved(name: str) -> bool:
    return name == WORLD or (name.startswith("__") and name.endswith("__"))


def check_files(robot: Robot) -> Iterator[Diagnostic]:
    """A mesh that is not on this machine has no file that an SDF could refer to."""
    uris = MeshUris(robot, is_resolved=True)
    for mesh in dict.fromkeys(shape.geometry for link in robot.links for shape in link.shapes):
        if isinstance(mesh, Mesh) and "://" in mesh.resource and uris.file(mesh.resource) is None:
            yield MESH_STAYS_A_URI.at(mesh.source, "file", file=mesh.resource)


def _losses(robot: Robot, layout: Layout) -> Iterator[Loss]:
    yield from _losses_of_world(robot, layout)
    for joint in robot.joints:
        limits = joint.limits
        if limits and any(value is not None for value in (limits.acceleration, limits.deceleration, limits.jerk)):
            yield "limits of acceleration, deceleration and jerk", joint.name, limits.source, ()
        if joint.safety_controller:
            yield "safety controllers", joint.name, joint.source, ("safety_controller",)
        if joint.calibration:
            yield "calibrations", joint.name, joint.source, ("calibration",)
    for transmission in robot.transmissions:
        yield "transmissions", transmission.name, transmission.source, ()
    for sensor in robot.sensors:
        above = layout.above.get(sensor.link_name)
        if sensor.type == SensorType.FORCE_TORQUE and not (above and layout.is_joint(above)):
            yield "force-torque sensors without a joint", sensor.name, sensor.source, ("link",)
    for reference, setting in lost_settings(robot):
        yield f"place for the setting '{setting.tag}'", reference or robot.name, setting.source, setting.path
    for reference, setting in replaced_settings(robot):
        words = f"second <surface>, so no place for the setting '{setting.tag}'"
        yield words, reference, setting.source, setting.path
    for block in robot.gazebo_elements:
        if block.reference is not None:
            for plugin in block.plugins:
                yield "plugins of links and joints", plugin.name, plugin.source, ()
    yield from _lost_xml(robot)


def _losses_of_world(robot: Robot, layout: Layout) -> Iterator[Loss]:
    for link in robot.links:
        if not layout.is_world(link.name):
            continue
        if link.inertial:
            yield "mass of the world", link.name, link.source, ("inertial",)
        if link.shapes:
            yield "shapes of the world", link.name, link.source, ("visual" if link.visuals else "collision",)
        for sensor in robot.sensors:
            if sensor.link_name == link.name:
                yield "sensors on the world", sensor.name, sensor.source, ("link",)


def _lost_xml(robot: Robot) -> Iterator[Loss]:
    if robot.extra_elements:
        yield "raw XML of a URDF", robot.name, robot.source, ("extra",)
    for held in doubtful_parts_of_urdf(robot).with_extras:
        around = (*held.around, held.part)
        if isinstance(held.part, Transform) or any(isinstance(part, _NOT_RAW_URDF) for part in around):
            continue
        owner = next((part for part in around if getattr(part, "name", None)), None)
        yield "raw XML of a URDF", getattr(owner, "name", robot.name), held.where, ()


_NOT_RAW_URDF = (Sensor, GazeboElement, Ros2Control, Transmission)
"""What is SDF with all that is in it, is read from the URDF, or is reported as a whole."""
