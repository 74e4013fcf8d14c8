"""Links: rigid bodies with their mass, visuals and collisions, and the order of these shapes."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from itertools import accumulate, chain, islice, zip_longest
from typing import TYPE_CHECKING, Annotated, ClassVar, Self, TypeVar

from linkforge_compile.core.constants import (
    DEFAULT_CONTACT_KD,
    DEFAULT_CONTACT_KP,
    DEFAULT_FRICTION_MU,
    DEFAULT_FRICTION_MU2,
    DEFAULT_SELF_COLLIDE,
    GRAVITY_ENABLED,
    MIN_REASONABLE_INERTIA,
)
from linkforge_compile.core.exceptions import RobotPhysicsError, RobotValidationError
from linkforge_compile.core.fields import (
    NOT_NEGATIVE,
    Child,
    Children,
    Flag,
    Name,
    Number,
    Pose,
    Text,
    check_numbers,
    tags_with_text,
)
from linkforge_compile.core.models.geometry import IDENTITY, Geometry, Material, Transform
from linkforge_compile.core.naming import require_name, require_valid_characters
from linkforge_compile.core.part import Element, Part, Stating, attribute_pairs, extras_last, prefixed_fields, set_field
from linkforge_compile.source import Sourced
from linkforge_compile.units import CONTACT_DAMPING, INERTIA, MASS, STIFFNESS

_MOMENT = Number(INERTIA, example="0.01", is_required_in_urdf=True)
_PRODUCT = Number(INERTIA, is_required_in_urdf=True)


@extras_last
@dataclass(frozen=True)
class InertiaTensor(Element):
    """Entries of the tensor itself, so ixy = -∫ x·y dm [kg·m²], as URDF writes them: `<inertia>`.

    Any finite numbers are held, the diagonal first; whether a body can have them is a check of its own.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "inertia"
    ATTRIBUTE_ORDER = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

    ixx: Annotated[float, _MOMENT]
    iyy: Annotated[float, _MOMENT]
    izz: Annotated[float, _MOMENT]
    ixy: Annotated[float, _PRODUCT] = 0.0
    ixz: Annotated[float, _PRODUCT] = 0.0
    iyz: Annotated[float, _PRODUCT] = 0.0

    @classmethod
    def stability_floor(cls) -> Self:
        """Return 1e-9 kg·m² about every axis: small enough not to matter, large enough for a solver."""
        return cls(MIN_REASONABLE_INERTIA, MIN_REASONABLE_INERTIA, MIN_REASONABLE_INERTIA)


_STABILITY_FLOOR = InertiaTensor.stability_floor()


@extras_last
@dataclass(frozen=True)
class Inertial(Element):
    """The mass properties of a link: `<inertial>`.

    `mass` [kg], 0 or above. `origin` is the centre of mass with the axes of the tensor, in the link frame.
    `inertia` is about the centre of mass in those axes; the stability floor by default.

    Raises:
        RobotPhysicsError: OUT_OF_RANGE if the mass is below 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "inertial"

    mass: Annotated[float, Number(MASS, NOT_NEGATIVE, xml="mass/@value", is_required_in_urdf=True)]
    origin: Annotated[Transform, Pose()] = IDENTITY
    inertia: Annotated[InertiaTensor, Child(is_required_in_urdf=True)] = _STABILITY_FLOOR

    def _check(self) -> None:
        if self.mass < 0:
            raise RobotPhysicsError.out_of_range(
                f"mass must be at least 0 kg, found {self.mass}", "Mass", self.mass, "mass"
            )
        check_numbers(self)


@dataclass(frozen=True)
class LinkPhysics(Part, Stating):
    """How a simulator treats a link in contact: tags of its `<gazebo reference>`, defaults left out.

    `stated` names the fields that are written although they have their default: simulators do not agree on it.
    `mu` and `mu2` are Coulomb coefficients along the first and second friction direction, `kp` the contact
    stiffness [N/m], `kd` the contact damping [N·s/m].

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    self_collide: Annotated[bool, Flag(xml="selfCollide/text()")] = DEFAULT_SELF_COLLIDE
    gravity: Annotated[bool, Flag(xml="gravity/text()")] = GRAVITY_ENABLED
    mu: Annotated[float, Number(xml="mu1/text()")] = DEFAULT_FRICTION_MU
    mu2: Annotated[float, Number(xml="mu2/text()")] = DEFAULT_FRICTION_MU2
    kp: Annotated[float, Number(STIFFNESS, xml="kp/text()")] = DEFAULT_CONTACT_KP
    kd: Annotated[float, Number(CONTACT_DAMPING, xml="kd/text()")] = DEFAULT_CONTACT_KD
    stated: Sequence[str] = field(default=(), kw_only=True, repr=False)

    def __post_init__(self) -> None:
        set_field(self, "stated", tuple(self.stated))
        check_numbers(self)


