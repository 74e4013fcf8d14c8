"""Bodies in MJCF: links with their inertials, shapes and sensors, inside each other as joints hold them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.core.constants import (
    DEFAULT_CAMERA_FAR,
    DEFAULT_CAMERA_NEAR,
    LEAST_MASS,
    MIN_REASONABLE_INERTIA,
    NOISE_GAUSSIAN,
)
from linkforge_compile.core.models.geometry import IDENTITY, Box, Capsule, Cylinder, Geometry, Mesh, Sphere, Transform
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.link import Collision, InertiaTensor, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ForceTorqueDirection,
    ForceTorqueFrame,
    Sensor,
    SensorNoise,
    SensorType,
)
from linkforge_compile.core.moments import possible_inertia, principal_moments
from linkforge_compile.core.physics import rotated, rotation_matrix
from linkforge_compile.formats.element import attributes_at, leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree, Node
from linkforge_compile.formats.mjcf.contacts import sliding_frictions
from linkforge_compile.formats.mjcf.joints import JointClass, free_joint_name, joint_elements
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import NOTHING, Spellable, Xml

NO_OFFSET, NO_TURN = IDENTITY.xyz, IDENTITY.rpy


def pose(origin: Transform) -> dict[str, Spellable | None]:
    """Return the attributes of a pose; those that move nothing are None."""
    return {
        "pos": None if origin.xyz == NO_OFFSET else origin.xyz,
        "euler": None if origin.rpy == NO_TURN else origin.rpy,
    }


LEAST = 1e-13
"""MuJoCo refuses moving bodies with a hundredth of this mass [kg], and tensors with a tenth of it [kg·m²]."""


def massless_movers(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Link]:
    """Yield each link that moves although neither it nor what is fixed to it has mass and inertia."""
    for link, joint, _ in tree.nodes:
        moves = is_free and link.name != WORLD if joint is None else joint.type != JointType.FIXED
        if moves and not any(_has_inertia(robot.links[held]) for held in tree.held_by(link.name)):
            yield link


def _has_inertia(link: Link) -> bool:
    return link.mass > LEAST and principal_moments(accepted_inertia(link))[0] > LEAST / 2


def accepted_inertia(link: Link) -> InertiaTensor:
    """Return the tensor of a link with an inertial if MuJoCo accepts it, else one with larger moments."""
    return possible_inertia(link.inertia, LEAST if link.mass else 0.0)


_CAMERAS = (SensorType.CAMERA, SensorType.DEPTH_CAMERA, SensorType.RGBD_CAMERA)

_USUAL_CLIP = (DEFAULT_CAMERA_NEAR, DEFAULT_CAMERA_FAR)

PLUGINS = "plugins of sensors"

_WIDEST = 179.0
"""MuJoCo refuses a field of view of half a turn [deg]."""


def sensor_loss(sensor: Sensor) -> str | None:
    """Return what of a sensor MuJoCo has no counterpart for; None for one that it has."""
    info = sensor.force_torque_info
    if sensor.type == SensorType.FORCE_TORQUE and info:
        is_of_parent = info.frame == ForceTorqueFrame.PARENT
        return "force-torque sensors in the frame of the parent" if is_of_parent else None
    return None if sensor.type in (*_CAMERAS, SensorType.IMU) else f"sensors of type {sensor.type}"


def sensor_losses(sensor: Sensor) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the parts of a sensor, or the whole sensor, that MuJoCo does not have, with their paths."""
    if loss := sensor_loss(sensor):
        yield loss, ("type",)
        return
    if sensor.plugin:
        yield PLUGINS, ("plugin",)
    camera, imu, wrench = sensor.camera_info, sensor.imu_info, sensor.force_torque_info
    if camera and camera.noise:
        yield "noise of cameras", ("camera", "noise")
    if camera and (camera.near_clip, camera.far_clip) != _USUAL_CLIP:
        yield "clip distances of cameras", ("camera",)
    noises = {
        ("imu", "angular_velocity_noise"): imu and imu.angular_velocity_noise,
        ("imu", "linear_acceleration_noise"): imu and imu.linear_acceleration_noise,
        ("force_torque", "noise"): wrench and wrench.noise,
    }
    for path, noise in noises.items():
        if noise and noise != SensorNoise(NOISE_GAUSSIAN, stddev=noise.stddev):
            yield "noise other than a standard deviation", path


