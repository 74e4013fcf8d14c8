"""The semantic description of a robot for motion planning: SRDF.

The constructors raise RobotValidationError for what is not as their class describes it, NAME_EMPTY for a blank name,
group or link, and RobotMathError for NaN and infinity.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from numbers import Real
from operator import attrgetter
from typing import Annotated, Any, Self

from linkforge_compile.core.constants import SRDF_VJOIN_FIXED, SRDF_VJOIN_FLOATING, SRDF_VJOIN_PLANAR
from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import (
    Children,
    Choice,
    Data,
    Name,
    Reference,
    Text,
    is_finite,
    not_finite,
    require_choice,
)
from linkforge_compile.core.models.named_table import KeySpec, NamedTable, OnDuplicate, itself
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation
from linkforge_compile.core.naming import require_not_blank
from linkforge_compile.core.part import Element, FrozenMap, extras_last, set_field


class VirtualJointType(StrEnum):
    """How the robot may move in the world."""

    FIXED = SRDF_VJOIN_FIXED
    PLANAR = SRDF_VJOIN_PLANAR
    FLOATING = SRDF_VJOIN_FLOATING


@extras_last
@dataclass(frozen=True)
class VirtualJoint(Element):
    """The joint between the world and the robot: `<virtual_joint name type parent_frame child_link>`.

    `type` is `fixed`, `planar` or `floating`; `parent_frame` belongs to the world and gets no prefix.
    """

    TAG = "virtual_joint"

    name: Annotated[str, Name()]
    type: Annotated[str, Choice(VirtualJointType, example="fixed")]
    parent_frame: Annotated[str, Text(example="world")]
    child_link: Annotated[str, Reference("link", example="base")]

    def _check(self) -> None:
        require_not_blank(self.name, "virtual joint name", "VirtualJointName")
        require_choice(self.type, VirtualJointType, "virtual joint type", "VirtualJointType", "type")


@extras_last
@dataclass(frozen=True)
class Chain(Element):
    """The joints from one link to another: `<chain base_link tip_link>`; both ends may be the same link."""

    TAG = "chain"

    base_link: Annotated[str, Reference("link", example="base")]
    tip_link: Annotated[str, Reference("link", example="tool0")]

    def _check(self) -> None:
        require_not_blank(self.base_link, "base_link of a chain", "ChainBaseLink", ("base_link",))
        require_not_blank(self.tip_link, "tip_link of a chain", "ChainTipLink", ("tip_link",))


@extras_last
@dataclass(frozen=True)
class PlanningGroup(Element):
    """Joints that are planned together: `<group name>`; given by links, joints, chains or other groups.

    `kinematics` are the parameters of its solver in MoveIt, such as `kinematics_solver`; they are in no SRDF.
    """

    TAG = "group"
    NAMES_INSIDE_TAKE_PREFIX = True

    name: Annotated[str, Name()]
    links: Annotated[Sequence[str], Reference("link", xml="link/@name")] = ()
    joints: Annotated[Sequence[str], Reference("joint", xml="joint/@name")] = ()
    chains: Annotated[Sequence[Chain], Children()] = ()
    subgroups: Annotated[Sequence[str], Reference("group", xml="group/@name")] = ()
    kinematics: Annotated[Mapping[str, Any], Data(xml="")] = field(default=FrozenMap(), kw_only=True)

    def _check(self) -> None:
        require_not_blank(self.name, "planning group name", "PlanningGroupName")
        if not (self.links or self.joints or self.chains or self.subgroups):
            message = f"planning group '{self.name}' must have at least one link, joint, chain or subgroup"
            raise RobotValidationError.empty(message, "PlanningGroup")


def chain_between(group: str, base_link: str | None, tip_link: str | None) -> tuple[Chain, ...]:
    """Return the one chain between two links, none for two None.

    Raises:
        RobotValidationError: INVALID_VALUE for one link without the other.

    """
    if base_link and tip_link:
        return (Chain(base_link, tip_link),)
    if base_link or tip_link:
        message, given = f"base_link and tip_link of group '{group}' must be given together", base_link or tip_link
        raise RobotValidationError.invalid(message, "PlanningGroup", given, "chain")
    return ()


@extras_last
@dataclass(frozen=True)
class GroupState(Element):
    """A named pose of a group: `<group_state name group>`.

    `joint_values` are positions [rad] or [m] by joint, each a tuple with a number for every degree of freedom.
    A number given alone becomes a tuple of one float, another collection a tuple, anything else a tuple of itself.
    """

    TAG = "group_state"
    NAMES_INSIDE_TAKE_PREFIX = True

    name: Annotated[str, Name()]
    group: Annotated[str, Reference("group", key="")]
    # Any: numbers are accepted, and made tuples
    joint_values: Annotated[Mapping[str, Any], Reference("joint", key="", xml="joint/@name")] = FrozenMap()

    def _check(self) -> None:
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


@extras_last
@dataclass(frozen=True)
class EndEffector(Element):
    """A group that is a tool at the end of an arm: `<end_effector name group parent_link parent_group>`.

    `parent_link` is the link of the arm that carries it, `parent_group` the group of the arm, None if not given.
    """

    TAG = "end_effector"
    ATTRIBUTE_ORDER = ("name", "parent_link", "group", "parent_group")

    name: Annotated[str, Name()]
    group: Annotated[str, Reference("group", example="gripper")]
    parent_link: Annotated[str, Reference("link", example="tool0")]
    parent_group: Annotated[str | None, Reference("group")] = None

    def _check(self) -> None:
        require_not_blank(self.name, "end effector name", "EndEffectorName")
        require_not_blank(self.group, "group of an end effector", "GroupName", ("group",))


@extras_last
@dataclass(frozen=True)
class PassiveJoint(Element):
    """A joint that nothing drives: `<passive_joint name>`."""

    TAG = "passive_joint"

    name: Annotated[str, Reference("joint", key="")]

    def _check(self) -> None:
        require_not_blank(self.name, "passive joint name", "PassiveJointName")


@extras_last
@dataclass(frozen=True)
class JointProperty(Element):
    """A remark on a joint that a planner reads: `<joint_property joint_name property_name value>`; none is blank."""

    TAG = "joint_property"
    TITLE = "property '{property_name}' of joint '{joint_name}'"
    SHORT_FORM = "value"

    joint_name: Annotated[str, Reference("joint", key="")]
    property_name: Annotated[str, Text(key="")]
    value: Annotated[str, Text(example="true")]

    def _check(self) -> None:
        for name in ("joint_name", "property_name", "value"):
            if not getattr(self, name).strip():
                message = f"{name} of a joint property cannot be empty or blank"
                raise RobotValidationError.empty(message, "JointProperty", None, name)


_MEMBERS: Mapping[str, KeySpec] = {
    "virtual_joints": KeySpec("virtual joint"),
    "groups": KeySpec("planning group"),
    "group_states": KeySpec("group state", attrgetter("group", "name")),
    "end_effectors": KeySpec("end effector"),
    "passive_joints": KeySpec("passive joint"),
    "disabled_collisions": KeySpec("collision pair", attrgetter("key"), OnDuplicate.SKIP),
    "enabled_collisions": KeySpec("collision pair", attrgetter("key"), OnDuplicate.SKIP),
    "no_default_collision_links": KeySpec("link without default collisions", itself, OnDuplicate.SKIP),
    "link_sphere_approximations": KeySpec("link sphere approximation", attrgetter("link")),
    "joint_properties": KeySpec("joint property", attrgetter("joint_name", "property_name")),
}


@extras_last
@dataclass(frozen=True)
class SemanticRobotDescription(Element):
    """The SRDF of a robot: `<robot name>`, with an empty name until the robot is known.

    Collections keep the order in which they were given, and find their members by name, as those of a robot do.
    `no_default_collision_links` are names of links.
    """

    TAG = "robot"
    NAMES_INSIDE_TAKE_PREFIX = True

    robot_name: Annotated[str, Name(xml="@name")] = ""
    virtual_joints: Annotated[Sequence[VirtualJoint], Children()] = ()
    groups: Annotated[Sequence[PlanningGroup], Children()] = ()
    group_states: Annotated[Sequence[GroupState], Children()] = ()
    end_effectors: Annotated[Sequence[EndEffector], Children()] = ()
    passive_joints: Annotated[Sequence[PassiveJoint], Children()] = ()
    disabled_collisions: Annotated[Sequence[CollisionPair], Children(xml="disable_collisions")] = ()
    enabled_collisions: Annotated[Sequence[CollisionPair], Children(xml="enable_collisions")] = ()
    no_default_collision_links: Annotated[Sequence[str], Reference("link", xml="disable_default_collisions/@link")] = ()
    link_sphere_approximations: Annotated[Sequence[LinkSphereApproximation], Children()] = ()
    joint_properties: Annotated[Sequence[JointProperty], Children()] = ()

    def __post_init__(self) -> None:
        Element.__post_init__(self)
        for name, spec in _MEMBERS.items():
            members = getattr(self, name)
            if not isinstance(members, NamedTable):
                set_field(self, name, NamedTable(members, spec))

    @property
    def is_empty(self) -> bool:
        """True for a description without members and raw XML."""
        return self == SemanticRobotDescription(self.robot_name)

    def merge_with(self, other: "SemanticRobotDescription") -> Self:
        """Return this description followed by the members of the other, under the name of this one.

        A collision pair or link without default collisions that both have is kept once, with the reason given here.

        Raises:
            RobotValidationError: DUPLICATE_NAME for anything else that both have, or the other twice.

        """
        members = {name: getattr(self, name).extended(getattr(other, name)) for name in _MEMBERS}
        attributes = dict(self.extra_attributes)
        return self.with_fields(
            **members,
            extra_elements=(*self.extra_elements, *other.extra_elements),
            extra_inside=(*self.extra_inside, *other.extra_inside),
            extra_attributes=tuple({**attributes, **dict(other.extra_attributes), **attributes}.items()),
        )

    def normalized(self) -> Self:
        """Return it with every collection sorted by name; a collision pair counts by its links in order.

        The members of a group stay in their order, and so do the two links of a pair.
        """
        members: dict[str, Any] = {name: sorted(getattr(self, name), key=spec.key) for name, spec in _MEMBERS.items()}
        return self.with_fields(**members)
