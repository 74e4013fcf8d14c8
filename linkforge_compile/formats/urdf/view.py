"""The view of a robot that the templates of URDF lay out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, ClassVar

from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Capsule, Color, Mesh, Transform, Vector3
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.models.sensor import Sensor, SensorNoise
from linkforge_compile.core.models.transmission import TransmissionActuator, TransmissionJoint
from linkforge_compile.core.physics import rotation_matrix
from linkforge_compile.formats.element import attributes, attributes_at, elements, leaf, leaf_at
from linkforge_compile.formats.urdf.gazebo import gazebo_view, noise_view, physics_views, plugin_view, sensor_view
from linkforge_compile.formats.views import View, Views, named_texts
from linkforge_compile.formats.xml_text import NOTHING, Xml

# The version of URDF that brought <capsule>; urdfdom reads one only in files that state it or a later one.
_CAPSULE_VERSION = "1.1"


def stated_version(robot: Robot) -> str | None:
    """Return the `version` that the file states: the author's, else the one that its capsules need, else None."""
    if robot.is_version_written:
        return robot.version
    return _CAPSULE_VERSION if any(capsules(robot)) else None


def capsules(robot: Robot) -> Iterator[Capsule]:
    """Yield the capsules of all links in the order in which they are written."""
    for link in robot.links:
        for shape in link.shapes:
            if isinstance(shape.geometry, Capsule):
                yield shape.geometry


def robot_view(robot: Robot, gazebo: str) -> View:
    """Return what templates see of a robot in URDF.

    Raises:
        RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.

    """
    views = UrdfViews(robot, stated_version(robot), gazebo)
    materials = views.materials.values()
    return View(
        attributes=attributes(robot, name=robot.name, version=views.version),
        materials=views.of_all(one for one in materials if not one.after_links),
        links=views.of_all(robot.links),
        materials_after_links=views.of_all(one for one in materials if one.after_links),
        joints=views.of_all(robot.joints),
        transmissions=views.of_all(robot.transmissions),
        ros2_controls=views.of_all(robot.ros2_controls),
        gazebo=(*physics_views(robot.links), *views.of_all(robot.gazebo_elements)),
        sensors=views.of_all(robot.sensors),
        elements=elements(robot),
    )


class UrdfViews(Views):
    """Makes views of the parts of a robot, in a document that states a version (None for none)."""

    def __init__(self, robot: Robot, version: str | None, gazebo: str) -> None:
        self.version = version
        self.materials = {material.name: material for material in robot.materials.values() if material.name}
        self.robot, self.gazebo = robot, gazebo

    def link(self, link: Link) -> View:
        return View(
            attributes=attributes(link, name=link.name),
            inertial=self.of(link.inertial) if link.inertial else None,
            shapes=self.of_all(link.shapes),
            elements=elements(link),
        )

    def visual(self, visual: Visual) -> View:
        """Return a visual, which refers to a material of the robot where it has the same one, else holds its own."""
        material, known = visual.material, self.materials.get(visual.material.name) if visual.material else None
        if material is None or (known is not material and known != material):
            return self.view(visual)
        reference = attributes_at(visual.source, "material", name=material.name)
        return self.view(visual, material=View(attributes=reference, color=NOTHING, texture=NOTHING, elements=NOTHING))

    def origin(self, pose: Transform) -> Xml:
        """Return `<origin>`; nothing for one that moves nothing and is not stated."""
        if not pose.is_written:
            return NOTHING
        if not pose.extra_attributes:
            return leaf(pose)
        return leaf(pose, rpy=rpy_beside_quaternion(pose, self.version))

    def joint(self, joint: Joint) -> View:
        if joint.axis_as_written is None:
            return self.view(joint)
        return self.view(joint, axis=leaf_at("axis", joint.source, "axis", xyz=joint.axis_as_written))

    def transmission_end(self, end: TransmissionJoint | TransmissionActuator) -> View:
        # A reduction of 1 is written too, because loaders require it.
        changes = {} if end.is_written("offset") else {"offset": None}
        return self.view(end, **changes if end.interfaces_stated else changes | {"hardware_interfaces": ()})

    def interface(self, name: str) -> View:
        interface = Interface.of(name)
        return View(
            attributes=attributes(interface, name=interface),
            parameters=named_texts(interface.parameters, interface.source),
            elements=elements(interface),
        )

    def sensor(self, sensor: Sensor) -> View:
        return sensor_view(self, sensor, self.robot, self.gazebo)

    makers: ClassVar[Mapping[type, Callable[[Any, Any], object]]] = {
        Link: link,
        Visual: visual,
        Collision: lambda views, collision: views.view(collision, material=None),
        Transform: origin,
        Mesh: lambda _, mesh: leaf(mesh, **{} if mesh.is_scale_written else {"scale": None}),
        Color: lambda _, color: leaf(color, rgba=color.to_tuple()),
        Joint: joint,
        TransmissionJoint: transmission_end,
        TransmissionActuator: transmission_end,
        str: interface,
        GazeboElement: lambda _, block: gazebo_view(block),
        GazeboPlugin: lambda _, plugin: plugin_view(plugin),
        Sensor: sensor,
        SensorNoise: noise_view,
    }


QUATERNION = "quat_xyzw"
_VERSIONS_WITHOUT = (None, "1.0")
_NO_TURN = Vector3(0.0, 0.0, 0.0)
_TOLERANCE = 1e-9
"""By so much may the entries of two rotation matrices differ that are the same turn."""


def reads_quaternions(version: str | None) -> bool:
    """Whether readers take the quaternions of a document that states a version, None for none, or ignore them."""
    return version not in _VERSIONS_WITHOUT


def rpy_beside_quaternion(pose: Transform, version: str | None) -> Vector3 | None:
    """Return the rpy that an origin states in a document of a version; None if its quaternion is enough."""
    quaternion = dict(pose.extra_attributes).get(QUATERNION)
    if quaternion is None:
        return pose.rpy
    replaces_rpy = pose.rpy == _NO_TURN or (reads_quaternions(version) and _turns_as(quaternion, pose.rpy))
    return None if replaces_rpy else pose.rpy


def is_other_turn(pose: Transform) -> bool:
    """Whether an origin has a quaternion that turns otherwise than its rpy does."""
    quaternion = dict(pose.extra_attributes).get(QUATERNION)
    return quaternion is not None and not _turns_as(quaternion, pose.rpy)


def _turns_as(quaternion: str, rpy: Vector3) -> bool:
    """Whether the text of a quaternion (x, y, z, w) is the rotation of an rpy [rad]."""
    try:
        x, y, z, w = map(float, quaternion.split())
    except ValueError:
        return False
    square = x * x + y * y + z * z + w * w
    if not square or not math.isfinite(square):
        return False
    s = 2 / square
    turned = (
        (1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        (s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)),
        (s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)),
    )
    pairs = zip(turned, rotation_matrix(rpy), strict=True)
    return all(abs(a - b) <= _TOLERANCE for one, other in pairs for a, b in zip(one, other, strict=True))