USUAL_PHYSICS = LinkPhysics()
"""The defaults of simulators."""

PHYSICS_TAGS = tags_with_text(LinkPhysics)
"""The tag of Gazebo that each field of LinkPhysics becomes, in the order in which they are written."""


@extras_last
@dataclass(frozen=True)
class Visual(Element):
    """A visible shape: `<visual>`; `origin` is in the link frame, `material` and `name` may be None."""

    TAG = "visual"

    geometry: Annotated[Geometry, Child(key="", xml="geometry/*")]
    origin: Annotated[Transform, Pose()] = IDENTITY
    material: Annotated[Material | None, Child()] = None
    name: Annotated[str | None, Name(key="name")] = None


@extras_last
@dataclass(frozen=True)
class Collision(Element):
    """A shape in contact: `<collision>`; `origin` is its pose in the link frame, `name` may be None."""

    TAG = "collision"

    geometry: Annotated[Geometry, Child(key="", xml="geometry/*")]
    origin: Annotated[Transform, Pose()] = IDENTITY
    name: Annotated[str | None, Name(key="name")] = None


@dataclass
class Link(Sourced):  # noqa: PLW1641 its `__eq__` is for type checkers alone
    """A rigid body, or a frame if it has no `inertial` and no shapes: `<link name>`. It is mutable.

    `extra_attributes` and `extra_elements` are as on `Element`. `shape_order` has a 'visual' or 'collision' for each
    shape in the order in which they are written, empty for visuals before collisions: to MuJoCo a collision has the
    color of the visual before it. It is not compared.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name, INVALID_NAME for one with other characters than
            letters, digits and `_ - . /`, INVALID_VALUE for another word in `shape_order`.

    """

    TAG: ClassVar[str] = "link"
    renamings: ClassVar[int] = 0
    """How often any link was renamed in place: when it changes, look-up by name starts anew."""

    name: Annotated[str, Name()]
    inertial: Annotated[Inertial | None, Child()] = None
    physics: Annotated[LinkPhysics, Child(xml="../gazebo")] = USUAL_PHYSICS
    visuals: Annotated[Sequence[Visual], Children(key="visual")] = ()
    collisions: Annotated[Sequence[Collision], Children(key="collision")] = ()
    shape_order: Annotated[Sequence[str], Text(xml="")] = field(default=(), compare=False, repr=False, kw_only=True)
    extra_attributes: Sequence[tuple[str, str]] = field(default=(), repr=False, kw_only=True)
    extra_elements: Sequence[str] = field(default=(), repr=False, kw_only=True)

    def __post_init__(self) -> None:
        require_name(self.name, "link name", "LinkName")
        require_valid_characters(self.name, "link name", "LinkName")
        self.visuals = tuple(self.visuals)
        self.collisions = tuple(self.collisions)
        self.shape_order = _kinds(self.shape_order)
        self.extra_attributes = attribute_pairs(self.extra_attributes)
        self.extra_elements = tuple(self.extra_elements)

    def __setattr__(self, field: str, value: object) -> None:
        if type(self) is Link and field != "source" and field not in self.__dataclass_fields__:
            raise AttributeError(f"a Link has no field '{field}'")  # a misspelled one would not be missed
        if field == "name" and hasattr(self, "name"):
            Link.renamings += 1
        object.__setattr__(self, field, value)

    def add_visual(self, visual: Visual) -> None:
        """Append a visual."""
        self.visuals = (*self.visuals, visual)

    def add_collision(self, collision: Collision) -> None:
        """Append a collision."""
        self.collisions = (*self.collisions, collision)

    @property
    def shapes(self) -> tuple[Visual | Collision, ...]:
        """The visuals and collisions as they are written; those that `shape_order` does not list come last."""
        if not self.shape_order:
            return (*self.visuals, *self.collisions)
        visuals, collisions = iter(self.visuals), iter(self.collisions)
        of_kind: Mapping[str, Iterator[Visual | Collision]] = {VISUAL: visuals, COLLISION: collisions}
        listed = [shape for kind in self.shape_order for shape in islice(of_kind[kind], 1)]
        return (*listed, *visuals, *collisions)

    @property
    def mass(self) -> float:
        """The mass [kg]; 0 for a link without inertial."""
        return self.inertial.mass if self.inertial else 0.0

    @property
    def inertia(self) -> InertiaTensor:
        """The tensor about the centre of mass [kg·m²]; the stability floor for a link without inertial."""
        return self.inertial.inertia if self.inertial else _STABILITY_FLOOR

    @property
    def inertial_origin(self) -> Transform:
        """The centre of mass and the tensor's axes in the link frame; identity for a link without inertial."""
        return self.inertial.origin if self.inertial else IDENTITY

    def with_prefix(self, prefix: str) -> Self:
        """Return a new link with its name and those of its visuals and collisions prefixed.

        A link of a derived class is copied, not constructed: its constructor may accept anything.

        Raises:
            RobotValidationError: INVALID_NAME, where the prefix makes a name that no link may have.

        """
        require_valid_characters(prefix + self.name if self.name else "", "link name", "LinkName")
        link = copy(self)
        shapes = {"visuals": tuple(self.visuals), "collisions": tuple(self.collisions)}
        for field_name, value in {**shapes, **prefixed_fields(self, prefix)}.items():
            object.__setattr__(link, field_name, value)  # no table has the copy yet, so that this is no renaming
        return link

    if TYPE_CHECKING:

        def __eq__(self, other: object) -> bool: ...  # for the same reason as that of Part


