"""The SRDF part of a robot while it grows."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.index import Filing, Index, Repeats, itself

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import Chain, PlanningGroup, SemanticRobotDescription

# srdf.py is imported inside the functions: most robots are never asked about it, and it takes its time.

_KINDS = {
    "virtual_joints": "virtual joint",
    "groups": "planning group",
    "group_states": "group state",
    "end_effectors": "end effector",
    "passive_joints": "passive joint",
    "disabled_collisions": "collision pair",
    "enabled_collisions": "collision pair",
    "no_default_collision_links": "link without default collisions",
    "link_sphere_approximations": "link sphere approximation",
    "joint_properties": "joint property",
}


def _attribute(pair: tuple[str, str]) -> str:
    return pair[0]


_EXTRAS: dict[str, Filing[Any]] = {  # Any, here and below: each collection has members of its own kind
    "extra_elements": Filing("extra element", itself, Repeats.KEPT),
    "extra_inside": Filing("extra inside", itself, Repeats.KEPT),
    "extra_attributes": Filing("extra attribute", _attribute, Repeats.SKIPPED),
}

_COLLECTIONS: Final = (*_KINDS, *_EXTRAS)


def _filing(collection: str) -> Filing[Any]:
    from linkforge_compile.core.models.srdf import SEMANTIC_KEYS, SEMANTIC_SETS

    if collection in _EXTRAS:
        return _EXTRAS[collection]
    repeats = Repeats.SKIPPED if collection in SEMANTIC_SETS else Repeats.REFUSED
    return Filing(_KINDS[collection], SEMANTIC_KEYS[collection], repeats)


class SemanticParts:
    """The collections of a SemanticRobotDescription, each an Index, so that joining costs what is joined.

    It never changes; the description is put together when somebody looks.
    """

    def __init__(self, base: SemanticRobotDescription | None) -> None:
        self._base = base
        self._whole = base
        self._grown: dict[str, Index[Any]] = {}

    @property
    def silent(self) -> bool:
        """True as long as nobody has said anything semantic."""
        return self._base is None and not any(self._grown.values())

    def description(self, robot_name: str) -> SemanticRobotDescription:
        """Return the whole under the name that the robot has now, whatever the name in what was said."""
        if self._whole is None or self._whole.robot_name != robot_name:
            from linkforge_compile.core.models.srdf import SemanticRobotDescription

            base = self._base or SemanticRobotDescription()
            members: dict[str, Any] = {name: tuple(index) for name, index in self._grown.items()}
            self._whole = replace(base, **{**members, "robot_name": robot_name})
        return self._whole

    def holds(self, collection: str, key: Hashable) -> bool:
        return self._index(collection).get(key) is not None

    def joined(self, other: SemanticRobotDescription) -> SemanticParts:
        """Return this with the members of another description behind its own, as `merge_with` does.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a member that is there already, collision pairs and links
                without default collisions excepted, which are kept once.

        """
        return self.with_members({name: said for name in _COLLECTIONS if (said := getattr(other, name))})

    def with_members(self, members: Mapping[str, Sequence[object]]) -> SemanticParts:
        """Return this with more members, by the name of their collection; raises as `joined` does."""
        grown = {collection: self._index(collection).extended(added) for collection, added in members.items()}
        longer = SemanticParts(self._base)
        longer._whole = None
        longer._grown = {**self._grown, **grown}
        return longer

    def _index(self, collection: str) -> Index[Any]:
        if collection not in self._grown:
            self._grown[collection] = Index(getattr(self._base, collection, ()), _filing(collection))
        return self._grown[collection]


def planning_group(
    *,
    name: str,
    links: Sequence[str] | None,
    joints: Sequence[str] | None,
    chains: Sequence[Chain] | None,
    subgroups: Sequence[str] | None,
    base_link: str | None,
    tip_link: str | None,
) -> PlanningGroup:
    """Return a group with one more chain where `base_link` and `tip_link` are given.

    Raises:
        RobotValidationError: INVALID_VALUE for one of the two without the other; VALUE_EMPTY for a group of nothing.

    """
    from linkforge_compile.core.models.srdf import Chain, PlanningGroup

    if bool(base_link) != bool(tip_link):
        raise RobotValidationError(
            ValidationErrorCode.INVALID_VALUE,
            f"base_link and tip_link of group '{name}' must be given together",
            target="PlanningGroup",
            value=base_link or tip_link,
            field=("chain",),
        )
    shorthand = [Chain(base_link, tip_link)] if base_link and tip_link else []
    return PlanningGroup(
        name=name,
        links=links or (),
        joints=joints or (),
        chains=(*(chains or ()), *shorthand),
        subgroups=subgroups or (),
    )
