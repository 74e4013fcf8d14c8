"""Joints: how one link may move relative to another, its limits and its friction."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated, ClassVar

from linkforge_compile.core.constants import (
    DEFAULT_JOINT_DAMPING,
    DEFAULT_JOINT_EFFORT,
    DEFAULT_JOINT_FRICTION,
    DEFAULT_JOINT_VELOCITY,
    EPSILON,
    UNKNOWN,
)
from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import (
    NOT_NEGATIVE,
    Axis,
    Child,
    Choice,
    Name,
    Number,
    Pose,
    Reference,
    check_numbers,
)
from linkforge_compile.core.models.geometry import IDENTITY, Transform, Vector3
from linkforge_compile.core.naming import require_name, require_valid_characters
from linkforge_compile.core.part import Element, FrozenMap, dump_like, extras_last
from linkforge_compile.units import ACCELERATION, DAMPING, EFFORT, JERK, POSITION, SPEED, Motion


class JointType(StrEnum):
    """The ways in which a child link may move, by the `type` of `<joint>`."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FIXED = "fixed"
    FLOATING = "floating"
    PLANAR = "planar"

    @property
    def motion(self) -> Motion:
        """How the joint moves, which its units depend on."""
        return _MOTIONS.get(self, Motion.OTHER)


dump_like(JointType, str)

SINGLE_AXIS = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)
"""The types of joints that turn about one axis, or slide along one: a mimic can multiply their position."""

_MOTIONS = {
    JointType.REVOLUTE: Motion.TURNING,
    JointType.CONTINUOUS: Motion.TURNING,
    JointType.PRISMATIC: Motion.SLIDING,
}
_DEGREES_OF_FREEDOM = {
    JointType.FIXED: 0,
    JointType.REVOLUTE: 1,
    JointType.CONTINUOUS: 1,
    JointType.PRISMATIC: 1,
    JointType.PLANAR: 2,
    JointType.FLOATING: 6,
}
_MOVE_ALONG_AN_AXIS = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR)
HAVE_NO_AXIS = (JointType.FIXED, JointType.FLOATING)
HAVE_NO_LIMITS = (JointType.FIXED,)
NEED_LIMITS = (JointType.REVOLUTE, JointType.PRISMATIC)

AXES: Mapping[str, Vector3] = {
    sign + name: Vector3(*(length if name == axis else 0.0 for axis in "xyz"))
    for sign, length in (("", 1.0), ("-", -1.0))
    for name in "xyz"
}
"""The axes that the language has words for."""


@extras_last
@dataclass(frozen=True)
class JointLimits(Element):
    """How far, how hard and how fast a joint may move: `<limit>`.

    `lower` and `upper` are positions [rad], None for no bound on that side, `effort` [N·m], `velocity` [rad/s];
    for prismatic joints [m], [N], [m/s]. `acceleration`, `deceleration` [rad/s²] and `jerk` [rad/s³], for prismatic
    joints [m/s²] and [m/s³], are None where they are not known; URDF has them since version 1.2.

    Raises:
        RobotValidationError: OUT_OF_RANGE if lower is above upper, or another limit below 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "limit"

    lower: Annotated[float | None, Number(POSITION, stand_in=-UNKNOWN)] = None
    upper: Annotated[float | None, Number(POSITION, stand_in=UNKNOWN)] = None
    effort: Annotated[
        float,
        Number(
            EFFORT,
            NOT_NEGATIVE,
            example=FrozenMap({Motion.TURNING: "50 N*m", Motion.SLIDING: "50 N", Motion.OTHER: "1"}),
            stand_in=1.0,
            is_required_in_urdf=True,
        ),
    ] = DEFAULT_JOINT_EFFORT
    velocity: Annotated[
        float,
        Number(
            SPEED,
            NOT_NEGATIVE,
            example=FrozenMap({Motion.TURNING: "90 deg/s", Motion.SLIDING: "0.2 m/s", Motion.OTHER: "1"}),
            stand_in=1.0,
            is_required_in_urdf=True,
        ),
    ] = DEFAULT_JOINT_VELOCITY
    acceleration: Annotated[float | None, Number(ACCELERATION, NOT_NEGATIVE)] = field(default=None, kw_only=True)
    deceleration: Annotated[float | None, Number(ACCELERATION, NOT_NEGATIVE)] = field(default=None, kw_only=True)
    jerk: Annotated[float | None, Number(JERK, NOT_NEGATIVE)] = field(default=None, kw_only=True)

    def _check(self) -> None:
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise RobotValidationError.out_of_range(
                f"lower limit must not be above upper, found {self.lower} and {self.upper}",
                "JointLimitRange",
                (self.lower, self.upper),
                "lower",
            )
        check_numbers(self)


@extras_last
@dataclass(frozen=True)
class JointDynamics(Element):
    """Damping and friction of a joint: `<dynamics>`.

    `damping` [N·m·s/rad] and static `friction` [N·m]; [N·s/m] and [N] for prismatic joints.

    Raises:
        RobotValidationError: OUT_OF_RANGE if one is below 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "dynamics"

    damping: Annotated[float, Number(DAMPING, NOT_NEGATIVE)] = DEFAULT_JOINT_DAMPING
    friction: Annotated[float, Number(EFFORT, NOT_NEGATIVE)] = DEFAULT_JOINT_FRICTION


