"""The semantic description of a robot, SRDF: what planning needs to know beside links and joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter, itemgetter
from typing import Annotated, Any

from linkforge_compile.core.fields import Children, Name, Reference
from linkforge_compile.core.models.collision_rules import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.named_table import Additions, KeySpec, OnDuplicate, PartList, extend_all, itself
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
_EXTRAS: Mapping[str, KeySpec] = {
    "extra_elements": KeySpec("extra element", itself, OnDuplicate.KEEP),
    "extra_inside": KeySpec("extra inside", itself, OnDuplicate.KEEP),
    "extra_attributes": KeySpec("extra attribute", itemgetter(0), OnDuplicate.SKIP),
}


@dataclass(frozen=True, slots=True)
class SemanticRobotDescription(Element):
    """All that SRDF says about a robot: `<robot name>`, empty where it is not known yet.

    Collections keep the order in which they were given. `no_default_collision_links` are names of links.
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
        freeze(self, *_MEMBERS)

    @property
    def is_empty(self) -> bool:
        """True for a description of nothing, whatever robot it names."""
        return self == SemanticRobotDescription(self.robot_name)

    def merge_with(self, other: SemanticRobotDescription) -> SemanticRobotDescription:
        """Return this description followed by the members of the other, under the name of this one.

        A collision pair or link without default collisions that both have is there once, as this one says it.

        Raises:
            RobotValidationError: DUPLICATE_NAME for anything else that both have, or the other twice.

        """
        parts = SemanticParts(self)
        extend_all(parts.additions(other))
        return parts.describe(self.robot_name)

    def normalized(self) -> SemanticRobotDescription:
        """Return it with every collection sorted by name; a collision pair counts by its links in order.

        The members of a group stay in their order, and so do the two links of a pair.
        """
        members: dict[str, Any] = {name: sorted(getattr(self, name), key=spec.key) for name, spec in _MEMBERS.items()}
        return replace(self, **members)


class SemanticParts:
    """The semantic description of a robot while it grows: a PartList for each collection that does."""

    def __init__(self, description: SemanticRobotDescription) -> None:
        self._description = description
        self._lists: dict[str, PartList[Any]] = {}  # Any: each collection has members of its own class
        self._described = 0

    def list_members(self, collection: str) -> PartList[Any]:
        """Return the members of a collection, to be looked up and added to."""
        if collection not in self._lists:
            spec = _MEMBERS.get(collection) or _EXTRAS[collection]
            self._lists[collection] = PartList(spec, getattr(self._description, collection))
        return self._lists[collection]

    def additions(self, other: SemanticRobotDescription) -> Additions:
        """Return what `extend_all` takes to add the members of another description."""
        return [(self.list_members(name), added) for name in (*_MEMBERS, *_EXTRAS) if (added := getattr(other, name))]

    def describe(self, robot_name: str) -> SemanticRobotDescription:
        """Return the whole for a robot of that name."""
        length = sum(len(members.items) for members in self._lists.values())
        if length != self._described or self._description.robot_name != robot_name:
            members: dict[str, Any] = {name: members.items for name, members in self._lists.items()}
            self._description = replace(self._description, robot_name=robot_name, **members)
            self._described = length
        return self._description

    def copy(self) -> SemanticParts:
        """Return a description of its own that says the same."""
        return SemanticParts(self.describe(self._description.robot_name))
