"""Geometry: vectors, poses, and the shapes that links are made of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from math import isfinite
from typing import Annotated, ClassVar, TypeAlias

from linkforge_compile.core.constants import PI
from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.fields import ABOVE_ZERO, NOT_ZERO, Number, Text, Vector
from linkforge_compile.core.part import Element, Part, freeze
from linkforge_compile.core.rules import is_finite, not_finite, require_finite
from linkforge_compile.units import ANGLE, LENGTH


class GeometryType(StrEnum):
    """The shapes, by the tag that each becomes inside `<geometry>`."""

    BOX = "box"
    CYLINDER = "cylinder"
    SPHERE = "sphere"
    MESH = "mesh"
    CAPSULE = "capsule"


@dataclass(frozen=True, slots=True)
class Vector3(Part):
    """Three numbers along x, y, z; the unit is that of the field which holds them. Integers stay integers.

    An attribute of three numbers, such as `xyz`, `rpy`, `size` or `scale`.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity; the field is the position, 0 to 2.

    """

    x: float
    y: float
    z: float

    def __post_init__(self) -> None:
        if self.x.__class__ is self.y.__class__ is self.z.__class__ is float and isfinite(self.x + self.y + self.z):
            return  # most vectors
        for position, (name, value) in enumerate(zip("xyz", self, strict=True)):
            if not is_finite(value):
                raise not_finite(value, name, f"Vector3.{name}", (position,))

    def __iter__(self) -> Iterator[float]:
        return iter((self.x, self.y, self.z))

    def to_tuple(self) -> tuple[float, float, float]:
        """Return (x, y, z)."""
        return (self.x, self.y, self.z)

    def __str__(self) -> str:
        return f"{self.x} {self.y} {self.z}"


_ZERO = Vector3(0.0, 0.0, 0.0)
_ONE = Vector3(1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Transform(Element):
    """A pose in the frame of the thing that holds it: `<origin xyz rpy>`.

    `xyz` is the position [m], `rpy` the rotation about the fixed axes x, then y, then z [rad]. One that `is_stated`
    is written although it moves nothing; it is no other pose for that.
    """

    TAG: ClassVar[str] = "origin"

    xyz: Annotated[Vector3, Vector(LENGTH)] = _ZERO
    rpy: Annotated[Vector3, Vector(ANGLE)] = _ZERO
    is_stated: bool = field(default=False, kw_only=True, compare=False, repr=False)

    @property
    def is_written(self) -> bool:
        """Whether it becomes an element: it moves something, or is stated."""
        return self.is_stated or self != IDENTITY

    @classmethod
    def identity(cls) -> Transform:
        """Return the pose that moves nothing."""
        return cls()

    def __str__(self) -> str:
        return f"xyz: {self.xyz}, rpy: {self.rpy}"


IDENTITY = Transform()
"""The pose that moves nothing."""


class _Shape(Element):
    """What shapes have in common: a type, which is their tag inside `<geometry>`."""

    __slots__ = ()

    @property
    def type(self) -> GeometryType:
        """The tag of the shape inside `<geometry>`."""
        return GeometryType(self.TAG)


@dataclass(frozen=True, slots=True)
class Box(_Shape):
    """A cuboid centred on its origin: `<box size>`; `size` is its full extent along x, y, z [m].

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION unless every extent is above 0.

    """

    TAG: ClassVar[str] = "box"

    size: Annotated[Vector3, Vector(LENGTH, ABOVE_ZERO, example="[0.1, 0.1, 0.1]")]

    def __post_init__(self) -> None:
        freeze(self)
        for position, extent in enumerate(self.size):
            if extent <= 0:
                raise RobotPhysicsError(
                    ValidationErrorCode.PHYSICS_VIOLATION,
                    f"box dimensions must be positive [m], found {self.size}",
                    target="BoxSize",
                    value=self.size,
                    field=(position,),
                )

    def volume(self) -> float:
        """Return the volume [m³]."""
        return self.size.x * self.size.y * self.size.z


_RADIUS = Number(LENGTH, ABOVE_ZERO, example="0.1", is_required_in_urdf=True)
_LENGTH = Number(LENGTH, ABOVE_ZERO, example="0.5", is_required_in_urdf=True)


@dataclass(frozen=True, slots=True)
class Cylinder(_Shape):
    """A cylinder about its z axis, centred on its origin: `<cylinder radius length>`, both [m].

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION unless radius and length are above 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "cylinder"

    radius: Annotated[float, _RADIUS]
    length: Annotated[float, _LENGTH]

    def __post_init__(self) -> None:
        freeze(self)
        _require_extents(self, "radius", "length")

    def volume(self) -> float:
        """Return the volume [m³]."""
        return PI * (self.radius * self.radius) * self.length


