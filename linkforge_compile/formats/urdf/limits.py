"""What URDF, Gazebo's tags in it, or most of their readers, cannot hold: reported before anything is written."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from linkforge_compile.core.models.gazebo import BLOCK_THAT_KEEPS_JOINT, keeps_fixed_joint
from linkforge_compile.core.models.geometry import Material, Transform
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import (
    FOREIGN_INFO,
    FRAME_OF_PLUGIN,
    NEW_GEOMETRY,
    NO_JOINT_TO_SENSE,
    NOISELESS_CONTACT,
    OLD_VERSION,
    OTHER_QUATERNION,
    SENSOR_ON_MERGED_JOINT,
    TWO_MATERIALS,
    UNKNOWN_VERSION,
)
from linkforge_compile.diagnostics.entry_fixes import add_entry, leave_out
from linkforge_compile.formats.limits import check_attributes, check_texts, check_written_twice, undeclared_prefixes
from linkforge_compile.formats.parts import Held, doubtful_parts_of_urdf
from linkforge_compile.formats.urdf.view import capsules, stated_version
from linkforge_compile.formats.xml_text import spelled
from linkforge_compile.source import Key

_READ_VERSIONS = ("1.0", "1.1", "1.2")


def urdf_limits(robot: Robot, gazebo: str, render: Callable[[], str]) -> Iterator[Diagnostic]:
    """Yield what `render` leaves out or refuses, and what common readers refuse in what it writes."""
    doubtful = doubtful_parts_of_urdf(robot)
    yield from check_texts(robot, doubtful)
    yield from undeclared_prefixes(robot, doubtful.with_extras)
    yield from check_written_twice(doubtful.with_extras)
    yield from check_attributes(doubtful.with_extras, robot, render)
    yield from check_capsules(robot)
    yield from check_version(robot)
    yield from check_turns(robot, doubtful.with_extras)
    yield from check_materials_of_one_name(robot)
    for sensor in robot.sensors:
        yield from check_force_torque(sensor, robot)
        yield from check_contact(sensor)
        yield from check_frame(sensor, gazebo)
        yield from check_infos(sensor)


def check_capsules(robot: Robot) -> Iterator[Diagnostic]:
    """URDF has capsules since version 1.1, which the file states by itself where its author states none.

    Readers built before that refuse the whole file, whatever it states. A cylinder or a mesh suits them all.
    """
    capsule = next(capsules(robot), None)
    if capsule is None:
        return
    yield NEW_GEOMETRY.at(capsule.source)
    if robot.is_version_written and robot.version == "1.0":
        fault = OLD_VERSION.at(robot.source, "version", version=robot.version)
        yield fault.with_fix(leave_out(robot.source, "version"))


def check_version(robot: Robot) -> Iterator[Diagnostic]:
    """The `version` of a robot is that of the URDF language, not that of the robot's design."""
    if robot.is_version_written and robot.version not in _READ_VERSIONS:
        yield UNKNOWN_VERSION.at(robot.source, "version", version=robot.version)


def check_turns(robot: Robot, parts: Sequence[Held]) -> Iterator[Diagnostic]:
    """An origin turns one way: readers of URDF 1.1 take its `quat_xyzw`, the compiler and older ones its `rpy`."""
    poses = [part for part, *_ in parts if isinstance(part, Transform) and part.extra_attributes]
    if not poses:
        return
    from linkforge_compile.formats.urdf.view import QUATERNION, is_other_turn, reads_quaternions

    if not reads_quaternions(stated_version(robot)):
        return

    for pose in poses:
        if is_other_turn(pose):
            rpy = spelled(pose.rpy)
            fault = OTHER_QUATERNION.at(pose.source, "extra_attributes", Key(QUATERNION), rpy=rpy)
            yield fault.with_fix(leave_out(pose.source, "extra_attributes", QUATERNION))


def check_materials_of_one_name(robot: Robot) -> Iterator[Diagnostic]:
    """A reader keeps one material a name, urdfdom the first, and shows every visual that names it in that one."""
    first: dict[str, Material] = dict(robot.materials)
    for link in robot.links:
        for material in (visual.material for visual in link.visuals):
            if material is None or not material.name:
                continue
            known = first.setdefault(material.name, material)
            if known is not material and known != material:
                notes = [Note("the first is here", known.source.span)] if known.source else []
                yield TWO_MATERIALS.at(material.source, name=material.name, notes=notes)


def check_force_torque(sensor: Sensor, robot: Robot) -> Iterator[Diagnostic]:
    """Gazebo measures forces in a joint: the one above the sensor's link.

    It merges links that a fixed joint holds together, unless the joint's Gazebo block says otherwise, and such a
    joint's sensor is gone.
    """
    if sensor.type != SensorType.FORCE_TORQUE:
        return
    joint = robot.get_parent_joint(sensor.link_name)
    if joint is None:
        yield NO_JOINT_TO_SENSE.at(sensor.source, "link", link=sensor.link_name)
    elif joint.type == JointType.FIXED and not keeps_fixed_joint(robot.get_gazebo_elements(joint.name)):
        fault = SENSOR_ON_MERGED_JOINT.at(sensor.source, "link", joint=joint.name)
        yield fault.with_fix(add_entry(joint.source, entry=BLOCK_THAT_KEEPS_JOINT, after="type"))


def check_contact(sensor: Sensor) -> Iterator[Diagnostic]:
    """SDFormat has no noise for contact sensors."""
    if sensor.contact_info and sensor.contact_info.noise:
        yield NOISELESS_CONTACT.at(sensor.contact_info.noise.source or sensor.source)


def check_frame(sensor: Sensor, gazebo: str) -> Iterator[Diagnostic]:
    """In Gazebo Classic the plugin that publishes says in which frame."""
    if gazebo == "classic" and sensor.frame is not None:
        yield FRAME_OF_PLUGIN.at(sensor.source, "frame", frame=sensor.frame)


def check_infos(sensor: Sensor) -> Iterator[Diagnostic]:
    """A sensor writes the info of its type and no other."""
    from linkforge_compile.formats.urdf.gazebo import INFOS

    own = INFOS[SensorType(sensor.type)]
    for info in dict.fromkeys(INFOS.values()):
        if info != own and getattr(sensor, f"{info}_info") is not None:
            yield FOREIGN_INFO.at(sensor.source, info, type=sensor.type, info=info)