def has_opposite_sign(sensor: Sensor) -> bool:
    """Whether a sensor is to measure the force of the child on the parent; MuJoCo's has the other direction."""
    info = sensor.force_torque_info if sensor_loss(sensor) is None else None
    return info is not None and info.measure_direction == ForceTorqueDirection.CHILD_TO_PARENT


def elements_in_body(robot: Robot, link: str) -> list[Xml]:
    """Return the cameras and sites of the sensors on a link."""
    on_link = (sensor for sensor in robot.sensors if sensor.link_name == link and sensor_loss(sensor) is None)
    return [_camera(sensor) if sensor.type in _CAMERAS else _site(sensor) for sensor in on_link]


def _site(sensor: Sensor) -> Xml:
    """Return where a sensor measures; forces are those at the joint, in axes that may be turned."""
    origin = sensor.origin
    if sensor.type == SensorType.FORCE_TORQUE:
        is_turned = sensor.force_torque_info and sensor.force_torque_info.frame == ForceTorqueFrame.SENSOR
        origin = Transform(rpy=origin.rpy) if is_turned else Transform()
    return leaf_at("site", sensor.source, name=sensor.name, **pose(origin))


def _camera(sensor: Sensor) -> Xml:
    """Return a camera: that of Gazebo looks along x with z up, that of MuJoCo along -z with y up."""
    info = sensor.camera_info or CameraInfo()
    rows = rotation_matrix(sensor.origin.rpy)
    axes = (*(-row[1] for row in rows), *(row[2] for row in rows))
    half_height = math.tan(info.horizontal_fov / 2) * info.height / info.width
    return leaf_at(
        "camera",
        sensor.source,
        name=sensor.name,
        pos=sensor.origin.xyz,
        xyaxes=axes,
        fovy=min(math.degrees(2 * math.atan(half_height)), _WIDEST),
        resolution=(info.width, info.height),
    )


def sensor_elements(robot: Robot) -> Iterator[Xml]:
    """Yield what is measured at the sites of sensors."""
    for sensor in robot.sensors:
        if sensor_loss(sensor) is None and sensor.type not in _CAMERAS:
            yield from _imu(sensor) if sensor.type == SensorType.IMU else _force_torque(sensor)


def _imu(sensor: Sensor) -> Sequence[Xml]:
    """Return the sensors of an IMU, with the names that mujoco_ros2_control looks for."""
    info, source, name = sensor.imu_info, sensor.source, sensor.name
    turning = _stddev(info.angular_velocity_noise) if info else None
    pushing = _stddev(info.linear_acceleration_noise) if info else None
    return (
        leaf_at("gyro", source, name=f"{name}_gyro", site=name, noise=turning),
        leaf_at("accelerometer", source, name=f"{name}_accel", site=name, noise=pushing),
        leaf_at("framequat", source, name=f"{name}_quat", objtype="site", objname=name),
    )


def _force_torque(sensor: Sensor) -> Sequence[Xml]:
    name = sensor.name
    noise = _stddev(sensor.force_torque_info.noise) if sensor.force_torque_info else None
    return tuple(
        leaf_at(kind, sensor.source, name=f"{name}_{kind}", site=name, noise=noise) for kind in ("force", "torque")
    )


def _stddev(noise: SensorNoise | None) -> float | None:
    return noise.stddev or None if noise else None


_OTHER_FRICTION = (0.005, 0.0001)
"""MuJoCo's defaults for friction against spinning and rolling [m]."""

MeshNames: TypeAlias = Mapping[Mesh, str]
"""The names of the meshes that MuJoCo can read."""


def body_views(
    robot: Robot, tree: KinematicTree, meshes: MeshNames, joint_class: JointClass, *, is_free: bool
) -> Iterator[View]:
    """Yield the bodies in the order of the tree, each with its own parts and the number of bodies that end with it."""
    massless = {link.name for link in massless_movers(robot, tree, is_free=is_free)}
    nodes = [node for node in tree.nodes if node.link.name != WORLD]
    frictions = sliding_frictions(robot)
    following = [*(node.depth for node in nodes[1:]), 0]
    for node, next_depth in zip(nodes, following, strict=False):  # a robot may have no links
        link, joint = node.link, node.joint
        placed = pose(joint.origin) if joint else {}
        gravcomp = None if link.physics.gravity else 1
        yield View(
            attributes=attributes_at(link.source, name=link.name, **placed, gravcomp=gravcomp),
            inertial=inertial_element(link, is_massless=link.name in massless),
            joints=_joints(node, joint_class, is_free=is_free),
            shapes=shape_elements(link, meshes, frictions.get(link.name)),
            sensors=elements_in_body(robot, link.name),
            ends=node.depth + 1 - next_depth,
        )