@dataclass(frozen=True, slots=True)
class Sphere(_Shape):
    """A sphere about its origin: `<sphere radius>` [m].

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION unless the radius is above 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "sphere"

    radius: Annotated[float, _RADIUS]

    def __post_init__(self) -> None:
        freeze(self)
        _require_extents(self, "radius")

    def volume(self) -> float:
        """Return the volume [m³]."""
        return 4 / 3 * PI * (self.radius * self.radius * self.radius)


@dataclass(frozen=True, slots=True)
class Capsule(_Shape):
    """A cylinder about its z axis with a half sphere on either end: `<capsule radius length>`, both [m].

    `length` is that of the cylinder alone, so the whole is `length + 2 * radius` long. Centred on its origin.

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION unless radius and length are above 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "capsule"

    radius: Annotated[float, _RADIUS]
    length: Annotated[float, _LENGTH]

    def __post_init__(self) -> None:
        freeze(self)
        _require_extents(self, "radius", "length")

    def volume(self) -> float:
        """Return the volume [m³]."""
        return PI * (self.radius * self.radius) * (self.length + 4 / 3 * self.radius)


@dataclass(frozen=True, slots=True)
class Mesh(_Shape):
    """A shape from a file: `<mesh filename scale>`.

    `resource` is the file, as a URI or a path, and may be empty; `scale` the factors along x, y, z, where a
    negative one mirrors. Nothing is read, so a mesh has no volume here. Where `is_scale_stated`, the scale is written
    although it is 1; it is no other mesh for that.

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION for a factor of 0.

    """

    TAG: ClassVar[str] = "mesh"

    resource: Annotated[str, Text(key="file", xml="@filename", example="meshes/part.stl")]
    scale: Annotated[Vector3, Vector(bound=NOT_ZERO)] = _ONE
    is_scale_stated: bool = field(default=False, kw_only=True, compare=False, repr=False)

    @property
    def is_scale_written(self) -> bool:
        """Whether `scale` becomes an attribute: it is not 1, or is stated."""
        return self.is_scale_stated or self.scale != _ONE

    def __post_init__(self) -> None:
        freeze(self)
        for position, factor in enumerate(self.scale):
            if factor == 0:
                raise RobotPhysicsError(
                    ValidationErrorCode.PHYSICS_VIOLATION,
                    f"mesh scale must not be 0 along any axis, found {self.scale}",
                    target="MeshScale",
                    value=self.scale,
                    field=("scale", position),
                )


Geometry: TypeAlias = Box | Cylinder | Sphere | Capsule | Mesh
"""Any shape; the one child of `<geometry>`."""


def _require_extents(shape: Cylinder | Sphere | Capsule, *names: str) -> None:
    for name in names:
        extent: float = getattr(shape, name)
        if extent <= 0:
            raise RobotPhysicsError(
                ValidationErrorCode.PHYSICS_VIOLATION,
                f"{shape.type} {name} must be positive [m], found {extent}",
                target=f"{shape.type.title()}{name.title()}",
                value=extent,
                field=(name,),
            )
    require_finite(shape, *names)
