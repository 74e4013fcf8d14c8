"""Links as URDF writes them: mass, shapes and materials."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.geometry import Box, Geometry, Material, Mesh, Sphere, Transform, Vector3
from linkforge_compile.core.models.link import COLLISION, USUAL_PHYSICS, VISUAL, Collision, Inertial, Link, Visual
from linkforge_compile.formats.element import attributes, attributes_at, elements, leaf, leaf_at, placed
from linkforge_compile.formats.xml_text import NOTHING, Xml
from linkforge_compile.units import number_text


class MaterialView(NamedTuple):
    """`<material>`; one that only refers to the robot's has neither color nor texture."""

    attributes: Xml
    color: Xml = NOTHING
    texture: Xml = NOTHING
    elements: Xml = NOTHING


class InertialView(NamedTuple):
    """`<inertial>`."""

    attributes: Xml
    origin: Xml
    mass: str
    inertia: Xml
    elements: Xml


class ShapeView(NamedTuple):
    """`<visual>` or `<collision>`, by its tag; None for a material that it lacks."""

    tag: str
    attributes: Xml
    origin: Xml
    geometry: Xml
    material: MaterialView | None
    elements: Xml


class LinkView(NamedTuple):
    """`<link>`."""

    attributes: Xml
    inertial: InertialView | None
    shapes: tuple[ShapeView, ...]
    elements: Xml


def link_views(links: Iterable[Link], materials: Mapping[str, Material], version: str | None) -> tuple[LinkView, ...]:
    """Return the links of a document that states a version, None for none.

    A visual refers to a material of the robot where it has the same one, else says it in full.
    """
    return tuple(
        LinkView(
            attributes(link, name=link.name),
            _inertial(link.inertial, version) if link.inertial else None,
            _shapes(link, materials, version),
            elements(link),
        )
        for link in links
    )


def material_view(material: Material) -> MaterialView:
    return MaterialView(
        attributes(material, name=material.name),
        leaf("color", material.color, rgba=material.color.to_tuple()) if material.color else NOTHING,
        NOTHING
        if material.texture is None
        else leaf_at("texture", material.source, "texture", filename=material.texture),
        elements(material),
    )


def origin(pose: Transform, version: str | None) -> Xml:
    """Return `<origin>` as a document of a version says it; nothing for one that moves nothing and is not stated."""
    if not pose.is_written:
        return NOTHING
    return leaf("origin", pose, xyz=pose.xyz, rpy=_rpy_beside_extras(pose, version))


def _rpy_beside_extras(pose: Transform, version: str | None) -> Vector3 | None:
    if not pose.extra_attributes:
        return pose.rpy
    from linkforge_compile.formats.urdf.quaternion import rpy_beside_quaternion

    return rpy_beside_quaternion(pose, version)


def _inertial(inertial: Inertial, version: str | None) -> InertialView:
    tensor = inertial.inertia
    return InertialView(
        attributes(inertial),
        origin(inertial.origin, version),
        placed(number_text(inertial.mass), inertial.source, "mass"),
        leaf(
            "inertia",
            tensor,
            ixx=tensor.ixx,
            ixy=tensor.ixy,
            ixz=tensor.ixz,
            iyy=tensor.iyy,
            iyz=tensor.iyz,
            izz=tensor.izz,
        ),
        elements(inertial),
    )


def _shapes(link: Link, materials: Mapping[str, Material], version: str | None) -> tuple[ShapeView, ...]:
    return tuple([_shape(shape, materials, version) for shape in link.shapes])


def _shape(shape: Visual | Collision, materials: Mapping[str, Material], version: str | None) -> ShapeView:
    return ShapeView(
        VISUAL if isinstance(shape, Visual) else COLLISION,
        attributes(shape, name=shape.name),
        origin(shape.origin, version),
        _geometry(shape.geometry),
        _material_of(shape, materials) if isinstance(shape, Visual) else None,
        elements(shape),
    )


def _geometry(shape: Geometry) -> Xml:
    match shape:
        case Box():
            return leaf("box", shape, size=shape.size)
        case Sphere():
            return leaf("sphere", shape, radius=shape.radius)
        case Mesh():
            return leaf("mesh", shape, filename=shape.resource, scale=shape.scale if shape.is_scale_written else None)
        case cylinder_or_capsule:
            return leaf(cylinder_or_capsule.type, shape, radius=shape.radius, length=shape.length)


def _material_of(visual: Visual, materials: Mapping[str, Material]) -> MaterialView | None:
    material = visual.material
    if material is None:
        return None
    known = materials.get(material.name)
    if known is material or known == material:
        return MaterialView(attributes_at(visual.source, "material", name=material.name))
    return material_view(material)


def says_physics(link: Link) -> bool:
    """Whether there is anything to tell a simulator of a link."""
    return link.physics is not USUAL_PHYSICS and link.physics != USUAL_PHYSICS
