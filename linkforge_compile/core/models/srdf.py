"""The semantic description of a robot for motion planning: SRDF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Annotated, Any

from linkforge_compile.core.fields import Children, Name, Reference
from linkforge_compile.core.models.collision_rules import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.named_table import KeySpec, NamedTable, OnDuplicate, itself
from linkforge_compile.core.models.planning import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.part import Element, freeze, set_field

__all__ = [
    "Chain",
    "CollisionPair",
    "EndEffector",
    "GroupState",
    "JointProperty",
    "LinkSphereApproximation",
    "PassiveJoint",
    "PlanningGroup",
    "SemanticRobotDescription",
    "SrdfSphere",
    "VirtualJoint",
]

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


@dataclass(frozen=True, slots=True)
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
        freeze(self)
        for name, spec in _MEMBERS.items():
            members = getattr(self, name)
            if not isinstance(members, NamedTable):
                set_field(self, name, NamedTable(spec, members))

    @property
    def is_empty(self) -> bool:
        """True for a description without members and raw XML."""
        return self == SemanticRobotDescription(self.robot_name)

    def merge_with(self, other: SemanticRobotDescription) -> SemanticRobotDescription:
        """Return this description followed by the members of the other, under the name of this one.

        A collision pair or link without default collisions that both have is kept once, with the reason given here.

        Raises:
            RobotValidationError: DUPLICATE_NAME for anything else that both have, or the other twice.

        """
        members = {name: getattr(self, name).extended(getattr(other, name)) for name in _MEMBERS}
        attributes = dict(self.extra_attributes)
        return replace(
            self,
            **members,
            extra_elements=(*self.extra_elements, *other.extra_elements),
            extra_inside=(*self.extra_inside, *other.extra_inside),
            extra_attributes=tuple({**attributes, **dict(other.extra_attributes), **attributes}.items()),
        )

    def normalized(self) -> SemanticRobotDescription:
        """Return it with every collection sorted by name; a collision pair counts by its links in order.

        The members of a group stay in their order, and so do the two links of a pair.
        """
        members: dict[str, Any] = {name: sorted(getattr(self, name), key=spec.key) for name, spec in _MEMBERS.items()}
        return replace(self, **members)
