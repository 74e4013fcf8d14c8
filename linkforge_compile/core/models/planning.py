"""Motion planning: groups of joints, their named poses, end effectors, virtual and passive joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from numbers import Real
from typing import Annotated, Any

from linkforge_compile.core.constants import SRDF_VJOIN_FIXED, SRDF_VJOIN_FLOATING, SRDF_VJOIN_PLANAR
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.fields import Children, Choice, Name, Reference, Text
from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.part import Element, freeze, set_field
from linkforge_compile.core.rules import is_finite, not_finite, require_choice, require_not_blank


class VirtualJointType(StrEnum):
    """How the robot may move in the world."""

    FIXED = SRDF_VJOIN_FIXED
    PLANAR = SRDF_VJOIN_PLANAR
    FLOATING = SRDF_VJOIN_FLOATING


@dataclass(frozen=True, slots=True)
class VirtualJoint(Element):
    """The joint between the world and the robot: `<virtual_joint name type parent_frame child_link>`.

    `type` is `fixed`, `planar` or `floating`; `parent_frame` belongs to the world and takes no prefix.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name, INVALID_VALUE for another type.

    """

    TAG = "virtual_joint"

    name: Annotated[str, Name()]
    type: Annotated[str, Choice(VirtualJointType, example="fixed")]
    parent_frame: Annotated[str, Text(example="world")]
    child_link: Annotated[str, Reference("link", example="base")]

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.name, "virtual joint name", "VirtualJointName")
        require_choice(self.type, VirtualJointType, "virtual joint type", "VirtualJointType", "type")


@dataclass(frozen=True, slots=True)
class Chain(Element):
    """The joints from one link to another: `<chain base_link tip_link>`; both ends may be the same link.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank end.

    """

    TAG = "chain"

    base_link: Annotated[str, Reference("link", example="base")]
    tip_link: Annotated[str, Reference("link", example="tool0")]

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.base_link, "base_link of a chain", "ChainBaseLink", ("base_link",))
        require_not_blank(self.tip_link, "tip_link of a chain", "ChainTipLink", ("tip_link",))


@dataclass(frozen=True, slots=True)
class PlanningGroup(Element):
    """Joints that are planned together: `<group name>`; given by links, joints, chains or other groups.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name, VALUE_EMPTY for a group of nothing.

    """

    TAG = "group"
    NAMES_INSIDE_TAKE_PREFIX = True

    name: Annotated[str, Name()]
    links: Annotated[Sequence[str], Reference("link", xml="link/@name")] = ()
    joints: Annotated[Sequence[str], Reference("joint", xml="joint/@name")] = ()
    chains: Annotated[Sequence[Chain], Children()] = ()
    subgroups: Annotated[Sequence[str], Reference("group", xml="group/@name")] = ()

    def __post_init__(self) -> None:
        freeze(self, "links", "joints", "chains", "subgroups")
        require_not_blank(self.name, "planning group name", "PlanningGroupName")
        if not (self.links or self.joints or self.chains or self.subgroups):
            raise RobotValidationError(
                ValidationErrorCode.VALUE_EMPTY,
                f"planning group '{self.name}' must have at least one link, joint, chain or subgroup",
                target="PlanningGroup",
            )


def chain_between(group: str, base_link: str | None, tip_link: str | None) -> tuple[Chain, ...]:
    """Return the one chain between two links, none for two None.

    Raises:
        RobotValidationError: INVALID_VALUE for one link without the other.

    """
    if base_link and tip_link:
        return (Chain(base_link, tip_link),)
    if base_link or tip_link:
        raise RobotValidationError(
            ValidationErrorCode.INVALID_VALUE,
            f"base_link and tip_link of group '{group}' must be given together",
            target="PlanningGroup",
            value=base_link or tip_link,
            field=("chain",),
        )
    return ()


@dataclass(frozen=True, slots=True)
class GroupState(Element):
    """A named pose of a group: `<group_state name group>`.

    `joint_values` are positions [rad] or [m] by joint, each a tuple with a number for every degree of freedom.
    A number given alone becomes a tuple of one float, another collection a tuple, anything else a tuple of itself.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name or group.
        RobotMathError: INVALID_VALUE for NaN or infinity; the field is the joint and the position in its tuple.

    """

    TAG = "group_state"
    NAMES_INSIDE_TAKE_PREFIX = True

    name: Annotated[str, Name()]
    group: Annotated[str, Reference("group", key="")]
    # Any: numbers are accepted, and made tuples
    joint_values: Annotated[Mapping[str, Any], Reference("joint", key="", xml="joint/@name")] = FrozenMap()

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.name, "group state name", "GroupStateName")
        require_not_blank(self.group, "group of a state", "GroupName", ("group",))
        values = {joint: _position_tuple(given) for joint, given in self.joint_values.items()}
        for joint, positions in values.items():
            for index, position in enumerate(positions):
                if isinstance(position, int | float) and not is_finite(position):
                    raise not_finite(position, f"position of '{joint}'", "GroupState", (joint, index))
        set_field(self, "joint_values", FrozenMap(values))


def _position_tuple(given: object) -> tuple[object, ...]:
    if isinstance(given, list | set | tuple):
        return tuple(given)
    return (float(given),) if isinstance(given, Real) else (given,)


@dataclass(frozen=True, slots=True)
class EndEffector(Element):
    """A group that is a tool at the end of an arm: `<end_effector name group parent_link parent_group>`.

    `parent_link` is the link of the arm that carries it, `parent_group` the group of the arm, None if not given.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name or group.

    """

    TAG = "end_effector"

    name: Annotated[str, Name()]
    group: Annotated[str, Reference("group", example="gripper")]
    parent_link: Annotated[str, Reference("link", example="tool0")]
    parent_group: Annotated[str | None, Reference("group")] = None

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.name, "end effector name", "EndEffectorName")
        require_not_blank(self.group, "group of an end effector", "GroupName", ("group",))


@dataclass(frozen=True, slots=True)
class PassiveJoint(Element):
    """A joint that nothing drives: `<passive_joint name>`.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name.

    """

    TAG = "passive_joint"

    name: Annotated[str, Reference("joint", key="")]

    def __post_init__(self) -> None:
        freeze(self)
        require_not_blank(self.name, "passive joint name", "PassiveJointName")


@dataclass(frozen=True, slots=True)
class JointProperty(Element):
    """A remark on a joint that a planner reads: `<joint_property joint_name property_name value>`.

    Raises:
        RobotValidationError: VALUE_EMPTY if one of the three is blank.

    """

    TAG = "joint_property"

    joint_name: Annotated[str, Reference("joint", key="")]
    property_name: Annotated[str, Text(key="")]
    value: Annotated[str, Text(example="true")]

    def __post_init__(self) -> None:
        freeze(self)
        for name in ("joint_name", "property_name", "value"):
            if not getattr(self, name).strip():
                raise RobotValidationError(
                    ValidationErrorCode.VALUE_EMPTY,
                    f"{name} of a joint property cannot be empty or blank",
                    target="JointProperty",
                    field=(name,),
                )