@extras_last
@dataclass(frozen=True)
class JointMimic(Element):
    """A joint at `multiplier` times the position of `joint`, plus `offset`: `<mimic>`.

    `offset` is [rad], or [m] for a prismatic joint. `stated` names those of
    the two that are written although they have their default; it is not compared.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "mimic"

    joint: Annotated[str, Reference("joint", example="left_finger")]
    multiplier: Annotated[float, Number(stand_in=UNKNOWN)] = 1.0
    offset: Annotated[float, Number(POSITION, stand_in=UNKNOWN)] = 0.0
    stated: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)


@extras_last
@dataclass(frozen=True)
class JointSafetyController(Element):
    """Where a controller begins to limit a joint: `<safety_controller>`.

    The soft limits are positions [rad] or [m]; `k_position` bounds the velocity by the distance to them,
    `k_velocity` the effort by the distance to that velocity. None for what is not written.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "safety_controller"

    soft_lower_limit: Annotated[float | None, Number(POSITION, stand_in=-UNKNOWN)] = None
    soft_upper_limit: Annotated[float | None, Number(POSITION, stand_in=UNKNOWN)] = None
    k_position: Annotated[float | None, Number()] = None
    k_velocity: Annotated[float, Number(is_required_in_urdf=True)] = 0.0


@extras_last
@dataclass(frozen=True)
class JointCalibration(Element):
    """Positions [rad] or [m] where a reference switch goes up or down, or None: `<calibration>`.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG: ClassVar[str] = "calibration"

    rising: Annotated[float | None, Number(POSITION)] = None
    falling: Annotated[float | None, Number(POSITION)] = None


@extras_last
@dataclass(frozen=True)
class Joint(Element):
    """A joint: `<joint name type>` with `<parent>`, `<child>`, `<origin>`, `<axis>` and the rest.

    `parent` and `child` are names of links. `origin` is the pose of the child link in the frame of the parent
    link while the joint is at 0. `axis` is a unit vector in the joint's own frame (for planar, the normal of the
    plane), and None exactly for fixed and floating joints. `limits` may be None unless the joint is revolute or
    prismatic, and is None if it is fixed. None for the other parts if the joint has none.
    `axis_as_written` is the vector that was read where that was not a unit vector, else None; it is not compared.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name, parent or child; INVALID_NAME for a name with other
            characters than letters, digits and `_ - . /`; INVALID_VALUE for a joint from a link to itself, an axis
            or limits that the type lacks or may not have, and an axis that is not of length 1.

    """

    TAG: ClassVar[str] = "joint"

    name: Annotated[str, Name()]
    type: Annotated[JointType, Choice(JointType, example="revolute")]
    parent: Annotated[str, Reference("link", xml="parent/@link", example="base")]
    child: Annotated[str, Reference("link", xml="child/@link", example="arm")]
    origin: Annotated[Transform, Pose()] = IDENTITY
    axis: Annotated[Vector3 | None, Axis(xml="axis/@xyz")] = None
    limits: Annotated[JointLimits | None, Child()] = None
    dynamics: Annotated[JointDynamics | None, Child()] = None
    mimic: Annotated[JointMimic | None, Child()] = None
    safety_controller: Annotated[JointSafetyController | None, Child()] = None
    calibration: Annotated[JointCalibration | None, Child()] = None
    axis_as_written: Vector3 | None = field(default=None, kw_only=True, compare=False, repr=False)

    def _check(self) -> None:
        require_name(self.name, "joint name", "JointName")
        require_valid_characters(self.name, "joint name", "JointName")
        require_name(self.parent, "parent link name", "ParentLink", ("parent",))
        require_name(self.child, "child link name", "ChildLink", ("child",))
        if self.parent == self.child:
            raise RobotValidationError.invalid(
                f"parent and child link cannot be the same, found '{self.child}'", "JointTopology", self.child, "child"
            )
        self._check_parts_of_type()
        if self.axis is not None:
            self._check_axis(self.axis)

    def _check_parts_of_type(self) -> None:
        kind = f"{self.type}"
        if self.type in _MOVE_ALONG_AN_AXIS and self.axis is None:
            raise RobotValidationError.invalid(f"axis required for joint type '{kind}'", "JointAxis", kind, "axis")
        if self.type in HAVE_NO_AXIS and self.axis is not None:
            raise RobotValidationError.invalid(f"axis not allowed for joint type '{kind}'", "JointAxis", kind, "axis")
        if self.type in NEED_LIMITS and self.limits is None:
            raise RobotValidationError.invalid(
                f"limits required for joint type '{kind}'", "JointLimits", kind, "limits"
            )
        if self.type in HAVE_NO_LIMITS and self.limits is not None:
            raise RobotValidationError.invalid(
                f"limits not allowed for joint type '{kind}'", "JointLimits", kind, "limits"
            )

    def _check_axis(self, axis: Vector3) -> None:
        length = math.hypot(axis.x, axis.y, axis.z)
        if length < EPSILON:
            raise RobotValidationError.invalid("joint axis cannot be a zero vector", "JointAxis", axis, "axis")
        if abs(length - 1) > EPSILON:
            raise RobotValidationError.invalid(
                f"joint axis must be a unit vector, found length {length}", "JointAxisNormalization", length, "axis"
            )

    @property
    def degrees_of_freedom(self) -> int:
        """How many numbers determine the pose of the child: 0 fixed, 1 for one axis, 2 planar, 6 floating."""
        return _DEGREES_OF_FREEDOM[self.type]

    @property
    def bounds(self) -> tuple[float, float] | None:
        """The lowest and highest position [rad] or [m]; None for a joint without limits of its position.

        Readers of URDF take 0 for a limit that is not written.
        """
        if self.type not in NEED_LIMITS or self.limits is None:
            return None
        return self.limits.lower or 0.0, self.limits.upper or 0.0

    @property
    def default_position(self) -> float:
        """The position in MoveIt's default pose [rad] or [m]: 0, or the middle of the limits if they exclude it."""
        lower, upper = self.bounds or (0.0, 0.0)
        return 0.0 if lower <= 0.0 <= upper else (lower + upper) / 2