def _kinds(words: Sequence[str]) -> tuple[str, ...]:
    for word in words:
        if word not in KINDS:
            raise RobotValidationError.invalid(
                f"shape_order has the words {' and '.join(map(repr, KINDS))}, found {word!r}",
                "ShapeOrder",
                word,
                "shape_order",
            )
    return tuple(words)


ColorT = TypeVar("ColorT")

VISUAL, COLLISION = "visual", "collision"
KINDS = (VISUAL, COLLISION)

PAIRS = "pairs"
"""The word for alternating kinds, beginning with the kind of the first shape; shapes without a partner come last."""


def grouped(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds with all of the first one before the others, which is the default order."""
    return tuple(sorted(kinds, key=lambda kind: kind != kinds[0]))


def in_pairs(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds in the order that PAIRS means."""
    first = [kind for kind in kinds if kind == kinds[0]]
    others = [kind for kind in kinds if kind != kinds[0]]
    return tuple(kind for kind in chain.from_iterable(zip_longest(first, others)) if kind)


def shortest_setting(kinds: Sequence[str]) -> str | Sequence[str] | None:
    """Return the `shape_order` to write for these kinds: PAIRS or a list; None for the default order."""
    if tuple(kinds) == grouped(kinds):
        return None
    return PAIRS if tuple(kinds) == in_pairs(kinds) else kinds


def shown_colors(own: Iterable[ColorT | None]) -> Iterator[ColorT | None]:
    """Yield the color of each shape of a link in MuJoCo, given their own colors in document order.

    A shape without a color, such as any collision, has that of the shape before it; None before the first color.
    """
    return accumulate(own, lambda before, color: before if color is None else color)
