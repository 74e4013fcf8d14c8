"""Names that SDF reserves, those that two parts have, and those of collisions that are not there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics.codes.simulators import (
    NO_COLLISION_IN_SDF,
    RENAMED_IN_SDF,
    RENAMED_SHAPE_IN_SDF,
    RESERVED_IN_SDF,
    TAKEN_IN_SDF,
)
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.formats.kinematic_tree import WORLD
from linkforge_compile.formats.sdf.models import SEPARATOR
from linkforge_compile.formats.sdf.part_names import PartNames, repeated
from linkforge_compile.formats.sdf.raw_sensors import collisions_in
from linkforge_compile.formats.sdf.settings import OF_MODEL, Settings

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.sensor import Sensor
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.sdf.layout import Layout
    from linkforge_compile.source import SourceRef


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
