"""The semantic description of a robot, SRDF: what planning needs to know beside links and joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, TypeVar

from linkforge_compile.core.models.collision_rules import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.planning import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.part import Element, freeze

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

T = TypeVar("T")

SEMANTIC_KEYS: Mapping[str, Callable[[object], Any]] = {  # Any: a name, or a pair of them
    "virtual_joints": attrgetter("name"),
    "groups": attrgetter("name"),
    "group_states": attrgetter("group", "name"),
    "end_effectors": attrgetter("name"),
    "passive_joints": attrgetter("name"),
    "disabled_collisions": attrgetter("key"),
    "enabled_collisions": attrgetter("key"),
    "no_default_collision_links": str,
    "link_sphere_approximations": attrgetter("link"),
    "joint_properties": attrgetter("joint_name", "property_name"),
}
"""What tells the members of each collection of a SemanticRobotDescription apart: a name, or a pair of names."""

SEMANTIC_SETS = frozenset({"disabled_collisions", "enabled_collisions", "no_default_collision_links"})
"""The collections that are mere sets: saying a thing twice is saying it once, and no clash of names."""


@dataclass(frozen=True, slots=True)
class SemanticRobotDescription(Element):
    """All that SRDF says about a robot: `<robot name>`, empty where it is not known yet.

    Collections keep the order in which they were given. `no_default_collision_links` are names of links.
    """

    PREFIXED = ("robot_name", *SEMANTIC_KEYS, "extra_inside")

    robot_name: str = ""
    virtual_joints: Sequence[VirtualJoint] = ()
    groups: Sequence[PlanningGroup] = ()
    group_states: Sequence[GroupState] = ()
    end_effectors: Sequence[EndEffector] = ()
    passive_joints: Sequence[PassiveJoint] = ()
    disabled_collisions: Sequence[CollisionPair] = ()
    enabled_collisions: Sequence[CollisionPair] = ()
    no_default_collision_links: Sequence[str] = ()
    link_sphere_approximations: Sequence[LinkSphereApproximation] = ()
    joint_properties: Sequence[JointProperty] = ()

    def __post_init__(self) -> None:
        freeze(self, *SEMANTIC_KEYS)

    @property
    def is_empty(self) -> bool:
        """True for a description of nothing, whatever robot it names."""
        return self == SemanticRobotDescription(self.robot_name)

    def merge_with(self, other: SemanticRobotDescription) -> SemanticRobotDescription:
        """Return this description with the members of the other behind its own; the name stays this one's.

        A collision pair or link without default collisions that both have is there once, as this one says it.

        Raises:
            RobotValidationError: DUPLICATE_NAME for anything else that both have, or the other twice.

        """
        from linkforge_compile.core.models.semantic_parts import SemanticParts

        return SemanticParts(self).joined(other).description(self.robot_name)

    def normalized(self) -> SemanticRobotDescription:
        """Return it with every collection sorted by name; a collision pair counts by its links in order.

        The members of a group stay in their order, and so do the two links of a pair.
        """
        return replace(
            self,
            virtual_joints=_in_order("virtual_joints", self.virtual_joints),
            groups=_in_order("groups", self.groups),
            group_states=_in_order("group_states", self.group_states),
            end_effectors=_in_order("end_effectors", self.end_effectors),
            passive_joints=_in_order("passive_joints", self.passive_joints),
            disabled_collisions=_in_order("disabled_collisions", self.disabled_collisions),
            enabled_collisions=_in_order("enabled_collisions", self.enabled_collisions),
            no_default_collision_links=_in_order("no_default_collision_links", self.no_default_collision_links),
            link_sphere_approximations=_in_order("link_sphere_approximations", self.link_sphere_approximations),
            joint_properties=_in_order("joint_properties", self.joint_properties),
        )


def _in_order(collection: str, members: Sequence[T]) -> tuple[T, ...]:
    return tuple(sorted(members, key=SEMANTIC_KEYS[collection]))
