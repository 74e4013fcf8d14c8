"""Inertia of bodies, primitive shapes and meshes as solids: moved, turned and summed exactly."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from linkforge_compile.core.exceptions import RobotPhysicsError
from linkforge_compile.core.models.geometry import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Mesh,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.core.models.link import Inertial, InertiaTensor

Matrix: TypeAlias = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]
"""Three rows of three."""


def calculate_inertia(geometry: Geometry, mass: float) -> InertiaTensor:
    """Return the inertia of a solid body of that shape about its centre, in the axes of the shape [kg·m²].

    The mass [kg] is spread evenly; there is no lower bound, so a light body is as exact as a heavy one.

    Raises:
        RobotPhysicsError: INVALID_VALUE for a mesh, whose content is not known here; OUT_OF_RANGE if the mass is
            below 0.

    """
    if mass < 0:
        raise _out_of_range("mass", "must be at least 0 kg", mass)
    match geometry:
        case Box():
            return _box_inertia(geometry, mass)
        case Cylinder():
            return _cylinder_inertia(geometry, mass)
        case Sphere():
            moment = 2 * mass * geometry.radius * geometry.radius / 5
            return InertiaTensor(moment, moment, moment)
        case Capsule():
            return _capsule_inertia(geometry, mass)
        case Mesh():
            raise _no_primitive(geometry)


def _box_inertia(box: Box, mass: float) -> InertiaTensor:
    xx, yy, zz = (extent * extent for extent in box.size)
    return InertiaTensor(mass * (yy + zz) / 12, mass * (xx + zz) / 12, mass * (xx + yy) / 12)


def _cylinder_inertia(cylinder: Cylinder, mass: float) -> InertiaTensor:
    radius_squared = cylinder.radius * cylinder.radius
    across = mass * (3 * radius_squared + cylinder.length * cylinder.length) / 12
    return InertiaTensor(across, across, mass * radius_squared / 2)


def _capsule_inertia(capsule: Capsule, mass: float) -> InertiaTensor:
    radius, length = capsule.radius, capsule.length
    ball_length = 4 / 3 * radius  # of a cylinder that holds as much as both caps
    barrel = mass * length / (length + ball_length)
    caps = mass * ball_length / (length + ball_length)
    # The centre of a half sphere is 3/8 of its radius from its face, which is half the length from the middle.
    across = barrel * (length * length / 12 + radius * radius / 4) + caps * (
        2 / 5 * radius * radius + length * length / 4 + 3 / 8 * length * radius
    )
    return InertiaTensor(across, across, (barrel / 2 + 2 / 5 * caps) * radius * radius)


def rotation_matrix(rpy: Vector3) -> Matrix:
    """Return the rotation by roll, pitch, yaw [rad] about the fixed axes x, then y, then z, as in URDF.

    Its columns are the turned axes, so it maps a vector of the turned frame to the frame around it.
    """
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle), math.cos(angle)) for angle in rpy)
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


def rotated(inertia: InertiaTensor, rpy: Vector3) -> InertiaTensor:
    """Return a tensor of axes turned by `rpy` [rad] in the axes around them, about the same point."""
    if not any(rpy):
        return inertia
    turn = rotation_matrix(rpy)
    half = _product(turn, _matrix(inertia))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = _product(half, _transposed(turn))
    # The sine of half a turn is 1.2e-16 and not 0, and another platform's may be the next double. Such
    # a product of inertia is rounding, and no byte of the output may depend on it.
    noise = _TURNING_NOISE * (abs(ixx) + abs(iyy) + abs(izz))
    ixy, ixz, iyz = (product if abs(product) > noise else 0.0 for product in (ixy, ixz, iyz))
    return InertiaTensor(ixx, iyy, izz, ixy, ixz, iyz)


_TURNING_NOISE = 1e-15
"""What rounding leaves of a product of inertia that is zero, as part of the moments."""


def shifted(inertia: InertiaTensor, mass: float, lever_arm: Vector3) -> InertiaTensor:
    """Return a tensor about the centre of mass as it is about a point `lever_arm` [m] away.

    `mass` [kg]; the sign of the lever arm does not matter.
    """
    x, y, z = lever_arm
    return InertiaTensor(
        inertia.ixx + mass * (y * y + z * z),
        inertia.iyy + mass * (x * x + z * z),
        inertia.izz + mass * (x * x + y * y),
        inertia.ixy - mass * x * y,
        inertia.ixz - mass * x * z,
        inertia.iyz - mass * y * z,
    )


def combined_inertial(bodies: Sequence[Inertial]) -> Inertial:
    """Return the inertial of several bodies, given in one frame, joined rigidly.

    Its origin is the common centre of mass in that frame, its tensor is about that point, in the frame's axes.

    Raises:
        RobotPhysicsError: OUT_OF_RANGE if the bodies weigh nothing together, for they have no centre of mass then.

    """
    mass = _total(body.mass for body in bodies)
    if mass <= 0:
        raise _out_of_range("mass", "of all bodies together must be above 0 kg", mass)
    centre = Vector3(
        *(
            _total(body.mass / mass * at for body, at in zip(bodies, axis, strict=True))
            for axis in zip(*(body.origin.xyz for body in bodies), strict=True)
        )
    )
    tensors = []
    for body in bodies:
        lever_arm = Vector3(*(at - to for at, to in zip(body.origin.xyz, centre, strict=True)))
        tensors.append(shifted(rotated(body.inertia, body.origin.rpy), body.mass, lever_arm))
    return Inertial(mass, Transform(centre), _sum(tensors))


def inertial_of_shapes(
    shapes: Sequence[tuple[Geometry, Transform]],
    *,
    mass: float | None = None,
    density: float | None = None,
    meshes: Mapping[Mesh, Solid] | None = None,
) -> Inertial:
    """Return the inertial of a solid body made of shapes, each with its pose in the link frame.

    Either the `mass` [kg] of all of them is given, spread by volume, or the `density` [kg/m³] of each; where shapes
    overlap, the common part counts for both. `meshes` has the solid of each mesh, in its own frame and scaled.
    The origin is the centre of mass in the link frame, the tensor is in the axes of the link.

    Raises:
        RobotPhysicsError: VALUE_EMPTY without shapes, INVALID_VALUE for a mesh that is not in `meshes`, or unless
            exactly one of mass and density is given, OUT_OF_RANGE if that is not above 0.

    """
    if not shapes:
        raise RobotPhysicsError.empty("there is no shape to compute an inertia from", "Inertial")
    solids = meshes or {}
    masses = _masses([_volume(geometry, solids) for geometry, _ in shapes], mass, density)
    body = combined_inertial(
        [_body(share, geometry, pose, solids) for share, (geometry, pose) in zip(masses, shapes, strict=True)]
    )
    # The shares may add up to a last digit more or less than the mass given.
    return body if mass is None else replace(body, mass=mass)


def _masses(volumes: Sequence[float], mass: float | None, density: float | None) -> list[float]:
    if mass is not None and density is None:
        if mass <= 0:
            raise _out_of_range("mass", "must be above 0 kg to compute an inertia", mass)
        total = _total(volumes)
        if total <= 0:
            raise _out_of_range("volume", "must be above 0 m³ to compute an inertia", total)
        if total == math.inf:
            raise _out_of_range("volume", "must be finite to compute an inertia", total)
        return [mass * (volume / total) for volume in volumes]
    if density is not None and mass is None:
        if density <= 0:
            raise _out_of_range("density", "must be above 0 kg/m³", density)
        return [density * volume for volume in volumes]
    raise RobotPhysicsError.invalid("give either a mass or a density", "Inertial", None, "mass")


def _volume(geometry: Geometry, meshes: Mapping[Mesh, Solid]) -> float:
    return _solid(geometry, meshes).volume if isinstance(geometry, Mesh) else geometry.volume()


def _body(mass: float, geometry: Geometry, pose: Transform, meshes: Mapping[Mesh, Solid]) -> Inertial:
    """Return a shape as a body of that mass: a primitive's centre is where its pose is, a mesh's anywhere."""
    if not isinstance(geometry, Mesh):
        return Inertial(mass, pose, calculate_inertia(geometry, mass))
    solid = _solid(geometry, meshes)
    turned = (_dot(row, solid.centre.to_tuple()) for row in rotation_matrix(pose.rpy))
    centre = Vector3(*(at + offset for at, offset in zip(pose.xyz, turned, strict=True)))
    return Inertial(mass, Transform(centre, pose.rpy), solid.inertia(mass))


def _solid(mesh: Mesh, meshes: Mapping[Mesh, Solid]) -> Solid:
    solid = meshes.get(mesh)
    if solid is None:
        raise _no_primitive(mesh)
    return solid


def _no_primitive(mesh: Mesh) -> RobotPhysicsError:
    return RobotPhysicsError.invalid(
        f"mesh '{mesh.resource}' is not a primitive, so its inertia cannot be computed from its dimensions; "
        "state mass and inertia, use primitive collision shapes, or give its solid in `meshes`",
        "Geometry",
        mesh.resource,
    )


def _out_of_range(name: str, rule: str, found: float) -> RobotPhysicsError:
    return RobotPhysicsError.out_of_range(f"{name} {rule}, found {found}", name.capitalize(), found, name)


def _matrix(inertia: InertiaTensor) -> Matrix:
    return (
        (inertia.ixx, inertia.ixy, inertia.ixz),
        (inertia.ixy, inertia.iyy, inertia.iyz),
        (inertia.ixz, inertia.iyz, inertia.izz),
    )


def _product(left: Matrix, right: Matrix) -> Matrix:
    columns = _transposed(right)
    a, b, c = ((_dot(row, columns[0]), _dot(row, columns[1]), _dot(row, columns[2])) for row in left)
    return (a, b, c)


def _dot(left: tuple[float, float, float], right: tuple[float, float, float]) -> float:
    return left[0] * right[0] + left[1] * right[1] + left[2] * right[2]


def _transposed(matrix: Matrix) -> Matrix:
    x, y, z = zip(*matrix, strict=True)
    return (x, y, z)


def _total(numbers: Iterable[float]) -> float:
    """Return the exact sum, rounded once; infinite beyond a double, which the constructors refuse."""
    try:
        return math.fsum(numbers)
    except OverflowError:
        return math.inf


def _sum(tensors: Sequence[InertiaTensor]) -> InertiaTensor:
    return InertiaTensor(
        *(_total(getattr(tensor, entry) for tensor in tensors) for entry in InertiaTensor.__match_args__)
    )


@dataclass(frozen=True)
class Solid:
    """A shape that holds a volume, in a frame of its own.

    `volume` [m³]; `centre` of the volume [m]; `spread`, the integrals of x², y², z² about the centre, and `skew`,
    those of xy, xz, yz [m⁵]; `size` of its box along the axes of the frame [m].
    """

    volume: float
    centre: Vector3
    spread: Vector3
    skew: Vector3
    size: Vector3

    def scaled(self, scale: Vector3) -> Solid:
        """Return the solid with each axis of its frame stretched by a factor; a negative one mirrors.

        Raises:
            RobotPhysicsError: OUT_OF_RANGE if no volume that a double can hold is left.

        """
        x, y, z = scale
        stretch = abs(x * y * z)
        volume = self.volume * stretch
        if not 0 < volume < math.inf:
            raise RobotPhysicsError.out_of_range(
                f"a scale of {scale} takes the volume of the mesh to {volume} m³", "MeshScale", scale
            )
        return Solid(
            volume,
            Vector3(*(at * factor for at, factor in zip(self.centre, scale, strict=True))),
            Vector3(*(one * factor * factor * stretch for one, factor in zip(self.spread, scale, strict=True))),
            Vector3(self.skew.x * x * y * stretch, self.skew.y * x * z * stretch, self.skew.z * y * z * stretch),
            Vector3(*(one * abs(factor) for one, factor in zip(self.size, scale, strict=True))),
        )

    def inertia(self, mass: float) -> InertiaTensor:
        """Return the inertia [kg·m²] of that mass [kg], spread evenly, about the centre in the frame's axes."""
        density = mass / self.volume
        xx, yy, zz = (density * one for one in self.spread)
        xy, xz, yz = (density * one for one in self.skew)
        return InertiaTensor(yy + zz, xx + zz, xx + yy, -xy, -xz, -yz)