def _joints(node: Node, joint_class: JointClass, *, is_free: bool) -> Sequence[Xml]:
    if node.joint:
        return joint_elements(node.joint, joint_class)
    return [leaf_at("freejoint", node.link.source, name=free_joint_name(node.link.name))] if is_free else []


def world_elements(robot: Robot, meshes: MeshNames) -> list[Xml]:
    """Return the shapes and sensors of the link that is the world itself."""
    if not robot.has_link(WORLD):
        return []
    world = robot.links[WORLD]
    return [*shape_elements(world, meshes, sliding_frictions(robot).get(WORLD)), *elements_in_body(robot, WORLD)]


def shape_elements(link: Link, meshes: MeshNames, mu: float | None) -> list[Xml]:
    """Return the geoms of the shapes of a link, without those that MuJoCo cannot read."""
    return [geom for shape in link.shapes if (geom := geom_element(shape, meshes, mu))]


def inertial_element(link: Link, *, is_massless: bool) -> Xml:
    """Return `<inertial>`, where a body that moves has some mass; nothing for a frame."""
    inertial = link.inertial
    if is_massless:
        least = (MIN_REASONABLE_INERTIA,) * 3
        return leaf_at("inertial", link.source, pos=NO_OFFSET, mass=LEAST_MASS, diaginertia=least)
    if inertial is None:
        return NOTHING
    stated: dict[str, Spellable | None] = {"pos": inertial.origin.xyz, "mass": inertial.mass}
    tensor, turn = accepted_inertia(link), inertial.origin.rpy
    if not (tensor.ixy or tensor.ixz or tensor.iyz):
        euler = None if turn == NO_TURN else turn
        moments = (tensor.ixx, tensor.iyy, tensor.izz)
        return leaf_at("inertial", inertial.source, **stated, euler=euler, diaginertia=moments)
    # MuJoCo refuses an orientation together with products of inertia.
    return leaf_at("inertial", inertial.source, **stated, fullinertia=_entries(rotated(tensor, turn)))


def _entries(tensor: InertiaTensor) -> tuple[float, ...]:
    return (tensor.ixx, tensor.iyy, tensor.izz, tensor.ixy, tensor.ixz, tensor.iyz)


def geom_element(shape: Visual | Collision, meshes: MeshNames, mu: float | None) -> Xml:
    """Return the geom of a shape; nothing for one that MuJoCo cannot read."""
    form = _form(shape.geometry, meshes)
    if form is None:
        return NOTHING
    if isinstance(shape, Collision):
        return leaf_at("geom", shape.source, **{"class": "collision"}, **form, **pose(shape.origin), **_friction(mu))
    color = shape.material.color if shape.material else None
    rgba = color.to_tuple() if color else None
    return leaf_at("geom", shape.source, **{"class": "visual"}, **form, **pose(shape.origin), rgba=rgba)


def _friction(mu: float | None) -> dict[str, Spellable | None]:
    """Return the friction of a geom.

    Of two geoms in contact MuJoCo takes the greater friction, and that of its ground is 1, unless one has priority.
    Without friction, a contact has one dimension, the normal.
    """
    if mu is None:
        return {}
    return {"friction": (mu, *_OTHER_FRICTION), "priority": 1, "condim": None if mu else 1}


def _form(geometry: Geometry, meshes: MeshNames) -> dict[str, Spellable | None] | None:
    """Return the type and size of a geom, None for an unknown mesh; MuJoCo's sizes are radii and half lengths."""
    match geometry:
        case Box(size=size):
            return {"type": "box", "size": tuple(extent / 2 for extent in size)}
        case Sphere(radius=radius):
            return {"type": "sphere", "size": (radius,)}
        case Cylinder(radius=radius, length=length):
            return {"type": "cylinder", "size": (radius, length / 2)}
        case Capsule(radius=radius, length=length):
            return {"type": "capsule", "size": (radius, length / 2)}
        case Mesh():
            return {"type": "mesh", "mesh": meshes[geometry]} if geometry in meshes else None
