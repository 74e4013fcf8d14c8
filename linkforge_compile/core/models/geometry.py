"""Vectors, poses, the shapes that links are made of, and their materials."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from math import isfinite
from typing import Annotated, ClassVar, Self, TypeAlias

from linkforge_compile.core.constants import DEFAULT_MATERIAL_RGBA, PI
from linkforge_compile.core.exceptions import RobotPhysicsError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.fields import (
    ABOVE_ZERO,
    NOT_ZERO,
    Colour,
    Flag,
    Name,
    Number,
    Text,
    Vector,
    check_numbers,
    is_finite,
    not_finite,
    number_fields,
)
from linkforge_compile.core.part import Element, Part, extras_last
from linkforge_compile.units import ANGLE, LENGTH


class GeometryType(StrEnum):
    """The shapes, by the tag that each becomes inside `<geometry>`."""

    BOX = "box"
    CYLINDER = "cylinder"
    SPHERE = "sphere"
    MESH = "mesh"
    CAPSULE = "capsule"


@dataclass(frozen=True)
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


@extras_last
@dataclass(frozen=True)
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
    def identity(cls) -> Self:
        """Return the pose that moves nothing."""
        return cls()

    def __str__(self) -> str:
        return f"xyz: {self.xyz}, rpy: {self.rpy}"


IDENTITY = Transform()
"""The pose that moves nothing."""


class _Shape(Element):
    """What shapes have in common: a type, which is their tag inside `<geometry>`, and sizes [m] above 0.

    Raises:
        RobotPhysicsError: PHYSICS_VIOLATION for a size that is not above 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    @property
    def type(self) -> GeometryType:
        """The tag of the shape inside `<geometry>`."""
        return GeometryType(self.TAG)

    def _check(self) -> None:
        for name in number_fields(type(self)):
            extent: float = getattr(self, name)
            if extent <= 0:
                message = f"{self.type} {name} must be positive [m], found {extent}"
                target = f"{self.type.title()}{name.title()}"
                raise RobotPhysicsError(ValidationErrorCode.PHYSICS_VIOLATION, message, target, extent, field=(name,))
        check_numbers(self)


@extras_last
@dataclass(frozen=True)
class Box(_Shape):
    """A cuboid centred on its origin: `<box size>`; `size` is its full extent along x, y, z [m]."""

    TAG: ClassVar[str] = "box"

    size: Annotated[Vector3, Vector(LENGTH, ABOVE_ZERO, example="[0.1, 0.1, 0.1]")]

    def _check(self) -> None:
        for position, extent in enumerate(self.size):
            if extent <= 0:
                message = f"box dimensions must be positive [m], found {self.size}"
                code = ValidationErrorCode.PHYSICS_VIOLATION
                raise RobotPhysicsError(code, message, "BoxSize", self.size, field=(position,))

    def volume(self) -> float:
        """Return the volume [m³]."""
        return self.size.x * self.size.y * self.size.z


_RADIUS = Number(LENGTH, ABOVE_ZERO, example="0.1", is_required_in_urdf=True)
_LENGTH = Number(LENGTH, ABOVE_ZERO, example="0.5", is_required_in_urdf=True)


@extras_last
@dataclass(frozen=True)
class Cylinder(_Shape):
    """A cylinder about its z axis, centred on its origin: `<cylinder radius length>`, both [m]."""

    TAG: ClassVar[str] = "cylinder"

    radius: Annotated[float, _RADIUS]
    length: Annotated[float, _LENGTH]

    def volume(self) -> float:
        """Return the volume [m³]."""
        return PI * (self.radius * self.radius) * self.length


@extras_last
@dataclass(frozen=True)
class Sphere(_Shape):
    """A sphere about its origin: `<sphere radius>` [m]."""

    TAG: ClassVar[str] = "sphere"

    radius: Annotated[float, _RADIUS]

    def volume(self) -> float:
        """Return the volume [m³]."""
        return 4 / 3 * PI * (self.radius * self.radius * self.radius)


@extras_last
@dataclass(frozen=True)
class Capsule(_Shape):
    """A cylinder about its z axis with a half sphere on either end: `<capsule radius length>`, both [m].

    `length` is that of the cylinder alone, so the whole is `length + 2 * radius` long. Centred on its origin.
    """

    TAG: ClassVar[str] = "capsule"

    radius: Annotated[float, _RADIUS]
    length: Annotated[float, _LENGTH]

    def volume(self) -> float:
        """Return the volume [m³]."""
        return PI * (self.radius * self.radius) * (self.length + 4 / 3 * self.radius)


@extras_last
@dataclass(frozen=True)
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

    def _check(self) -> None:
        for position, factor in enumerate(self.scale):
            if factor == 0:
                message = f"mesh scale must not be 0 along any axis, found {self.scale}"
                code, path = ValidationErrorCode.PHYSICS_VIOLATION, ("scale", position)
                raise RobotPhysicsError(code, message, "MeshScale", self.scale, field=path)


Geometry: TypeAlias = Box | Cylinder | Sphere | Capsule | Mesh
"""Any shape; the one child of `<geometry>`."""


@extras_last
@dataclass(frozen=True)
class Color(Element):
    """Red, green, blue and opacity, each from 0 to 1: `<color rgba>`.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a component outside of [0, 1]; the field is its position, 0 to 3.

    """

    TAG = "color"

    r: float
    g: float
    b: float
    a: float = 1.0

    def _check(self) -> None:
        for position, component in enumerate(self.to_tuple()):
            if not 0 <= component <= 1:
                message = f"color component must be in range [0.0, 1.0], found {component}"
                code = ValidationErrorCode.OUT_OF_RANGE
                raise RobotValidationError(code, message, "ColorComponent", component, field=(position,))

    @classmethod
    def white(cls) -> Self:
        """Return opaque white."""
        return cls(1.0, 1.0, 1.0, 1.0)

    @classmethod
    def black(cls) -> Self:
        """Return opaque black."""
        return cls(0.0, 0.0, 0.0, 1.0)

    @classmethod
    def grey(cls) -> Self:
        """Return the grey of a shape without a color: 0.7, opaque."""
        return cls(*DEFAULT_MATERIAL_RGBA)

    def to_tuple(self) -> tuple[float, float, float, float]:
        """Return (r, g, b, a)."""
        return (self.r, self.g, self.b, self.a)

    def __str__(self) -> str:
        return f"{self.r} {self.g} {self.b} {self.a}"


@extras_last
@dataclass(frozen=True)
class Material(Element):
    """A color, a texture or both, under a name that may be empty: `<material name>`.

    `texture` is the file of the image, as a URI or a path: `<texture filename>`; None for none. With
    `after_links` it is written after the links: of two colors of one name, MuJoCo uses the first in the document
    wherever only the name is given. It is not compared; for equal materials of one name it holds if all have it.

    Raises:
        RobotValidationError: VALUE_EMPTY if it has neither color nor texture.

    """

    TAG = "material"

    name: Annotated[str, Name()]
    color: Annotated[Color | None, Colour()] = None
    texture: Annotated[str | None, Text(xml="texture/@filename")] = None
    after_links: Annotated[bool, Flag(xml="")] = field(default=False, compare=False, repr=False, kw_only=True)

    def _check(self) -> None:
        if self.color is None and self.texture is None:
            message = f"material '{self.name}' must have a color or a texture"
            raise RobotValidationError.empty(message, "MaterialDefinition", self.name)
