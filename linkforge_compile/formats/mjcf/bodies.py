"""Bodies in MJCF: links with their inertials and shapes, inside each other as joints hold them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.constants import LEAST_MASS, MIN_REASONABLE_INERTIA
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere
from linkforge_compile.core.models.link import Collision, InertiaTensor, Link, Visual
from linkforge_compile.core.physics import rotated
from linkforge_compile.formats.element import attributes_at, leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree, Node
from linkforge_compile.formats.mjcf.contacts import sliding_frictions
from linkforge_compile.formats.mjcf.joint_class import JointClass
from linkforge_compile.formats.mjcf.joints import free_joint_name, joint_elements
from linkforge_compile.formats.mjcf.masses import accepted_inertia, massless_movers
from linkforge_compile.formats.mjcf.poses import NO_OFFSET, NO_TURN, pose
from linkforge_compile.formats.mjcf.sensors import elements_in_body
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import NOTHING, Spellable, Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

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
