"""What planning is told about a robot: groups, collision pairs, joint properties."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Self

from linkforge_compile.core.constants import SRDF_REASON_ADJACENT
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.inventory import Inventory
from linkforge_compile.core.models.semantic_parts import planning_group

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import Chain, SemanticRobotDescription, SrdfSphere


class SemanticRobot(Inventory):
    """A robot's parts with what `semantic` says about them; each method returns the robot, for the next call."""

    def add_semantic(self, description: SemanticRobotDescription) -> Self:
        """Put the entries of a description behind those that are there; whom they name is not looked at.

        A collision pair that is there, whatever the order of its links, and a link that is there without default
        collisions are not added again.

        Raises:
            RobotValidationError: DUPLICATE_NAME for any other entry that is there: group states by group and
                name, sphere approximations by link, joint properties by joint and property.

        """
        self._semantic = self._semantic.joined(description)
        return self

    def add_group(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        links: list[str] | None = None,
        joints: list[str] | None = None,
        chains: list[Chain] | None = None,
        subgroups: list[str] | None = None,
        base_link: str | None = None,
        tip_link: str | None = None,
    ) -> Self:
        """Add a planning group of what is there; `base_link` and `tip_link` make one chain more.

        Raises:
            RobotValidationError: NOT_FOUND for a link, joint or subgroup; INVALID_VALUE for one of base_link and
                tip_link without the other; VALUE_EMPTY for a group of nothing; DUPLICATE_NAME.

        """
        group = planning_group(
            name=name,
            links=links,
            joints=joints,
            chains=chains,
            subgroups=subgroups,
            base_link=base_link,
            tip_link=tip_link,
        )
        for link in (*group.links, *(end for chain in group.chains for end in (chain.base_link, chain.tip_link))):
            self.link(link)
        for joint in group.joints:
            self.joint(joint)
        for subgroup in group.subgroups:
            if not self._semantic.holds("groups", subgroup):
                raise RobotValidationError(
                    ValidationErrorCode.NOT_FOUND,
                    f"Subgroup '{subgroup}' not found",
                    target="Subgroup",
                    value=subgroup,
                    field=("subgroups",),
                )
        return self._say(groups=(group,))

    def disable_collisions(self, link1: str, link2: str, reason: str = SRDF_REASON_ADJACENT) -> Self:
        """Let planning ignore collisions between two links; a pair that is disabled already stays as it is.

        Raises:
            RobotValidationError: NOT_FOUND for a link; INVALID_VALUE for a link with itself.

        """
        return self._disable(((link1, link2),), reason)

    def disable_all_collisions(self, links: list[str], reason: str = SRDF_REASON_ADJACENT) -> Self:
        """Let planning ignore collisions between any two of the links.

        Raises:
            RobotValidationError: NOT_FOUND for a link; INVALID_VALUE for a link that is listed twice.

        """
        for link in links:
            self.link(link)
        return self._disable(combinations(links, 2), reason)

    def _disable(self, pairs: Iterable[tuple[str, str]], reason: str) -> Self:
        from linkforge_compile.core.models.srdf import CollisionPair

        disabled = [CollisionPair(self.link(one).name, self.link(other).name, reason) for one, other in pairs]
        return self._say(disabled_collisions=disabled)

    def enable_collisions(self, link1: str, link2: str, reason: str | None = None) -> Self:
        """Let planning look for collisions between two links in spite of their defaults; a pair counts once.

        Raises:
            RobotValidationError: NOT_FOUND for a link; INVALID_VALUE for a link with itself.

        """
        from linkforge_compile.core.models.srdf import CollisionPair

        pair = CollisionPair(self.link(link1).name, self.link(link2).name, reason)
        return self._say(enabled_collisions=(pair,))

    def disable_default_collisions(self, link: str) -> Self:
        """Let planning ignore all collisions of a link that are not enabled one by one.

        Raises:
            RobotValidationError: NOT_FOUND for the link.

        """
        return self._say(no_default_collision_links=(self.link(link).name,))

    def add_joint_property(self, joint_name: str, property_name: str, value: str) -> Self:
        """Say something about a joint that planners know by name.

        Raises:
            RobotValidationError: NOT_FOUND for the joint; DUPLICATE_NAME for a property that it has.

        """
        from linkforge_compile.core.models.srdf import JointProperty

        remark = JointProperty(self.joint(joint_name).name, property_name, value)
        return self._say(joint_properties=(remark,))

    def approximate_link_collision(self, link: str, spheres: list[SrdfSphere]) -> Self:
        """Give the spheres that stand for a link's shape in collisions.

        Raises:
            RobotValidationError: NOT_FOUND for the link; DUPLICATE_NAME if it has spheres already.

        """
        from linkforge_compile.core.models.srdf import LinkSphereApproximation

        approximation = LinkSphereApproximation(self.link(link).name, spheres)
        return self._say(link_sphere_approximations=(approximation,))

    def _say(self, **members: Sequence[object]) -> Self:
        self._semantic = self._semantic.with_members(members)
        return self
