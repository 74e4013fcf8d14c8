"""What SDF or Gazebo Sim cannot hold of a robot: reported before anything is written."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Set

from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.simulators import (
    CLASSIC_IN_SDF,
    FREE_IN_SDF,
    IMPOSSIBLE_FOR_GAZEBO,
    MIMIC_OF_ENGINE,
    NO_BODY_IN_SDF,
    NO_COLLISION_IN_SDF,
    NO_MIMIC_IN_SDF,
    NOT_IN_ITS_MODULE,
    NOT_IN_SDF,
    RENAMED_IN_SDF,
    RENAMED_SHAPE_IN_SDF,
    RESERVED_IN_SDF,
    STAYS_A_URI,
    TAKEN_IN_SDF,
    WEIGHTLESS_IN_SDF,
)
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.formats.kinematic_tree import WORLD, leader_of
from linkforge_compile.formats.limits import Loss, check_attributes, check_texts, joint_losses, lost_xml
from linkforge_compile.formats.mesh_paths import mesh_paths, reason_not_found, texture_paths
from linkforge_compile.formats.parts import doubtful_parts_of_urdf
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.links import has_possible_inertia
from linkforge_compile.formats.sdf.models import ROBOT, SEPARATOR, Models, moved_by_gazebo
from linkforge_compile.formats.sdf.part_names import PartNames, repeated
from linkforge_compile.formats.sdf.raw_sensors import collisions_in
from linkforge_compile.formats.sdf.settings import (
    OF_BODY,
    OF_FIXED_JOINT,
    OF_FRAME,
    OF_JOINT,
    OF_MODEL,
    Settings,
    replaced_settings,
)
from linkforge_compile.formats.sdf.view import WITH_MIMIC, SdfChoices, sdf_version
from linkforge_compile.source import SourceRef


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


def check_names(robot: Robot, layout: Layout) -> Iterator[Diagnostic]:
    """Yield the names of a robot that Gazebo refuses, and those that are different in its SDF."""
    settings = layout.settings
    names = PartNames(layout)
    yield from _reserved(robot, layout, settings)
    yield from _taken(robot, layout, settings, names)
    yield from _renamed(robot, layout, names)
    yield from _unknown_collisions(robot, settings, names)


def is_reserved(name: str) -> bool:
    """Whether a name is one that SDF has a meaning for."""
    return name == WORLD or SEPARATOR in name or (name.startswith("__") and name.endswith("__"))


def _reserved(robot: Robot, layout: Layout, settings: Mapping[str | None, Settings]) -> Iterator[Diagnostic]:
    """SDF has `world`, `__…__` and `…::…` for itself."""
    if is_reserved(robot.name):
        yield RESERVED_IN_SDF.at(robot.source, "name", name=robot.name)
    for link in robot.links:
        if is_reserved(link.name) and not layout.is_world(link.name):
            yield RESERVED_IN_SDF.at(link.source, name=link.name)
        for shape in link.shapes:
            if shape.name and is_reserved(shape.name):
                yield RESERVED_IN_SDF.at(shape.source, "name", name=shape.name)
    parts: tuple[Joint | Sensor, ...] = (*robot.joints, *robot.sensors)
    for part in parts:
        if is_reserved(part.name):
            yield RESERVED_IN_SDF.at(part.source, name=part.name)
    for found in settings.values():
        for one in found:
            name = next(filter(is_reserved, one.names), None)
            if name and one.tag != "plugin":
                yield RESERVED_IN_SDF.at(one.source, *one.path, name=name)


def _taken(
    robot: Robot, layout: Layout, settings: Mapping[str | None, Settings], names: PartNames
) -> Iterator[Diagnostic]:
    """Links, joints and frames of a model share their names, and so do the sensors of a link."""
    taken = {*layout.held, *layout.frames, *layout.joint_names.values()}
    for one in settings.get(None, ()):
        for name in one.names:
            if name in taken and one.tag in OF_MODEL - {"plugin"}:
                yield TAKEN_IN_SDF.at(one.source, *one.path, owner=robot.name, name=name)
    for body in layout.held:
        for name in repeated(names.sensors(body)):
            yield TAKEN_IN_SDF.at(robot.links[body].source, owner=body, name=name)


def _renamed(robot: Robot, layout: Layout, names: PartNames) -> Iterator[Diagnostic]:
    for joint in robot.joints:
        if (name := layout.joint_names[joint.name]) != joint.name:
            yield RENAMED_IN_SDF.at(joint.source, joint=joint.name, name=name)
    for shapes in (*names.collisions.values(), *names.visuals.values()):
        for one in shapes:
            if one.is_renamed:
                old, kind = one.shape.name, one.shape.TAG
                yield RENAMED_SHAPE_IN_SDF.at(
                    one.shape.source, "name", shape=kind, old=old, link=one.link.name, name=one.name
                )


def _unknown_collisions(
    robot: Robot, settings: Mapping[str | None, Settings], names: PartNames
) -> Iterator[Diagnostic]:
    """A contact sensor that names a collision which its link does not have feels nothing."""
    felt: list[tuple[str, str, str, SourceRef | None, tuple[str | int, ...]]] = []
    for sensor in robot.sensors:
        if contact := sensor.contact_info:
            felt.append((sensor.link_name, sensor.name, contact.collision, contact.source, ("collision",)))
    for link in robot.links:
        for one in settings.get(link.name, ()):
            felt += [(link.name, sensor, name, one.source, one.path) for sensor, name in collisions_in(one)]
    for link_name, sensor_name, collision, source, path in felt:
        if names.collision(link_name, collision) is None:
            known = names.of_body(link_name)
            hint = did_you_mean(collision, known) or (f"; it has {', '.join(known)}" if known else "")
            yield NO_COLLISION_IN_SDF.at(
                source, *path, sensor=sensor_name, collision=collision, link=link_name, hint=hint
            )


def lost_parts(robot: Robot, layout: Layout) -> Iterator[Loss]:
    """Yield each part that is omitted, under the words for its kind."""
    yield from _losses_of_world(robot, layout)
    for joint in robot.joints:
        yield from _of_joint(joint, robot)
    for transmission in robot.transmissions:
        yield Loss("transmissions", transmission.name, transmission.source)
    for sensor in robot.sensors:
        above = layout.above.get(sensor.link_name)
        if sensor.type == SensorType.FORCE_TORQUE and not (above and layout.is_joint(above)):
            yield Loss("force-torque sensors without a joint", sensor.name, sensor.source, ("link",))
    yield from _lost_settings(robot, layout)
    for reference, setting in replaced_settings(layout.settings):
        words = f"second <surface>, so no place for the setting '{setting.tag}'"
        yield Loss(words, reference, setting.source, setting.path)
    for block in robot.gazebo_elements:
        if block.reference is not None:
            for plugin in block.plugins:
                yield Loss("plugins of links and joints", plugin.name, plugin.source)
    yield from _lost_xml(robot)


def _of_joint(joint: Joint, robot: Robot) -> Iterator[Loss]:
    limits = joint.limits
    if limits and any(value is not None for value in (limits.acceleration, limits.deceleration, limits.jerk)):
        yield Loss("limits of acceleration, deceleration and jerk", joint.name, limits.source)
    yield from joint_losses(joint, robot, loose=(JointType.FLOATING,))


def _losses_of_world(robot: Robot, layout: Layout) -> Iterator[Loss]:
    for link in robot.links:
        if not layout.is_world(link.name):
            continue
        if link.inertial:
            yield Loss("mass of the world", link.name, link.source, ("inertial",))
        if link.shapes:
            yield Loss("shapes of the world", link.name, link.source, ("visual" if link.visuals else "collision",))
        for sensor in robot.sensors:
            if sensor.link_name == link.name:
                yield Loss("sensors on the world", sensor.name, sensor.source, ("link",))


def _lost_settings(robot: Robot, layout: Layout) -> Iterator[Loss]:
    for reference, settings in layout.settings.items():
        held, where = _held_settings(reference, robot, layout)
        for setting in settings:
            if setting.tag not in held:
                is_held_elsewhere = setting.tag in OF_BODY | OF_JOINT
                parts = f"place for the setting '{setting.tag}'{where if is_held_elsewhere else ''}"
                yield Loss(parts, reference or robot.name, setting.source, setting.path)


def _held_settings(reference: str | None, robot: Robot, layout: Layout) -> tuple[Set[str], str]:
    """Return the tags that a part holds in SDF, and words for what it is there if it holds fewer than others."""
    if reference is None:
        return OF_MODEL, ""
    if robot.has_link(reference):
        if layout.is_world(reference):
            return frozenset(), " of the world"
        return (OF_FRAME, " of a frame") if reference in layout.frames else (OF_BODY, "")
    if not robot.has_joint(reference):
        return frozenset(), ""
    joint = robot.joints[reference]
    if not layout.is_joint(joint):
        return frozenset(KEEP_FIXED_JOINT if joint.type == JointType.FIXED else ()), " of a frame"
    return (OF_FIXED_JOINT, " of a fixed joint") if joint.type == JointType.FIXED else (OF_JOINT, "")


def _lost_xml(robot: Robot) -> Iterator[Loss]:
    parts = (
        held
        for held in doubtful_parts_of_urdf(robot).with_extras
        if not any(isinstance(part, _NOT_RAW_URDF) for part in (*held.around, held.part))
    )
    return lost_xml(robot, parts)


_NOT_RAW_URDF = (Sensor, GazeboElement, Ros2Control, Transmission)
"""What is SDF with all that is in it, is read from the URDF, or is reported as a whole."""
